#include "calot/render/scene_passes.h"

#include "calot/render/frame.h"
#include "calot/render/noise.h"
#include "calot/render/shaders.h"
#include "calot/render/units.h"

namespace calot::render {

namespace {

using gl::Program;
using gl::Target;
using gl::Texture;
using gl::VertexArray;

static_assert(sizeof(TissueVertex) == 19 * sizeof(float), "the tissue's attributes are uploaded as they lie");
static_assert(sizeof(InstrumentVertex) == 13 * sizeof(float));

constexpr float kSparkSize_m = 0.0045f;  ///< half of its halo's edge

Texture make_noise_texture(const std::vector<std::uint8_t>& texels) {
    const gl::DriverLeaksIgnored ignored;  // mipmaps are made by programs of the driver
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

/// Attributes that organs have not: at body temperature, never burnt.
void set_organ_attributes() {
    glVertexAttrib4f(3, 310.15f, 310.15f, 0.0f, 0.0f);
    glVertexAttrib2f(4, 0.0f, 0.0f);
    glVertexAttrib4f(5, 0.0f, 0.0f, 0.0f, 0.0f);
}

}  // namespace

void ScenePasses::GpuMesh::upload_indices(const std::vector<std::uint32_t>& index) {
    array.bind();  // the array keeps the binding of its indices
    indices.upload(index.data(), index.size() * sizeof(std::uint32_t));
    count = static_cast<GLsizei>(index.size());
}

void ScenePasses::GpuMesh::draw() const {
    if (count == 0) return;
    array.bind();
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
}

ScenePasses::ScenePasses(Quality quality, const std::string& defines)
    : quality_(quality),
      defines_(defines),
      mask_depth_("mask", defines, {shaders::kFrame, shaders::kMaskVertex}, {shaders::kDepthFragment}),
      tissue_depth_("tissue depth", defines + "#define MIXED\n", {shaders::kFrame, shaders::kTissueVertex},
                    {shaders::kDepthFragment}),
      instrument_depth_("instrument depth", defines, {shaders::kFrame, shaders::kInstrumentVertex},
                        {shaders::kDepthFragment}),
      tissue_colour_(tissue_program("tissue", "#define MIXED\n")),
      instrument_colour_("instrument", defines, {shaders::kFrame, shaders::kInstrumentVertex},
                         {shaders::kFrame, shaders::kLight, shaders::kInstrumentFragment}),
      spark_("spark", defines, {shaders::kFrame, shaders::kSparkVertex}, {shaders::kFrame, shaders::kSparkFragment}),
      smoke_("smoke", defines, {shaders::kFrame, shaders::kSmokeVertex}, {shaders::kFrame, shaders::kSmokeFragment}),
      drop_("drops", defines, {shaders::kFrame, shaders::kDropVertex}, {shaders::kFrame, shaders::kDropFragment}) {
    for (const Program* program : {&tissue_colour_, &instrument_colour_, &smoke_}) set_samplers(*program);
    upload_noise();
    lay_out_attributes();
}

gl::Program ScenePasses::tissue_program(const char* name, const std::string& more) const {
    using namespace shaders;
    return Program(name, defines_ + more, {kFrame, kTissueVertex}, {kFrame, kLight, kTissueLooks, kTissueFragment});
}

void ScenePasses::upload_noise() {
    const NoiseTextures textures = make_noise();
    glActiveTexture(GL_TEXTURE0);
    noise_[kLobules] = make_noise_texture(textures.lobules);
    noise_[kSmooth] = make_noise_texture(textures.smooth);
    noise_[kBump] = make_noise_texture(textures.bump);
}

void ScenePasses::lay_out_attributes() {
    tissue_.array.bind();
    tissue_.vertices.bind();
    const int components[] = {3, 3, 3, 4, 2, 4};
    std::size_t offset = 0;
    for (GLuint location = 0; location < 6; ++location) {
        VertexArray::attribute(location, components[location], sizeof(TissueVertex), offset);
        offset += static_cast<std::size_t>(components[location]) * sizeof(float);
    }
    tissue_.indices.bind();

    instrument_.array.bind();
    instrument_.vertices.bind();
    VertexArray::attribute(0, 3, sizeof(InstrumentVertex), offsetof(InstrumentVertex, world_m));
    VertexArray::attribute(1, 3, sizeof(InstrumentVertex), offsetof(InstrumentVertex, normal));
    VertexArray::attribute(2, 3, sizeof(InstrumentVertex), offsetof(InstrumentVertex, along));
    VertexArray::attribute(3, 4, sizeof(InstrumentVertex), offsetof(InstrumentVertex, metal));
    instrument_.indices.bind();

    smoke_array_.bind();
    smoke_buffer_.bind();
    for (GLuint location = 0; location < 3; ++location)
        VertexArray::attribute(location, 4, sizeof(SmokeSprite), location * 4 * sizeof(float), 1);

    drop_array_.bind();
    drop_buffer_.bind();
    for (GLuint location = 0; location < 2; ++location)
        VertexArray::attribute(location, 4, sizeof(DropSprite), location * 4 * sizeof(float), 1);
    glBindVertexArray(0);
}

void ScenePasses::upload(const View& view, int width, int height) {
    const FrameUniforms frame = make_frame(view, width, height);
    frame_buffer_.upload(&frame, sizeof(frame));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer_.name());

