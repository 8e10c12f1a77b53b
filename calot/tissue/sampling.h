#pragma once
// From an anatomy to the two lattices: hexels that hold heat, phyxels that deform (docs/physics.md section 1).

#include "calot/anatomy/anatomy.h"
#include "calot/tissue/model.h"

namespace calot::tissue {

struct SamplingParameters {
    double hexel_spacing_m = 0.6e-3;  ///< s_h
    int hexels_per_edge = 4;          ///< m: phyxel spacing is m * s_h
};

/// Samples the deformable tissues inside Anatomy::field; hexels lie where a cell's centre is inside a tissue. Ghost
/// phyxels are empty cells at least half inside organs that hold. Throws InputError when a material is unknown, nothing
/// is sampled, or m is not 1, 2 or 4. Physics parameters keep their defaults; substeps are set from the softest tissue
/// (prepare_time_step).
Model sample(const anatomy::Anatomy& anatomy, const SamplingParameters& parameters, std::vector<Material> materials = default_materials());

/// Sets DeformationParameters::substeps (when 0): the stable step of fat (the softest material in use) rules. Stiffer
/// phyxels are made heavier until they are stable at it too (deformation/stable_mass.h).
void prepare_time_step(Model& model);

}  // namespace calot::tissue
