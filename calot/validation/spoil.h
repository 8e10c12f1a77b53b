#pragma once
// Spoils the simulated side of a check, see Spoil.

#include "calot/tissue/model.h"
#include "calot/validation/case.h"

namespace calot::validation {

inline tissue::Model spoiled(const Options& options, tissue::Model model) {
    for (tissue::Material& m : model.materials) {
        m.youngs_modulus_Pa *= options.spoil.youngs_modulus;
        m.thermal_conductivity_W_per_mK *= options.spoil.thermal_conductivity;
        m.electric_conductivity_S_per_m *= options.spoil.electric_conductivity;
        m.water_mass_fraction *= options.spoil.water;
        m.arrhenius_frequency_per_s *= options.spoil.damage;
    }
    return model;
}

}  // namespace calot::validation
