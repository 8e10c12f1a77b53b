#pragma once
// Draws a View. OpenGL 3.3 core / OpenGL ES 3.0, one shader source for both.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "calot/render/view.h"

namespace calot::render {

/// 8-bit RGB rows from top to bottom.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;
};

/// A context without a window (EGL surfaceless). Throws std::runtime_error saying what is missing.
class OffscreenContext {
  public:
    OffscreenContext();
    ~OffscreenContext();
    std::string description() const;  ///< vendor, renderer, version

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Needs a current context. All objects live in that context.
class Renderer {
  public:
    Renderer(int width, int height, Quality quality);
    ~Renderer();
    void draw(const View& view);   ///< into the renderer's own frame buffer
    Image read();                  ///< what draw() made

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

void write_png(const std::string& path, const Image& image);

}  // namespace calot::render
