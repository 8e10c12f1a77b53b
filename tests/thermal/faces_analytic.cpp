// What the staircase of hexel faces counts as: the area of the smooth surface that it stands for.

#include <gtest/gtest.h>

#include "calot/validation/heat_rig.h"

namespace calot::thermal {

namespace {

constexpr int kCells = 40;

/// Face area of a body, in faces, within `margin` cells of the box.
double area(const tissue::Model& model, const Groups& groups, int margin) {
    double sum = 0.0;
    for (int z = margin; z < kCells - margin; ++z)
        for (int y = margin; y < kCells - margin; ++y)
            for (int x = margin; x < kCells - margin; ++x) {
                const auto cell = static_cast<std::size_t>(model.hexels.index(x, y, z));
                sum += (groups.faces[cell] & kFaceMask) * static_cast<double>(groups.share[cell]) / kWholeFace;
            }
    return sum;
}

/// Hexels whose centres, from the middle of the box, are inside.
tissue::Model body(const std::function<bool(const Vec3&)>& inside) {
    return box_model(Int3(kCells), 1e-3, 1e-3, {plain_material()}, [&](const Int3& c) {
        return inside(Vec3(c) + 0.5 - 0.5 * kCells) ? tissue::MaterialIndex{1} : tissue::kNoMaterial;
    });
}

}  // namespace

TEST(Faces, CountWholeOnPlanesAlongTheAxes) {
    for (int axis = 0; axis < 3; ++axis) {
        const tissue::Model model = body([&](const Vec3& p) { return p[axis] < 3.0; });
        const Groups groups = Groups::make(model, model.hexel_initial);
        EXPECT_EQ(area(model, groups, 2), 36.0 * 36.0) << axis;
    }
}

TEST(Faces, HaveTheAreaOfABall) {
    Random random(3);
    for (const double radius : {4.0, 6.0, 9.0, 16.0}) {
        const Vec3 middle(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
        const tissue::Model model = body([&](const Vec3& p) { return glm::length(p - middle) < radius; });
        const Groups groups = Groups::make(model, model.hexel_initial);
        const double own = std::cbrt(3.0 * static_cast<double>(model.hexel_initial.count()) / (4.0 * std::numbers::pi));
        EXPECT_NEAR(area(model, groups, 1) / (4.0 * std::numbers::pi * own * own), 1.0, 0.035) << radius;
    }
}

TEST(Faces, HaveTheAreaOfTiltedPlanes) {
    // A plane through the middle with unit normal n has 1 / |n_z| of the area of its shadow along z.
    Random random(5);
    for (int k = 0; k < 20; ++k) {
        Vec3 n(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1.0);
        n = glm::normalize(n);
        const tissue::Model model = body([&](const Vec3& p) { return glm::dot(n, p) < 0.0; });
        const Groups groups = Groups::make(model, model.hexel_initial);
        double sum = 0.0;
        for (int y = 12; y < 28; ++y)
            for (int x = 12; x < 28; ++x)
                for (int z = 2; z < kCells - 2; ++z) {
                    const auto cell = static_cast<std::size_t>(model.hexels.index(x, y, z));
                    sum += (groups.faces[cell] & kFaceMask) * static_cast<double>(groups.share[cell]) / kWholeFace;
                }
        EXPECT_NEAR(sum * n.z / 256.0, 1.0, 0.06) << n.x << ' ' << n.y << ' ' << n.z;
    }
}

TEST(Faces, AreLookedAtAnewWhereHexelsWent) {
    tissue::Model model = body([](const Vec3& p) { return glm::length(p) < 12.0; });
    Groups groups = Groups::make(model, model.hexel_initial);
    BitArray present = model.hexel_initial;
    Random random(9);
    for (int k = 0; k < 200; ++k) {
        const Int3 c(Vec3(random.uniform(0.0, kCells), random.uniform(0.0, kCells), random.uniform(0.0, kCells)));
        const std::int64_t hexel = model.hexels.index(c);
        if (!present.test(hexel)) continue;
        present.clear(hexel);
        groups.touch(model.hexels, hexel);
    }
    groups.refresh(model, present);
    const Groups anew = Groups::make(model, present);
    for (std::size_t g = 0; g < anew.groups.size(); ++g) {
        EXPECT_EQ(groups.groups[g].present, anew.groups[g].present) << g;
        EXPECT_EQ(groups.groups[g].kind, anew.groups[g].kind) << g;
        for (int n = 0; n < 6; ++n) EXPECT_EQ(groups.groups[g].beside[n], anew.groups[g].beside[n]) << g;
    }
    EXPECT_EQ(groups.faces, anew.faces);
    for (std::size_t i = 0; i < anew.share.size(); ++i)
        if (anew.faces[i] != 0) {
            ASSERT_EQ(groups.share[i], anew.share[i]) << i;
        }
}

}  // namespace calot::thermal
