// Properties of pictures, with margins that any OpenGL meets; never pixels of one driver.

#include <gtest/gtest.h>

#include <cmath>

#include "calot/render/frame.h"
#include "render/support.h"

namespace calot::render {
namespace {

using namespace test;

class Pictures : public ::testing::Test {
  protected:
    OffscreenContext context;
};

TEST_F(Pictures, round_image_on_black) {
    demo::Scene scene(1.2e-3);
    Renderer renderer(kWidth, kHeight, Quality::low);
    const Image image = picture(renderer, scene.view());
    const double radius = 0.5 * kRoundOverHeight * kHeight;
    const Vec3 outside = mean_where(
        image, [&](int x, int y) { return std::hypot(x + 0.5 - kWidth / 2, y + 0.5 - kHeight / 2) > radius + 1.5; });
    EXPECT_EQ(luma(outside), 0.0);
    const Vec3 inside = mean_where(
        image, [&](int x, int y) { return std::hypot(x + 0.5 - kWidth / 2, y + 0.5 - kHeight / 2) < 0.8 * radius; });
    EXPECT_GT(luma(inside), 0.15);
    EXPECT_LT(luma(inside), 0.85);
}

TEST_F(Pictures, every_quality_draws_the_same_scene_without_errors) {
    demo::Scene scene(1.2e-3);
    scene.burn(demo::kCrater_m, 0.004);
    View view = scene.view();
    view.instrument = demo::Scene::hook(Vec3(0.006, -0.004, 0.0));
    view.energised = true;
    view.smoke.push_back(puff(Vec3f(0.0f, 0.0f, 0.01f), 0.005f, 1e-7f, 1e-8f));
    Vec3 first(0.0);
    for (const Quality quality : {Quality::low, Quality::medium, Quality::high}) {
        Renderer renderer(kWidth, kHeight, quality);
        const Image image = picture(renderer, view);  // draw() throws on an OpenGL error
        const Vec3 colour = mean_where(image, [&](int, int) { return true; });
        if (quality == Quality::low) first = colour;
        // Tiers differ in obscurance, bloom and fine texture, not in what is seen.
        EXPECT_NEAR(luma(colour), luma(first), 0.08);
        EXPECT_GT(colour.r, colour.b);
    }
}

TEST_F(Pictures, wet_tissue_has_highlights) {
    demo::Scene scene(1.2e-3);
    Renderer renderer(kWidth, kHeight, Quality::medium);
    const Image image = picture(renderer, scene.view());
    int bright = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) bright += luma(pixel(image, x, y)) > 0.85;
    EXPECT_GT(bright, kWidth * kHeight / 2000);
    EXPECT_LT(bright, kWidth * kHeight / 10);
}

TEST_F(Pictures, tissues_have_their_colours) {
    Renderer renderer(kWidth, kHeight, Quality::low);
    const Vec3 fat = middle(picture(renderer, sheet(kFatOnly)));
    const Vec3 duct = middle(picture(renderer, sheet(kDuctOnly)));
    const Vec3 artery = middle(picture(renderer, sheet(kArteryOnly)));
    const Vec3 gallbladder = middle(picture(renderer, sheet(kGallbladderOnly)));
    EXPECT_GT(artery.r - artery.g, duct.r - duct.g + 0.1);  // redder
    EXPECT_GT(fat.r - fat.b, 0.2);                          // yellow
    EXPECT_GT(fat.g - fat.b, 0.1);
    EXPECT_GT(gallbladder.g, gallbladder.r - 0.02);  // greenish
    EXPECT_GT(luma(duct), luma(gallbladder));        // pale
}

TEST_F(Pictures, burning_blanches_then_browns_then_chars) {
    Renderer renderer(kWidth, kHeight, Quality::low);
    auto at = [&](double celsius) {
        return middle(picture(renderer, sheet(kFatOnly, static_cast<float>(celsius + 273.15))));
    };
    const Vec3 fresh = at(37.0), blanched = at(90.0), brown = at(185.0), burnt = at(320.0);
    auto saturation = [](const Vec3& c) { return (c.r - c.b) / c.r; };
    EXPECT_LT(saturation(blanched), saturation(fresh) - 0.1);
    EXPECT_LT(luma(brown), luma(blanched) - 0.1);
    EXPECT_LT(luma(burnt), luma(brown) - 0.05);
    EXPECT_LT(luma(burnt), 0.35 * luma(fresh));
}

TEST_F(Pictures, laid_bare_tissue_is_redder) {
    Renderer renderer(kWidth, kHeight, Quality::low);
    const Vec3 whole = middle(picture(renderer, sheet(kFatOnly)));
    const Vec3 bare = middle(picture(renderer, sheet(kFatOnly, 310.15f, 1.0f)));
    EXPECT_GT(bare.r / bare.g, 1.05 * whole.r / whole.g);
}

TEST_F(Pictures, hook_is_seen_and_casts_shadow) {
    Renderer renderer(kWidth, kHeight, Quality::medium);
    View view = sheet(kFatOnly);
    const Image without = picture(renderer, view);
    view.instrument = demo::Scene::hook(Vec3(0.0, 0.0, 0.004));
    const Image with = picture(renderer, view);
    int darker = 0, changed = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double change = luma(pixel(with, x, y)) - luma(pixel(without, x, y));
            darker += change < -0.05;
            changed += std::abs(change) > 0.05;
        }
    EXPECT_GT(changed, 400);  // the shaft alone covers more
    EXPECT_GT(darker, 300);
}

