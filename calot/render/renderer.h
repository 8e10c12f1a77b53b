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

enum class Api { any, opengl, opengl_es };

/// A context without a window (EGL surfaceless). Throws std::runtime_error saying what is missing.
class OffscreenContext {
  public:
    explicit OffscreenContext(Api api = Api::any);
    ~OffscreenContext();
    std::string description() const;  ///< vendor, renderer, version

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Needs a current context. All objects live in that context, which must be current when it is destroyed.
class Renderer {
  public:
    /// Throws std::runtime_error when OpenGL lacks something.
    Renderer(int width, int height, Quality quality);
    ~Renderer();
    void resize(int width, int height);
    void draw(const View& view);  ///< into the renderer's own frame buffer
    Image read();                 ///< what draw() made
    /// Copies what draw() made into a frame buffer of the caller's (0 = the window), `width` x `height` from its
    /// corner.
    void present(std::uint32_t framebuffer, int width, int height);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Written under a temporary name and renamed. Throws InputError when that fails.
void write_png(const std::string& path, const Image& image);

/// A JPEG file's bytes; `quality` from 1 to 100.
std::string jpeg(const Image& image, int quality);

}  // namespace calot::render
