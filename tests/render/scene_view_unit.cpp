#include <gtest/gtest.h>

#include <cmath>

#include "calot/render/instrument_mesh.h"
#include "calot/render/scene_view.h"
#include "calot/surface/surface.h"
#include "render/demo_scene.h"

namespace calot::render {
namespace {

TEST(SceneView, looks_by_name) {
    EXPECT_EQ(look_of("cystic_artery"), Look::artery);
    EXPECT_EQ(look_of("common_duct"), Look::duct);
    EXPECT_EQ(look_of("gallbladder_wall"), Look::gallbladder);
    EXPECT_EQ(look_of("liver"), Look::liver);
    EXPECT_EQ(look_of("fat"), Look::fat);
    EXPECT_EQ(look_of("peritoneum"), Look::peritoneum);
}

TEST(SceneView, fresh_tissue_is_unburnt_and_weights_sum_to_one) {
    demo::Scene scene(1.2e-3);
    const View view = scene.view();
    ASSERT_GT(view.tissue.size(), 500u);
    bool fat = false, duct = false, artery = false;
    for (const TissueVertex& vertex : view.tissue) {
        const float* w = vertex.look_weights;
        EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1.0f, 1e-4f);  // rounding of 27 weights
        EXPECT_EQ(vertex.exposure, 0.0f);
        EXPECT_NEAR(vertex.peak_temperature_K, 310.15f, 1e-2f);
        EXPECT_NEAR(vertex.dryness, 0.0f, 1e-4f);
        EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-3f);
        fat |= w[0] > 0.99f;
        duct |= w[1] > 0.8f;
        artery |= w[2] > 0.8f;
    }
    EXPECT_TRUE(fat && duct && artery);
}

TEST(SceneView, crater_is_exposed_hot_and_dry_the_rest_is_not) {
    demo::Scene scene(1.2e-3);
    scene.burn(demo::kCrater_m, 0.004);
    const View view = scene.view();
    int exposed = 0, far_away = 0;
    for (const TissueVertex& vertex : view.tissue) {
        const double r = glm::length((Vec3(vertex.rest_m) - demo::kCrater_m) * Vec3(1.0, 1.6, 0.9));
        EXPECT_GE(vertex.exposure, 0.0f);
        EXPECT_LE(vertex.exposure, 1.0f);
        if (vertex.exposure > 0.9f) {
            ++exposed;
            EXPECT_GT(vertex.peak_temperature_K, 360.0f);
        }
        if (r > 0.010) {  // beyond the burn and the three cells that are averaged
            ++far_away;
            EXPECT_EQ(vertex.exposure, 0.0f);
        }
    }
    EXPECT_GT(exposed, 5);
    EXPECT_GT(far_away, 100);
}

TEST(SceneView, normals_turn_with_the_tissue) {
    demo::Scene scene(1.2e-3);
    surface::Surface surface(scene.model);
    surface.rebuild(scene.model, scene.state);
    const surface::Mesh& mesh = surface.rest_mesh();
    // Simple shear x += 0.5 z: the plane z = const keeps its normal, x = const tilts to (1, 0, -0.5).
    Mat3f shear(1.0f);
    shear[2][0] = 0.5f;
    const std::vector<Mat3f> gradient(mesh.position_m.size(), shear);
    std::vector<TissueVertex> vertices;
    fill_tissue(scene.model, scene.state, {},
                {mesh.position_m, mesh.normal, surface.owner(), mesh.position_m, gradient}, vertices);
    const Mat3f expected = glm::transpose(glm::inverse(shear));
    for (std::size_t k = 0; k < vertices.size(); ++k)
        EXPECT_LT(glm::length(vertices[k].normal - glm::normalize(expected * mesh.normal[k])), 1e-4f);
}

