// A picture in passes:
//
//   depth (mask, tissue, organs, hook) -> obscurance, half size -> colour (depth equal) + spark -> smoke, half size
//   -> bright parts, quarter size, blurred -> compose (lens, smoke, bloom, film) -> finish (edges, grain)
//
// Low quality leaves out obscurance, bloom and the finish. Depth first, as shading is what costs.

#include "calot/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "calot/render/frame.h"
#include "calot/render/gl.h"
#include "calot/render/instrument_mesh.h"
#include "calot/render/noise.h"
#include "calot/render/shaders.h"
#include "calot/render/smoke_sprites.h"

namespace calot::render {

namespace {

using gl::Buffer;
using gl::Format;
using gl::Program;
using gl::Target;
using gl::Texture;
using gl::VertexArray;

static_assert(sizeof(TissueVertex) == 18 * sizeof(float), "the tissue's attributes are uploaded as they lie");
static_assert(sizeof(InstrumentVertex) == 13 * sizeof(float));

enum Unit { kLobules, kSmooth, kBump, kOcclusion, kScene, kSmokeUnit, kBloom, kDepth, kUnits };

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

Texture upload_noise(const std::vector<std::uint8_t>& texels) {
    Texture texture = gl::make_texture(GL_TEXTURE_3D, GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR, GL_REPEAT);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, kNoiseSize, kNoiseSize, kNoiseSize, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 texels.data());
    glGenerateMipmap(GL_TEXTURE_3D);
    return texture;
}

const char* look_function(Look look) {
    switch (look) {
        case Look::fat:
            return "fat_look(s)";
        case Look::duct:
            return "duct_look(s)";
        case Look::artery:
            return "artery_look(s, pulse)";
        case Look::gallbladder:
            return "gallbladder_look(s)";
        case Look::liver:
            return "liver_look(s)";
        case Look::peritoneum:
            return "peritoneum_look(s)";
        case Look::bowel:
            return "bowel_look(s)";
    }
    return "fat_look(s)";
}

/// Vertices and indices of one mesh on the GPU.
struct GpuMesh {
    VertexArray array;
    Buffer vertices{GL_ARRAY_BUFFER};
    Buffer indices{GL_ELEMENT_ARRAY_BUFFER};
    GLsizei count = 0;

    void draw() const {
        if (count == 0) return;
        array.bind();
        glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
    }
};

struct OrganOnGpu {
    Look look = Look::liver;
    GpuMesh mesh;
};

}  // namespace

struct Renderer::Impl {
    Quality quality;
    Settings settings;
    bool hdr;
    std::string defines;
    int width = 0;
    int height = 0;

    std::array<Texture, 3> noise;
    Buffer frame_buffer{GL_UNIFORM_BUFFER};
    VertexArray nothing;  ///< for draws without attributes

    GpuMesh tissue;
    GpuMesh instrument;
    InstrumentMesh instrument_mesh;
    std::vector<OrganOnGpu> organs;
    const std::vector<OrganMesh>* organs_drawn = nullptr;
    std::uint64_t organs_version = 0;
    std::uint64_t index_version = 0;
    VertexArray smoke_array;
    Buffer smoke_buffer{GL_ARRAY_BUFFER};
    std::vector<SmokeSprite> sprites;

    Program mask_depth, tissue_depth, instrument_depth, tissue_colour, instrument_colour, spark, smoke_program;
    std::array<std::unique_ptr<Program>, 7> organ_colour;  ///< made when a look is first drawn
    std::unique_ptr<Program> occlusion, occlusion_blur, bright, blur, finish;
    Program compose;

    Target scene, smoke, occlusion_raw, occlusion_smooth, bloom_a, bloom_b, composed, result;

    Impl(int width, int height, Quality quality);
    Program tissue_program(const char* name, const std::string& more) const {
        using namespace shaders;
        return Program(name, defines + more, {kFrame, kTissueVertex}, {kFrame, kLight, kTissueLooks, kTissueFragment});
    }
    void resize(int new_width, int new_height);
    void upload(const View& view);
    void upload_organs(const View& view);
    void draw_depth();
    void draw_occlusion();
    void draw_colour();
    void draw_smoke();
    void draw_camera();
    const Program& organ_program(Look look);
    void screen(const Target& target, const Program& program);
};

namespace {

void bind(Unit unit, GLenum target, const Texture& texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, texture.name());
}

