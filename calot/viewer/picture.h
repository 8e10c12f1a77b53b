#pragma once
// Fills a render::View from a running simulation.
//
// Physics does not wait for pictures. What it has to give is copied (Moment: the surface at rest and how tissue is
// displaced) or worked out a few vertices after every tick (what tissue looks like: heat moves too, and its arrays are
// too large to copy). Where vertices are, smoothed and displaced, whoever draws works out of the copy (Placer).

#include <cstdint>
#include <vector>

#include "calot/deformation/embedded_points.h"
#include "calot/render/view.h"
#include "calot/simulation/simulation.h"
#include "calot/surface/smoothing.h"

namespace calot::viewer {

/// The surface and how it is displaced, as they were when a picture was begun.
struct Moment {
    const tissue::Model* model = nullptr;
    surface::Mesh rest;  ///< as surface::Surface::rest_mesh(), but for its triangles: they are in the View
    std::vector<std::int64_t> owner;
    std::uint64_t surface_version = 0;
    deformation::Pose pose;
    bool placed = false;  ///< the View's vertices are where they belong
};

/// Moves the vertices of pictures to their places. One for each thread that does.
class Placer {
  public:
    /// Unless they are there.
    void place(Moment& moment, render::View& view);

  private:
    // Of the last picture, to be used again while the surface stays
    std::uint64_t surface_version_ = 0;
    surface::Mesh smooth_;
    surface::SmoothingWork smoothing_;
    // How vertices hang on phyxels, kept while neither surface nor links change
    deformation::EmbeddedPoints points_;
    std::int64_t links_severed_ = -1;
    bool kept_ = false;  ///< points_ belong to these
    simulation::WorldSurface world_;
};

/// What stays the same from picture to picture.
class Picture {
  public:
    explicit Picture(const simulation::Setup& setup);

    /// The simulation at this moment. `view` may be an older one: its memory is used again.
    void fill(const simulation::Simulation& run, const tissue::Input& input, render::View& view);

    // The same in parts, for whoever has ticks to make in between: begin, go on until all looks are there, place.
    void begin(const simulation::Simulation& run, const tissue::Input& input, Moment& moment, render::View& view);
    /// The looks of the next `count` vertices. True when all are there.
    bool go_on(const simulation::Simulation& run, std::size_t count, const Moment& moment, render::View& view);

  private:
    render::Camera camera_;
    std::vector<render::OrganMesh> organs_;
    std::size_t done_ = 0;  ///< vertices that have their looks
    simulation::WorldSurface world_;
    Moment moment_;
    Placer placer_;
};

}  // namespace calot::viewer