TEST(SceneView, organs_are_meshed_with_their_looks) {
    demo::Scene scene(1.2e-3);
    ASSERT_EQ(scene.organs.size(), 4u);
    EXPECT_EQ(scene.organs[0].look, Look::liver);
    EXPECT_EQ(scene.organs[1].look, Look::gallbladder);
    EXPECT_EQ(scene.organs[2].look, Look::duct);
    EXPECT_EQ(scene.organs[3].look, Look::peritoneum);
    for (const OrganMesh& organ : scene.organs) EXPECT_GT(organ.mesh.triangles(), 100u);
}

/// Triangles that do not look the way their normals do.
int turned_inside_out(const InstrumentMesh& mesh) {
    int wrong = 0;
    for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
        const InstrumentVertex &a = mesh.vertex[mesh.index[t]], &b = mesh.vertex[mesh.index[t + 1]],
                               &c = mesh.vertex[mesh.index[t + 2]];
        const Vec3f face = glm::cross(b.world_m - a.world_m, c.world_m - a.world_m);
        if (glm::length(face) > 1e-10f && glm::dot(face, a.normal + b.normal + c.normal) < 0.0f) ++wrong;
    }
    return wrong;
}

TEST(InstrumentMesh, tubes_keep_their_radius_and_face_outward) {
    const auto capsules = demo::Scene::hook(Vec3(0.0));
    InstrumentMesh mesh;
    build_instrument(capsules, mesh);
    ASSERT_GT(mesh.index.size(), 300u);
    for (const InstrumentVertex& vertex : mesh.vertex) {
        EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
        double nearest = 1e9;
        for (const tissue::Capsule& capsule : capsules) {
            const Vec3 p(vertex.world_m), e = capsule.b_m - capsule.a_m;
            const double t = std::clamp(glm::dot(p - capsule.a_m, e) / glm::dot(e, e), 0.0, 1.0);
            nearest = std::min(nearest, glm::length(p - capsule.a_m - t * e) - capsule.radius_m);
        }
        EXPECT_LT(nearest, 0.3e-3);  // sleeve 0.45 radii thicker than its wire
    }
    EXPECT_EQ(turned_inside_out(mesh), 0);
}

TEST(InstrumentMesh, jaws_meet_where_their_capsules_do_and_face_outward) {
    for (const double opening : {0.0, 0.6}) {
        // Jaws of 20 mm along z that open along x, a shaft behind them.
        std::vector<tissue::Capsule> capsules(3);
        const double r = 1.25e-3;
        for (const int side : {0, 1}) {
            tissue::Capsule& jaw = capsules[static_cast<std::size_t>(side)];
            const double sign = side == 0 ? 1.0 : -1.0;
            jaw.a_m = Vec3(sign * r, 0.0, -20e-3);
            jaw.b_m = jaw.a_m + 20e-3 * Vec3(sign * std::sin(opening), 0.0, std::cos(opening));
            jaw.radius_m = r;
        }
        capsules[2].a_m = Vec3(0.0, 0.0, -22.5e-3);
        capsules[2].b_m = Vec3(0.0, 0.0, -0.1);
        capsules[2].radius_m = 2.5e-3;
        for (tissue::Capsule& capsule : capsules) capsule.instrument = tissue::Instrument::grasper;
        InstrumentMesh mesh;
        build_instrument(capsules, mesh);
        EXPECT_EQ(turned_inside_out(mesh), 0);
        float furthest = -1.0f, nearest = 1.0f;
        for (const InstrumentVertex& vertex : mesh.vertex) {
            EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
            furthest = std::max(furthest, vertex.world_m.z);
            // Beyond the joint, closed jaws touch in the plane between them and do not cross it.
            if (opening == 0.0 && vertex.world_m.z > -15e-3f) nearest = std::min(nearest, std::fabs(vertex.world_m.x));
        }
        EXPECT_NEAR(furthest, capsules[0].b_m.z + r * std::cos(opening), 0.3e-3);
        if (opening == 0.0) {
            EXPECT_LT(nearest, 0.05e-3f);
        }
    }
}

}  // namespace
}  // namespace calot::render
