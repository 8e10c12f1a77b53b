// A picture in passes:
//
//   depth (mask, tissue, organs, hook) -> obscurance, half size -> colour (depth equal) + spark -> smoke, half size
//   -> bright parts, quarter size, blurred -> compose (lens, smoke, bloom, film) -> finish (edges, grain)
//
// Low quality leaves out obscurance, bloom and the finish. Depth first, as shading is what costs.

#include "calot/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calot/render/frame.h"
#include "calot/render/gl.h"
#include "calot/render/noise.h"
#include "calot/render/scene_passes.h"
#include "calot/render/shaders.h"
#include "calot/render/units.h"

namespace calot::render {

namespace {

using gl::Format;
using gl::Program;
using gl::Target;
using gl::VertexArray;

struct Settings {
    double scale;           ///< pixels of the scene per pixel of the picture
    int occlusion_samples;  ///< 0 = none
    int smoke_divisor;      ///< the smoke's target is smaller by this
};

Settings settings_of(Quality quality) {
    switch (quality) {
        case Quality::low:
            return {1.0, 0, 4};
        case Quality::medium:
            return {1.0, 6, 3};
        case Quality::high:
            return {1.35, 10, 2};
    }
    return {1.0, 0, 4};
}

}  // namespace

struct Renderer::Impl {
    Quality quality;
    Settings settings;
    bool hdr;
    std::string defines;
    int width = 0;
    int height = 0;

    VertexArray nothing;  ///< for draws without attributes
    ScenePasses passes;
    std::unique_ptr<Program> occlusion, occlusion_blur, bright, blur, finish;
    Program compose;

    Target scene, smoke, occlusion_raw, occlusion_smooth, bloom_a, bloom_b, composed, result;

