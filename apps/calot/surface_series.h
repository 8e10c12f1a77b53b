#pragma once
// surface/*.vtp and surface.pvd: the tissue's surface in time, as ParaView opens it.

#include <string>
#include <vector>

#include "calot/simulation/simulation.h"
#include "calot/surface/vtp.h"

namespace calot::app {

class SurfaceSeries {
  public:
    /// Writes into `directory` (surface.pvd) and `directory`/surface every `every_s` of simulated time; 0: never.
    SurfaceSeries(const std::string& directory, double every_s);
    bool due(double time_s) const { return every_s_ > 0.0 && time_s >= next_s_ - 0.5e-3; }
    void write(const simulation::Simulation& run);
    std::size_t size() const { return entries_.size(); }
    double last_time_s() const { return entries_.empty() ? -1.0 : entries_.back().time_s; }

  private:
    std::string directory_;
    double every_s_, next_s_ = 0.0;
    std::vector<surface::PvdEntry> entries_;
    simulation::WorldSurface world_;
};

}  // namespace calot::app