/// Attributes that organs have not: at body temperature, never burnt.
void set_organ_attributes() {
    glVertexAttrib4f(3, 310.15f, 310.15f, 0.0f, 0.0f);
    glVertexAttrib1f(4, 0.0f);
    glVertexAttrib4f(5, 0.0f, 0.0f, 0.0f, 0.0f);
}

/// All samplers a program may have; it ignores those that it has not.
void set_samplers(const Program& program) {
    program.use();
    program.sampler("u_lobules", kLobules);
    program.sampler("u_smooth", kSmooth);
    program.sampler("u_bump", kBump);
    program.sampler("u_occlusion", kOcclusion);
    program.sampler("u_scene", kScene);
    program.sampler("u_smoke", kSmokeUnit);
    program.sampler("u_bloom", kBloom);
    program.sampler("u_source", kBloom);
    program.sampler("u_depth", kDepth);
}

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
      mask_depth("mask", defines, {shaders::kFrame, shaders::kMaskVertex}, {shaders::kDepthFragment}),
      tissue_depth("tissue depth", defines + "#define MIXED\n", {shaders::kFrame, shaders::kTissueVertex},
                   {shaders::kDepthFragment}),
      instrument_depth("instrument depth", defines, {shaders::kFrame, shaders::kInstrumentVertex},
                       {shaders::kDepthFragment}),
      tissue_colour(tissue_program("tissue", "#define MIXED\n")),
      instrument_colour("instrument", defines, {shaders::kFrame, shaders::kInstrumentVertex},
                        {shaders::kFrame, shaders::kLight, shaders::kInstrumentFragment}),
      spark("spark", defines, {shaders::kFrame, shaders::kSparkVertex}, {shaders::kFrame, shaders::kSparkFragment}),
      smoke_program("smoke", defines, {shaders::kFrame, shaders::kSmokeVertex},
                    {shaders::kFrame, shaders::kSmokeFragment}),
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
    for (const Program* program : {&tissue_colour, &instrument_colour, &smoke_program, &compose})
        set_samplers(*program);

    const NoiseTextures textures = make_noise();
    glActiveTexture(GL_TEXTURE0);
    noise[kLobules] = upload_noise(textures.lobules);
    noise[kSmooth] = upload_noise(textures.smooth);
    noise[kBump] = upload_noise(textures.bump);

    tissue.array.bind();
    tissue.vertices.bind();
    const int components[] = {3, 3, 3, 4, 1, 4};
    std::size_t offset = 0;
    for (GLuint location = 0; location < 6; ++location) {
        VertexArray::attribute(location, components[location], sizeof(TissueVertex), offset);
        offset += static_cast<std::size_t>(components[location]) * sizeof(float);
    }
    tissue.indices.bind();

    instrument.array.bind();
    instrument.vertices.bind();
    VertexArray::attribute(0, 3, sizeof(InstrumentVertex), offsetof(InstrumentVertex, world_m));
    VertexArray::attribute(1, 3, sizeof(InstrumentVertex), offsetof(InstrumentVertex, normal));
    VertexArray::attribute(2, 3, sizeof(InstrumentVertex), offsetof(InstrumentVertex, along));
    VertexArray::attribute(3, 4, sizeof(InstrumentVertex), offsetof(InstrumentVertex, metal));
    instrument.indices.bind();

    smoke_array.bind();
    smoke_buffer.bind();
    for (GLuint location = 0; location < 3; ++location)
        VertexArray::attribute(location, 4, sizeof(SmokeSprite), location * 4 * sizeof(float), 1);
    glBindVertexArray(0);
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

void Renderer::Impl::upload(const View& view) {
    const FrameUniforms frame = make_frame(view, scene.width, scene.height);
    frame_buffer.upload(&frame, sizeof(frame));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer.name());

    glBindVertexArray(0);
    tissue.vertices.upload(view.tissue.data(), view.tissue.size() * sizeof(TissueVertex));
    const auto count = static_cast<GLsizei>(view.tissue_index.size());
    if (view.tissue_index_version != index_version || count != tissue.count || view.tissue_index_version == 0) {
        tissue.indices.upload(view.tissue_index.data(), view.tissue_index.size() * sizeof(std::uint32_t));
        tissue.count = count;
        index_version = view.tissue_index_version;
    }
    build_instrument(view.instrument, instrument_mesh);
    instrument.vertices.upload(instrument_mesh.vertex.data(), instrument_mesh.vertex.size() * sizeof(InstrumentVertex));
    instrument.indices.upload(instrument_mesh.index.data(), instrument_mesh.index.size() * sizeof(std::uint32_t));
    instrument.count = static_cast<GLsizei>(instrument_mesh.index.size());
    upload_organs(view);
    make_sprites(view, sprites);
    smoke_buffer.upload(sprites.data(), sprites.size() * sizeof(SmokeSprite));
}

