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

    // The same a few vertices at a time, for whoever has ticks to make in between: where everything is, as it was at
    // the beginning, what tissue looks like, as it is when its turn comes.
    void begin(const simulation::Simulation& run, const tissue::Input& input, render::View& view);
    /// The next `count` vertices. True when all are there.
    bool go_on(const simulation::Simulation& run, std::size_t count, render::View& view);

  private:
    render::Camera camera_;
    std::vector<render::OrganMesh> organs_;
    simulation::WorldSurface world_;
    // The surface when a picture was begun.
    std::vector<Vec3f> rest_m_, rest_normal_;
    std::vector<std::int64_t> owner_;
    std::size_t done_ = 0;  ///< vertices that are filled
};

}  // namespace calot::viewer
