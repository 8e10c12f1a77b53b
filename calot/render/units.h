#pragma once
// Texture units, one for each thing that shaders read, so that samplers are set once.

#include "calot/render/gl.h"

namespace calot::render {

enum Unit { kLobules, kSmooth, kBump, kOcclusion, kScene, kSmokeUnit, kBloom, kDepth };

inline void bind(Unit unit, GLenum target, const gl::Texture& texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, texture.name());
}

/// All samplers a program may have; it ignores those that it has not.
inline void set_samplers(const gl::Program& program) {
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

}  // namespace calot::render