    Impl(int width, int height, Quality quality);
    void resize(int new_width, int new_height);
    void draw_occlusion();
    void draw_camera();
    void screen(const Target& target, const Program& program);
};

namespace {

std::string common_defines(Quality quality, bool hdr, const Settings& settings) {
    std::string lines = "#define QUALITY " + std::to_string(static_cast<int>(quality)) + "\n";
    if (hdr) lines += "#define HDR\n";
    lines += "#define OCCLUSION_SAMPLES " + std::to_string(std::max(1, settings.occlusion_samples)) + "\n";
    lines += "#define CAPSULES " + std::to_string(kMaxCapsules) + "\n";
    lines += "#define PILLOW_SLOPE " + std::to_string(kPillowSlope) + "\n";
    lines += "#define PILLOW_WIDTH " + std::to_string(kPillowWidth) + "\n";
    lines += "#define BUMP_SLOPE " + std::to_string(kBumpSlope) + "\n";
    return lines;
}

}  // namespace

Renderer::Impl::Impl(int wanted_width, int wanted_height, Quality wanted)
    : quality(wanted),
      settings(settings_of(wanted)),
      hdr(wanted != Quality::low && gl::has_float_targets()),
      defines(common_defines(wanted, hdr, settings)),
      passes(wanted, defines),
      compose("compose", defines, {shaders::kScreenVertex}, {shaders::kFrame, shaders::kComposeFragment}) {
    if (quality != Quality::low) {
        auto make = [&](const char* name, const char* fragment) {
            auto program = std::make_unique<Program>(name, defines, std::vector<const char*>{shaders::kScreenVertex},
                                                     std::vector<const char*>{shaders::kFrame, fragment});
            set_samplers(*program);
            return program;
        };
        occlusion = make("occlusion", shaders::kOcclusionFragment);
        occlusion_blur = make("occlusion blur", shaders::kOcclusionBlurFragment);
        bright = make("bright", shaders::kBrightFragment);
        blur = make("blur", shaders::kBlurFragment);
        finish = make("finish", shaders::kFinishFragment);
    }
    set_samplers(compose);

    resize(wanted_width, wanted_height);
    gl::check("set-up");
}

void Renderer::Impl::resize(int new_width, int new_height) {
    if (new_width < 16 || new_height < 16) throw std::runtime_error("a picture has at least 16 x 16 pixels");
    if (new_width == width && new_height == height) return;
    width = new_width;
    height = new_height;
    const Format colour = hdr ? Format::rgba16f : Format::rgba8;
    auto scaled = [&](double factor, int& w, int& h) {
        w = std::max(1, static_cast<int>(std::lround(width * factor)));
        h = std::max(1, static_cast<int>(std::lround(height * factor)));
    };
    glActiveTexture(GL_TEXTURE0);
    int w = 0, h = 0;
    scaled(settings.scale, w, h);
    scene = gl::make_target(w, h, colour, true);
    smoke = gl::make_target((w + settings.smoke_divisor - 1) / settings.smoke_divisor,
                            (h + settings.smoke_divisor - 1) / settings.smoke_divisor, colour, false);
    result = gl::make_target(width, height, Format::rgba8, false);
    if (quality == Quality::low) return;
    occlusion_raw = gl::make_target((w + 1) / 2, (h + 1) / 2, Format::r8, false);
    occlusion_smooth = gl::make_target((w + 1) / 2, (h + 1) / 2, Format::r8, false);
    bloom_a = gl::make_target((w + 3) / 4, (h + 3) / 4, colour, false);
    bloom_b = gl::make_target((w + 3) / 4, (h + 3) / 4, colour, false);
    composed = gl::make_target(w, h, Format::rgba8, false);
}

void Renderer::Impl::screen(const Target& target, const Program& program) {
    target.bind();
    program.use();
    nothing.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::draw_occlusion() {
    glDisable(GL_DEPTH_TEST);
    bind(kDepth, GL_TEXTURE_2D, scene.depth);
    screen(occlusion_raw, *occlusion);
    bind(kBloom, GL_TEXTURE_2D, occlusion_raw.colour);
    screen(occlusion_smooth, *occlusion_blur);
    bind(kOcclusion, GL_TEXTURE_2D, occlusion_smooth.colour);
}

void Renderer::Impl::draw_camera() {
    bind(kScene, GL_TEXTURE_2D, scene.colour);
    bind(kSmokeUnit, GL_TEXTURE_2D, smoke.colour);
    bind(kDepth, GL_TEXTURE_2D, scene.depth);
    if (quality == Quality::low) {
        screen(result, compose);
        return;
    }
    screen(bloom_a, *bright);
    for (int pass = 0; pass < 2; ++pass) {
        const float reach = pass == 0 ? 1.0f : 2.2f;
        blur->use();
        glUniform2f(blur->location("u_step"), reach / static_cast<float>(bloom_a.width), 0.0f);
        bind(kBloom, GL_TEXTURE_2D, bloom_a.colour);
        screen(bloom_b, *blur);
        glUniform2f(blur->location("u_step"), 0.0f, reach / static_cast<float>(bloom_a.height));
        bind(kBloom, GL_TEXTURE_2D, bloom_b.colour);
        screen(bloom_a, *blur);
    }
    bind(kBloom, GL_TEXTURE_2D, bloom_a.colour);
    screen(composed, compose);
    bind(kBloom, GL_TEXTURE_2D, composed.colour);
    finish->use();
    glUniform4f(finish->location("u_size"), static_cast<float>(composed.width), static_cast<float>(composed.height),
                1.0f / static_cast<float>(composed.width), 1.0f / static_cast<float>(composed.height));
    screen(result, *finish);
}

Renderer::Renderer(int width, int height, Quality quality) : impl_(std::make_unique<Impl>(width, height, quality)) {}
Renderer::~Renderer() = default;

void Renderer::resize(int width, int height) {
    impl_->resize(width, height);
}

void Renderer::draw(const View& view) {
    ScenePasses& passes = impl_->passes;
    passes.upload(view, impl_->scene.width, impl_->scene.height);
    passes.draw_depth(impl_->scene);
    gl::check("the depth pass");
    if (impl_->quality != Quality::low) impl_->draw_occlusion();
    passes.draw_colour(impl_->scene);
    gl::check("the colour pass");
    passes.draw_smoke(impl_->smoke, impl_->scene);
    impl_->draw_camera();
    gl::check("the camera passes");
}

Image Renderer::read() {
    Image image;
    image.width = impl_->width;
    image.height = impl_->height;
    const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::vector<std::uint8_t> rgba(4 * pixels);
    glBindFramebuffer(GL_FRAMEBUFFER, impl_->result.framebuffer.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    gl::check("reading the picture");
    image.rgb.resize(3 * pixels);
    for (int y = 0; y < image.height; ++y) {
        const std::uint8_t* from =
            &rgba[4 * static_cast<std::size_t>(image.height - 1 - y) * static_cast<std::size_t>(image.width)];
        std::uint8_t* to = &image.rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width)];
        for (int x = 0; x < image.width; ++x, from += 4, to += 3) {
            to[0] = from[0];
            to[1] = from[1];
            to[2] = from[2];
        }
    }
    return image;
}

void Renderer::present(std::uint32_t framebuffer, int width, int height) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, impl_->result.framebuffer.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(0, 0, impl_->width, impl_->height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    gl::check("presenting the picture");
}

}  // namespace calot::render
