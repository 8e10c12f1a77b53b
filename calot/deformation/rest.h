#pragma once
// What a phyxel is at rest: moment matrix, volume, mass, elastic constants (docs/physics.md section 2).

#include <cstdint>
#include <span>

#include "calot/deformation/work.h"

namespace calot::deformation {

/// In double precision; refresh_phyxels stores it in Work as floats.
struct PhyxelRest {
    Mat3 moment_inverse_per_m2{0.0};  ///< A^-1; zero where A is (nearly) singular
    double volume_m3 = 0.0;           ///< v, effective; 0 for ghosts
    double mass_kg = 0.0;             ///< of its hexels; 0 = absent or ghost
    double fill = 0.0;                ///< share of its cell that its hexels take
    double moving_mass_kg = 0.0;      ///< at least a share of a full cell
    double hourglass_N_per_m = 0.0;   ///< kappa
    double mu_Pa = 0.0;
    double lambda_Pa = 0.0;
};

/// Of a phyxel or ghost, from its live links and from Work::occupancy. Zeros for an absent cell.
PhyxelRest phyxel_rest(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t phyxel);

/// Trace of the moment matrix before anything was severed: all links between cells that were present, in units of s^2.
double initial_trace(const tissue::Model& model, std::int64_t phyxel);

/// Of refresh_phyxels, what embedding and contacts ask for, and no more: moments, link words, mirrors.
void refresh_shapes(const tissue::Model& model, const tissue::State& state, Work& work,
                    std::span<const std::int64_t> phyxels);

/// Volume that a phyxel stands for over that of its own hexels, before anything is burnt.
///
/// Strain is known at the centres of cells. Where the surface cuts through a cell, its hexels lie to one side of the
/// centre; so their volume counts at their centroid, spread over the phyxels about it by trilinear weights. Without
/// this a bar six cells across, the outer ones half full, is some 10 % too stiff (docs/validation.md). What has burnt
/// away since shrinks the volume in proportion: new surfaces stay as coarse as their cells.
Array<float> volume_shares(const tissue::Model& model);

}  // namespace calot::deformation
