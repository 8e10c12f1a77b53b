#pragma once
// What was burnt or overheated that should not have been.

#include <cstdint>
#include <string>
#include <vector>

#include "calot/tissue/state.h"

namespace calot::app {

struct Injury {
    std::string structure;  ///< name of the material
    std::int64_t hexels_removed = 0;
    std::int64_t hexels_damaged = 0;  ///< still there, Arrhenius integral 1 and more: irreversibly injured
    double volume_m3 = 0.0;           ///< both
    double max_temperature_K = 0.0;
    double first_time_s = 0.0;
};

/// Watches everything but fat.
class InjuryWatch {
  public:
    InjuryWatch(const tissue::Model& model, const tissue::State& state);
    void look(const tissue::Model& model, const tissue::State& state, double time_s);
    /// Structures that were injured, as of the last look.
    std::vector<Injury> injuries() const;

  private:
    std::vector<std::int64_t> hexels_;  ///< watched: not fat, present at the start
    std::vector<Injury> by_material_;
};

}  // namespace calot::app
