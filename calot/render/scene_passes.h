#pragma once
// What is in front of the camera, on the GPU: tissue, organs, instrument, smoke, and the passes that draw them.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "calot/render/drop_sprites.h"
#include "calot/render/gl.h"
#include "calot/render/instrument_mesh.h"
#include "calot/render/smoke_sprites.h"
#include "calot/render/view.h"

namespace calot::render {

class ScenePasses {
  public:
    /// `defines` are those that all shaders share.
    ScenePasses(Quality quality, const std::string& defines);

    /// Takes a view over; `width` and `height` are the scene target's.
    void upload(const View& view, int width, int height);
    /// Clears the target; depth of the mask, and except at low quality of all else.
    void draw_depth(const gl::Target& scene) const;
    void draw_colour(const gl::Target& scene);
    void draw_smoke(const gl::Target& smoke, const gl::Target& scene) const;

  private:
    /// Vertices and indices of one mesh.
    struct GpuMesh {
        gl::VertexArray array;
        gl::Buffer vertices{GL_ARRAY_BUFFER};
        gl::Buffer indices{GL_ELEMENT_ARRAY_BUFFER};
        GLsizei count = 0;

        void upload_indices(const std::vector<std::uint32_t>& index);
        void draw() const;
    };
    struct OrganOnGpu {
        Look look = Look::liver;
        GpuMesh mesh;
    };

    void lay_out_attributes();
    void upload_noise();
    void draw_drops() const;
    void upload_organs(const View& view);
    gl::Program tissue_program(const char* name, const std::string& more) const;
    const gl::Program& organ_program(Look look);

    Quality quality_;
    std::string defines_;
    std::array<gl::Texture, 3> noise_;  ///< kLobules, kSmooth, kBump
    gl::Buffer frame_buffer_{GL_UNIFORM_BUFFER};
    gl::VertexArray nothing_;  ///< for draws without attributes

    GpuMesh tissue_;
    std::uint64_t index_version_ = 0;
    GpuMesh instrument_;
    InstrumentMesh instrument_mesh_;
    std::vector<OrganOnGpu> organs_;
    const std::vector<OrganMesh>* organs_drawn_ = nullptr;
    std::uint64_t organs_version_ = 0;
    gl::VertexArray smoke_array_;
    gl::Buffer smoke_buffer_{GL_ARRAY_BUFFER};
    std::vector<SmokeSprite> sprites_;
    gl::VertexArray drop_array_;
    gl::Buffer drop_buffer_{GL_ARRAY_BUFFER};
    std::vector<DropSprite> drops_;

    gl::Program mask_depth_, tissue_depth_, instrument_depth_;
    gl::Program tissue_colour_, instrument_colour_, spark_, smoke_, drop_;
    std::array<std::unique_ptr<gl::Program>, 7> organ_colour_;  ///< made when a look is first drawn
};

}  // namespace calot::render