    tissue_.vertices.upload(view.tissue.data(), view.tissue.size() * sizeof(TissueVertex));
    const auto count = static_cast<GLsizei>(view.tissue_index.size());
    if (view.tissue_index_version != index_version_ || count != tissue_.count || view.tissue_index_version == 0) {
        tissue_.upload_indices(view.tissue_index);
        index_version_ = view.tissue_index_version;
    }
    build_instrument(view.instrument, instrument_mesh_);
    instrument_.vertices.upload(instrument_mesh_.vertex.data(),
                                instrument_mesh_.vertex.size() * sizeof(InstrumentVertex));
    instrument_.upload_indices(instrument_mesh_.index);
    upload_organs(view);
    make_sprites(view, sprites_);
    smoke_buffer_.upload(sprites_.data(), sprites_.size() * sizeof(SmokeSprite));
    make_drops(view, drops_);
    drop_buffer_.upload(drops_.data(), drops_.size() * sizeof(DropSprite));
}

void ScenePasses::upload_organs(const View& view) {
    if (view.organs == organs_drawn_ && view.organs_version == organs_version_ &&
        organs_.size() == (view.organs != nullptr ? view.organs->size() : 0))
        return;
    organs_.clear();
    organs_drawn_ = view.organs;
    organs_version_ = view.organs_version;
    if (view.organs == nullptr) return;
    for (const OrganMesh& organ : *view.organs) {
        OrganOnGpu& on_gpu = organs_.emplace_back();
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
        on_gpu.mesh.upload_indices(organ.mesh.index);
    }
    glBindVertexArray(0);
}

void ScenePasses::draw_depth(const Target& scene) const {
    for (const Unit unit : {kLobules, kSmooth, kBump})
        bind(unit, GL_TEXTURE_3D, noise_[static_cast<std::size_t>(unit)]);
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
    mask_depth_.use();
    nothing_.bind();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 2 * 96 + 2);
    if (quality_ == Quality::low) {  // where geometry costs about as much as shading, twice through is too much
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        return;
    }
    glEnable(GL_CULL_FACE);
    tissue_depth_.use();
    tissue_.draw();
    for (const OrganOnGpu& organ : organs_) {
        set_organ_attributes();
        organ.mesh.draw();
    }
    instrument_depth_.use();
    instrument_.draw();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

const Program& ScenePasses::organ_program(Look look) {
    auto& program = organ_colour_[static_cast<std::size_t>(look)];
    if (!program) {
        program = std::make_unique<Program>(
            tissue_program("organ", std::string("#define ORGAN_LOOK ") + look_function(look) + "\n"));
        set_samplers(*program);
    }
    return *program;
}

void ScenePasses::draw_colour(const Target& scene) {
    scene.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(quality_ == Quality::low ? GL_TRUE : GL_FALSE);
    glEnable(GL_CULL_FACE);
    // Nearest first, so that what is hidden is not shaded.
    instrument_colour_.use();
    instrument_.draw();
    tissue_colour_.use();
    tissue_.draw();
    for (const OrganOnGpu& organ : organs_) {
        organ_program(organ.look).use();
        set_organ_attributes();
        organ.mesh.draw();
    }
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    draw_drops();
    // The spark adds its light.
    glBlendFunc(GL_ONE, GL_ONE);
    glDisable(GL_CULL_FACE);
    spark_.use();
    glUniform1f(spark_.location("u_size"), kSparkSize_m);
    nothing_.bind();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
}

void ScenePasses::draw_drops() const {
    if (drops_.empty()) return;
    glDisable(GL_CULL_FACE);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    drop_.use();
    drop_array_.bind();
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(drops_.size()));
}

void ScenePasses::draw_smoke(const Target& smoke, const Target& scene) const {
    smoke.bind();
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    if (sprites_.empty()) return;
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    bind(kDepth, GL_TEXTURE_2D, scene.depth);
    smoke_.use();
    glUniform4f(smoke_.location("u_smoke_pixels"), 1.0f / static_cast<float>(smoke.width),
                1.0f / static_cast<float>(smoke.height), 0.0f, 0.0f);
    smoke_array_.bind();
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(sprites_.size()));
    glDisable(GL_BLEND);
}

}  // namespace calot::render
