#pragma once
// Fills a render::View from a running simulation.

#include <vector>

#include "calot/render/view.h"
#include "calot/scene/scene.h"
#include "calot/simulation/simulation.h"

namespace calot::app {

/// What stays the same from picture to picture.
class Picture {
  public:
    Picture(const scene::Scene& scene, const simulation::Simulation& run);

    /// The simulation at this moment. `view` may be an older one: its memory is used again.
    void fill(const simulation::Simulation& run, const tissue::Input& input, render::View& view);

    const std::vector<render::OrganMesh>& organs() const { return organs_; }

  private:
    render::TissueVertex vertex(const simulation::Simulation& run, const Vec3f& rest_m, std::int64_t owner) const;

    render::Camera camera_;
    std::vector<render::OrganMesh> organs_;
    std::vector<int> look_of_material_;  ///< slot of TissueVertex::look_weights
    BitArray initial_;                   ///< hexels present when the run began
    BitArray initially_open_;            ///< of these, those at the surface then
    simulation::WorldSurface world_;
};

}  // namespace calot::app