TEST_F(Pictures, artery_pulsates) {
    Renderer renderer(kWidth, kHeight, Quality::low);
    View view = sheet(kArteryOnly);
    view.time_s = 0.16 / 1.2;  // systole
    const Vec3 beat = middle(picture(renderer, view));
    view.time_s = 0.95 / 1.2;  // end of diastole
    const Vec3 rest = middle(picture(renderer, view));
    EXPECT_GT(beat.r, rest.r + 0.005);
}

TEST_F(Pictures, spark_lights_what_it_touches) {
    Renderer renderer(kWidth, kHeight, Quality::medium);
    View view = sheet(kDuctOnly);
    tissue::Capsule wire;
    wire.a_m = Vec3(-0.002, 0.0, 0.0006);
    wire.b_m = Vec3(0.002, 0.0, 0.0006);
    wire.radius_m = 0.0005;
    wire.bare = true;
    view.instrument = {wire};
    view.tissue[view.tissue.size() / 2].temperature_K = 400.0f;
    const Image cold = picture(renderer, view);
    view.energised = true;
    const Image hot = picture(renderer, view);
    EXPECT_GT(luma(mean_about(hot, kWidth / 2, kHeight / 2, 3)),
              luma(mean_about(cold, kWidth / 2, kHeight / 2, 3)) + 0.03);
}

TEST_F(Pictures, steam_hides_the_view_and_smoke_is_darker) {
    Renderer renderer(kWidth, kHeight, Quality::medium);
    View view = sheet(kFatOnly, 320.0f + 273.15f);
    const double clear = luma(mean_about(picture(renderer, view), kWidth / 2, kHeight / 2, 8));
    view.smoke = {puff(Vec3f(0.0f, 0.0f, 0.012f), 0.008f, 1e-4f, 0.0f)};
    const double steam = luma(mean_about(picture(renderer, view), kWidth / 2, kHeight / 2, 8));
    view.smoke[0].steam = 0.0f;
    view.smoke[0].smoke = 1e-4f;
    const double smoke = luma(mean_about(picture(renderer, view), kWidth / 2, kHeight / 2, 8));
    EXPECT_GT(steam, clear + 0.05);  // over char
    EXPECT_GT(steam, smoke + 0.03);
}

TEST_F(Pictures, resizes) {
    Renderer renderer(kWidth, kHeight, Quality::medium);
    const View view = sheet(kFatOnly);
    const Image small = picture(renderer, view);
    renderer.resize(200, 200);
    const Image square = picture(renderer, view);
    EXPECT_EQ(square.width, 200);
    EXPECT_EQ(square.rgb.size(), 3u * 200u * 200u);
    EXPECT_EQ(luma(pixel(square, 0, 0)), 0.0);
    EXPECT_GT(luma(middle(square)), 0.2);
    renderer.resize(kWidth, kHeight);
    EXPECT_EQ(picture(renderer, view).rgb, small.rgb);
    EXPECT_THROW(renderer.resize(0, 100), std::runtime_error);
}

TEST_F(Pictures, empty_view_is_black) {
    Renderer renderer(kWidth, kHeight, Quality::medium);
    const Image image = picture(renderer, View{});
    EXPECT_LT(luma(middle(image)), 0.05);
}

}  // namespace
}  // namespace calot::render
