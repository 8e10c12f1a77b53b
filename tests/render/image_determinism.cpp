#include <gtest/gtest.h>

#include "render/support.h"

namespace calot::render {
namespace {

using namespace test;

View busy_view(demo::Scene& scene) {
    scene.burn(demo::kCrater_m, 0.004);
    View view = scene.view();
    view.instrument = demo::Scene::hook(Vec3(0.006, -0.004, 0.0));
    view.energised = true;
    view.time_s = 1.25;
    for (std::uint32_t k = 0; k < 5; ++k)
        view.smoke.push_back(puff(Vec3f(0.002f * static_cast<float>(k), 0.0f, 0.01f), 0.004f, 1e-7f, 1e-8f, k * 977u));
    return view;
}

TEST(ImageDeterminism, same_view_same_bytes) {
    OffscreenContext context;
    demo::Scene scene(1.2e-3);
    View view = busy_view(scene);
    Renderer renderer(kWidth, kHeight, Quality::medium);
    const Image first = picture(renderer, view);
    View other = sheet(kFatOnly);
    other.tissue_index_version = 2;
    picture(renderer, other);  // what was drawn before must leave no trace
    EXPECT_EQ(picture(renderer, view).rgb, first.rgb);
    Renderer fresh(kWidth, kHeight, Quality::medium);
    EXPECT_EQ(picture(fresh, view).rgb, first.rgb);
}

TEST(ImageDeterminism, opengl_es_draws_what_opengl_does) {
    demo::Scene scene(1.2e-3);
    const View view = busy_view(scene);
    auto draw = [&](Api api) {
        OffscreenContext context(api);
        Renderer renderer(kWidth, kHeight, Quality::medium);
        return picture(renderer, view);
    };
    const Image desktop = draw(Api::opengl), embedded = draw(Api::opengl_es);
    // The same shaders; the grain's hash and single highlights hang on the last bits of floats.
    double sum = 0.0;
    for (std::size_t k = 0; k < desktop.rgb.size(); ++k) sum += std::abs(desktop.rgb[k] - embedded.rgb[k]);
    EXPECT_LT(sum / static_cast<double>(desktop.rgb.size()), 6.0);
}

}  // namespace
}  // namespace calot::render
