#pragma once
// What a tissue is made of. Values with their units, plausible ranges and sources: material.cpp; `calot materials`
// prints them. Scenes override single values.

#include <cstdint>
#include <string>
#include <vector>

namespace calot::tissue {

/// Index into Model::materials. Slot 0 is "none" (no tissue), real materials start at 1.
using MaterialIndex = std::uint8_t;
inline constexpr MaterialIndex kNoMaterial = 0;

struct Material {
    std::string name;  ///< "fat", "cystic_duct", "cystic_artery", "gallbladder_wall", "liver", ...

    // Mechanics
    double density_kg_per_m3 = 1000.0;
    double youngs_modulus_Pa = 5e3;  ///< at small strain
    double poisson_ratio = 0.45;

    // Heat
    double specific_heat_J_per_kgK = 3500.0;  ///< of the tissue as it lives, water included
    double thermal_conductivity_W_per_mK = 0.5;
    double water_mass_fraction = 0.7;             ///< kg water per kg tissue
    double dry_specific_heat_J_per_kgK = 1500.0;  ///< of what is left once the water has boiled off
    double removal_temperature_K = 573.15;        ///< dry solids turn to gas from here on
    double solid_latent_heat_J_per_kg = 1.0e6;    ///< to gasify a kilogram of dry solids at that temperature
    double perfusion_m3_per_s_kg = 0.0;           ///< blood flow per kilogram of tissue
    double vessel_transfer_W_per_m3K = 0.0;       ///< to blood that streams through a vessel of this tissue
    double arrhenius_frequency_per_s = 7.39e39;   ///< A in Omega = integral A exp(-Ea / (R T)) dt
    double arrhenius_energy_J_per_mol = 2.577e5;  ///< Ea

    // Electricity, at about 450 kHz and body temperature
    double electric_conductivity_S_per_m = 0.2;
    double electric_temperature_coefficient_per_K = 0.02;  ///< sigma rises by this share per kelvin up to boiling
    double electric_dry_conductivity_S_per_m = 1e-4;       ///< without water

    std::string source;  ///< where the values come from, for people
};

/// A property of materials as scenes and people write it: SI = value * factor + offset.
struct MaterialField {
    const char* key;  ///< in scene files
    const char* unit;
    double Material::*member;
    double factor, offset;
    double low, high;  ///< soft tissues lie in here, in the unit; a scene that says otherwise gets a warning
    const char* meaning;

    double value(const Material& material) const { return (material.*member - offset) / factor; }
    bool plausible(const Material& material) const;
};
const std::vector<MaterialField>& material_fields();

/// A publication, or a reason where there is none.
struct Reference {
    const char* key;
    const char* text;
};
const std::vector<Reference>& material_references();

/// Key of the reference for a value of a built-in tissue; empty where there is none (another material, another value).
std::string material_source(const Material& material, const MaterialField& field);

/// The built-in tissues, slot 0 = none. Each names its sources.
std::vector<Material> default_materials();

/// Index of a material by name; kNoMaterial when there is none of that name.
MaterialIndex find_material(const std::vector<Material>& materials, const std::string& name);

}  // namespace calot::tissue
