#include "calot/window/backdrop.h"

#include <cstdint>

#include <epoxy/gl.h>
#include <imgui.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#include <stb/stb_image.h>

namespace calot::window {

namespace {

constexpr ImU32 kDim = IM_COL32(112, 112, 118, 255);

}  // namespace

Backdrop::Backdrop(const std::string& file) {
    int channels = 0;
    stbi_uc* pixels = stbi_load(file.c_str(), &width_, &height_, &channels, 3);
    if (pixels == nullptr) return;
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_, height_, 0, GL_RGB, GL_UNSIGNED_BYTE, pixels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    stbi_image_free(pixels);
}

Backdrop::~Backdrop() {
    if (texture_ != 0) glDeleteTextures(1, &texture_);
}

void Backdrop::draw() const {
    if (texture_ == 0) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float window = screen.x / screen.y, picture = static_cast<float>(width_) / static_cast<float>(height_);
    // Cut off what would be too wide or too high.
    const float u = window < picture ? 0.5f * (1.0f - window / picture) : 0.0f;
    const float v = window > picture ? 0.5f * (1.0f - picture / window) : 0.0f;
    ImGui::GetBackgroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)),
                                             ImVec2(0.0f, 0.0f), screen, ImVec2(u, v), ImVec2(1.0f - u, 1.0f - v),
                                             kDim);
}

}  // namespace calot::window
