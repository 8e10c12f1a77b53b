#pragma once
// Fills a render::View from a running simulation.

#include <vector>

#include "calot/render/view.h"
#include "calot/simulation/simulation.h"

namespace calot::viewer {

/// What stays the same from picture to picture.
class Picture {
  public:
    explicit Picture(const simulation::Setup& setup);

    /// The simulation at this moment. `view` may be an older one: its memory is used again.
    void fill(const simulation::Simulation& run, const tissue::Input& input, render::View& view);

  private:
    render::Camera camera_;
    std::vector<render::OrganMesh> organs_;
    simulation::WorldSurface world_;
};

}  // namespace calot::viewer
