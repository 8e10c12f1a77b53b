#include "calot/window/canvas.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>

#include "calot/render/gl.h"
#include "calot/viewer/session.h"

namespace calot::window {

Canvas::Canvas(const std::string& gl_renderer) : governor_(viewer::start_tier(gl_renderer.c_str())) {}

void Canvas::choose(int tier) {
    if (tier < 0)
        governor_.release();
    else
        governor_.fix(tier);
}

void Canvas::prepare(int width, int height) {
    const viewer::Tier& tier = viewer::tiers()[static_cast<std::size_t>(governor_.tier())];
    const int w = std::max(64, static_cast<int>(std::lround(width * tier.scale)));
    const int h = std::max(48, static_cast<int>(std::lround(height * tier.scale)));
    if (!renderer_ || quality_ != tier.quality) {
        renderer_.reset();  // first, so that both do not need memory at once
        renderer_ = std::make_unique<render::Renderer>(w, h, tier.quality);
        quality_ = tier.quality;
    }
    renderer_->resize(w, h);
}

void Canvas::draw(const render::View& view, int width, int height, double now_s) {
    prepare(width, height);
    const double begun_s = viewer::steady_s();
    renderer_->draw(view);
    renderer_->present(0, width, height);
    glFinish();  // without it the time would be that of asking, not of drawing
    governor_.add(viewer::steady_s() - begun_s, now_s);
}

render::Image read_window(int width, int height) {
    render::Image image;
    image.width = width;
    image.height = height;
    const auto stride = static_cast<std::size_t>(width) * 3;
    std::vector<std::uint8_t> rows(stride * static_cast<std::size_t>(height));
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    render::gl::check("reading the window");
    image.rgb.resize(rows.size());
    for (int y = 0; y < height; ++y)
        std::copy_n(&rows[static_cast<std::size_t>(height - 1 - y) * stride], stride,
                    &image.rgb[static_cast<std::size_t>(y) * stride]);
    return image;
}

}  // namespace calot::window
