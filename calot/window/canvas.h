#pragma once
// The operating field in the window: a renderer at the quality that the machine can do.

#include <memory>
#include <string>

#include "calot/render/renderer.h"
#include "calot/viewer/quality.h"

namespace calot::window {

class Canvas {
  public:
    explicit Canvas(const std::string& gl_renderer);

    /// -1: chosen automatically.
    void choose(int tier);
    /// Draws into the window. `measure`: the time counts for the choice of quality.
    void draw(const render::View& view, int width, int height, double now_s);
    int tier() const { return governor_.tier(); }
    double draw_s() const { return governor_.mean_s(); }

  private:
    void prepare(int width, int height);

    viewer::QualityGovernor governor_;
    std::unique_ptr<render::Renderer> renderer_;
    render::Quality quality_ = render::Quality::low;
};

/// What the window shows, from its back buffer: call before swapping.
render::Image read_window(int width, int height);

}  // namespace calot::window