void Renderer::Impl::upload_organs(const View& view) {
    if (view.organs == organs_drawn && view.organs_version == organs_version &&
        organs.size() == (view.organs != nullptr ? view.organs->size() : 0))
        return;
    organs.clear();
    organs_drawn = view.organs;
    organs_version = view.organs_version;
    if (view.organs == nullptr) return;
    for (const OrganMesh& organ : *view.organs) {
        OrganOnGpu& on_gpu = organs.emplace_back();
        on_gpu.look = organ.look;
        std::vector<Vec3f> interleaved;
        interleaved.reserve(2 * organ.mesh.position_m.size());
        for (std::size_t k = 0; k < organ.mesh.position_m.size(); ++k) {
            interleaved.push_back(organ.mesh.position_m[k]);
            interleaved.push_back(organ.mesh.normal[k]);
        }
        on_gpu.mesh.array.bind();
        on_gpu.mesh.vertices.upload(interleaved.data(), interleaved.size() * sizeof(Vec3f), GL_STATIC_DRAW);
        VertexArray::attribute(0, 3, 2 * sizeof(Vec3f), 0);
        VertexArray::attribute(1, 3, 2 * sizeof(Vec3f), sizeof(Vec3f));
        VertexArray::attribute(2, 3, 2 * sizeof(Vec3f), 0);  // an organ is at rest where it is
        on_gpu.mesh.indices.upload(organ.mesh.index.data(), organ.mesh.index.size() * sizeof(std::uint32_t),
                                   GL_STATIC_DRAW);
        on_gpu.mesh.count = static_cast<GLsizei>(organ.mesh.index.size());
    }
    glBindVertexArray(0);
}

void Renderer::Impl::draw_depth() {
    scene.bind();
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClearDepthf(1.0f);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDisable(GL_CULL_FACE);
    mask_depth.use();
    nothing.bind();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 2 * 96 + 2);
    if (quality == Quality::low) {  // where geometry costs about as much as shading, twice through is too much
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        return;
    }
    glEnable(GL_CULL_FACE);
    tissue_depth.use();
    tissue.draw();
    for (const OrganOnGpu& organ : organs) {
        set_organ_attributes();
        organ.mesh.draw();
    }
    instrument_depth.use();
    instrument.draw();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

const Program& Renderer::Impl::organ_program(Look look) {
    auto& program = organ_colour[static_cast<std::size_t>(look)];
    if (!program) {
        program = std::make_unique<Program>(
            tissue_program("organ", std::string("#define ORGAN_LOOK ") + look_function(look) + "\n"));
        set_samplers(*program);
    }
    return *program;
}

void Renderer::Impl::draw_colour() {
    scene.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(quality == Quality::low ? GL_TRUE : GL_FALSE);
    glEnable(GL_CULL_FACE);
    // Nearest first, so that what is hidden is not shaded.
    instrument_colour.use();
    instrument.draw();
    tissue_colour.use();
    tissue.draw();
    for (const OrganOnGpu& organ : organs) {
        organ_program(organ.look).use();
        set_organ_attributes();
        organ.mesh.draw();
    }
    glDepthMask(GL_FALSE);
    // The spark adds its light.
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glDisable(GL_CULL_FACE);
    spark.use();
    glUniform1f(spark.location("u_size"), 0.0045f);
    nothing.bind();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
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

void Renderer::Impl::draw_smoke() {
    smoke.bind();
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    if (sprites.empty()) return;
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    bind(kDepth, GL_TEXTURE_2D, scene.depth);
    smoke_program.use();
    glUniform4f(smoke_program.location("u_smoke_pixels"), 1.0f / static_cast<float>(smoke.width),
                1.0f / static_cast<float>(smoke.height), 0.0f, 0.0f);
    smoke_array.bind();
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(sprites.size()));
    glDisable(GL_BLEND);
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
    impl_->upload(view);
    for (const Unit unit : {kLobules, kSmooth, kBump})
        bind(unit, GL_TEXTURE_3D, impl_->noise[static_cast<std::size_t>(unit)]);
    impl_->draw_depth();
    gl::check("the depth pass");
    if (impl_->quality != Quality::low) impl_->draw_occlusion();
    impl_->draw_colour();
    gl::check("the colour pass");
    impl_->draw_smoke();
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
