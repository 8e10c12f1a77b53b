#include "calot/viewer/scope.h"

#include <gtest/gtest.h>

#include <cmath>

namespace calot::viewer {
namespace {

simulation::CameraSetup scene_camera() {
    simulation::CameraSetup camera;
    camera.eye_m = Vec3(-0.005, -0.015, 0.051);
    camera.target_m = Vec3(-0.003, 0.001, 0.0);
    return camera;
}
Vec3 view_of(const render::Camera& camera) {
    return glm::normalize(camera.target_m - camera.eye_m);
}

TEST(Scope, starts_as_the_scene_says) {
    const auto wanted = scene_camera();
    const render::Camera camera = Scope(wanted).camera();
    EXPECT_LT(glm::distance(camera.eye_m, wanted.eye_m), 1e-9);
    EXPECT_LT(glm::distance(camera.target_m, wanted.target_m), 1e-6);
    EXPECT_GT(camera.up.y, 0.5);
}

TEST(Scope, rod_goes_through_its_port) {
    Scope scope(scene_camera());
    const Vec3 before = scope.tip_m();
    scope.advance(0.01);
    const Vec3 rod = glm::normalize(scope.tip_m() - before);
    const Vec3 port = before - Scope::kDepth_m * rod;
    scope.advance(-0.01);
    scope.turn(0.2, -0.1);
    EXPECT_NEAR(glm::distance(scope.tip_m(), port), Scope::kDepth_m, 1e-9);
    EXPECT_GT(glm::distance(scope.tip_m(), before), 0.02);
}

TEST(Scope, lens_looks_thirty_degrees_aside_and_keeps_the_horizon) {
    Scope scope(scene_camera());
    const Vec3 tip = scope.tip_m();
    scope.advance(0.001);
    const Vec3 rod = glm::normalize(scope.tip_m() - tip);
    scope.advance(-0.001);
    for (int k = 0; k < 8; ++k) {
        const render::Camera camera = scope.camera();
        EXPECT_NEAR(std::acos(glm::dot(view_of(camera), rod)), Scope::kLensAngle_rad, 1e-9);
        EXPECT_LT(glm::distance(camera.eye_m, tip), 1e-12);  // only where it looks changes
        EXPECT_NEAR(glm::dot(glm::cross(view_of(camera), camera.up), Vec3(0.0, 0.0, 1.0)), 0.0, 0.6);
        scope.rotate_lens(0.25 * 3.14159265358979323846);
    }
    EXPECT_LT(glm::distance(view_of(scope.camera()), view_of(Scope(scene_camera()).camera())), 1e-9);
}

TEST(Scope, horizon_turns_the_picture_about_where_it_looks) {
    Scope scope(scene_camera());
    const render::Camera before = scope.camera();
    scope.roll(0.3);
    const render::Camera after = scope.camera();
    EXPECT_NEAR(glm::dot(view_of(before), view_of(after)), 1.0, 1e-9);
    EXPECT_NEAR(std::acos(glm::dot(before.up, after.up)), 0.3, 0.06);
}

TEST(Scope, presets_look_at_the_field) {
    const auto setup = scene_camera();
    for (const Scope::Preset preset :
         {Scope::Preset::start, Scope::Preset::overview, Scope::Preset::close, Scope::Preset::from_side}) {
        Scope scope(setup);
        scope.turn(0.3, 0.2);
        scope.roll(0.4);
        scope.go(preset);
        const render::Camera camera = scope.camera();
        EXPECT_GT(glm::dot(view_of(camera), glm::normalize(setup.target_m - camera.eye_m)), 0.999);
    }
    Scope near(setup), far(setup);
    near.go(Scope::Preset::close);
    far.go(Scope::Preset::overview);
    EXPECT_LT(glm::distance(near.tip_m(), setup.target_m), glm::distance(far.tip_m(), setup.target_m) - 0.02);
}

TEST(Scope, turning_right_looks_right) {
    Scope scope(scene_camera());
    const double x = view_of(scope.camera()).x;
    scope.turn(0.1, 0.0);
    EXPECT_GT(view_of(scope.camera()).x, x + 0.05);
    const double y = view_of(scope.camera()).y;
    scope.turn(0.0, 0.1);
    EXPECT_GT(view_of(scope.camera()).y, y + 0.05);
}

}  // namespace
}  // namespace calot::viewer
