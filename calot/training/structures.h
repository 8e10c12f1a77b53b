#pragma once
// What must be found and must not be hurt: cystic duct, cystic artery, the liver's face, the fat between.
//
// Exposure. A surface hexel of a structure has an outward direction n, away from the structure's hexels within 2.5
// cells. It is exposed when it is there and all cells along n, up to 1.5 mm, are free:
//
//        free  free              A hexel whose ray enters an organ that holds tissue is covered for good: no hook
//          ^                     could bare it, and it does not count.
//        [o o o]  structure
//
// 1.5 mm is room enough to see and to pass a wire of 1 mm.

#include <cstdint>
#include <string>
#include <vector>

#include "calot/base/archive.h"
#include "calot/base/array.h"
#include "calot/simulation/simulation.h"

namespace calot::training {

/// What became of a structure, as of the last look.
struct StructureState {
    double exposed = 0.0;  ///< share of the surface that faces the lens
    double freed = 0.0;    ///< share of the surface all round
    double peak_K = 0.0;
    std::int64_t injured = 0;  ///< hexels with Omega >= 1 or gone
    std::int64_t burnt = 0;    ///< gone
    std::int64_t hidden = 0;   ///< injured, still there and not exposed
};

/// Duct or artery.
class Structure {
  public:
    /// `eye_m`: where the laparoscope is, for "towards the lens".
    Structure(const tissue::Model& model, tissue::MaterialIndex material, const Vec3& eye_m);

    tissue::MaterialIndex material() const { return material_; }
    bool exists() const { return !hexels_.empty(); }
    std::size_t surface_size() const { return probes_.size(); }
    StructureState look(const tissue::State& state) const;
    /// Whether a hexel of the structure is exposed now; for pictures.
    const std::vector<std::int64_t>& hexels() const { return hexels_; }

  private:
    struct Probe {
        std::int64_t hexel = 0;
        std::int32_t first = 0, count = 0;  ///< of cells_
        bool front = false;
    };
    void add_probe(const tissue::Model& model, std::int64_t hexel, const Vec3& eye_m);
    bool free(const tissue::State& state, const Probe& probe) const;

    tissue::MaterialIndex material_;
    std::vector<std::int64_t> hexels_;
    std::vector<Probe> probes_;
    std::vector<std::int64_t> cells_;     ///< that must be free, probe by probe
    std::vector<std::int32_t> probe_of_;  ///< [hexels_] index into probes_, -1 inside
    std::int64_t front_probes_ = 0;
};

/// Hexels that touch an organ.
std::vector<std::int64_t> hexels_at_organ(const tissue::Model& model, const std::string& organ);

/// Fat that lies between duct and artery as the laparoscope sees them: same x as hexels of both, y between the middles
/// of the two.
BitArray fat_between(const tissue::Model& model, const Structure& duct, const Structure& artery,
                     tissue::MaterialIndex fat, std::int64_t& count);

}  // namespace calot::training
