#include "calot/tissue/material.h"

namespace calot::tissue {

namespace {

/// ml/(min kg), the tables' unit, to m^3/(s kg).
constexpr double perfusion_from_ml_per_min_kg(double flow) { return flow * 1e-6 / 60.0; }

// Mechanics of liver, gallbladder, duct and artery: PMC6925591, Table 1 (E = 3 G). Thermal and electric values: IT'IS
// tissue database, Gabriel 1996; fat at 400 kHz to 1 MHz: 0.0248-0.0251 S/m (doi 10.1186/s12938-018-0473-9).
// Dry specific heats follow from those of living tissue, less their water's: (c - f 4187) / (1 - f).
// Removal temperature and solid latent heat are chosen, not published: dried organic matter pyrolyses at 250-400 C and
// takes about 1 MJ/kg to gasify. Fat goes sooner and for less: its melted lipid smokes at about 190 C, and most of it
// runs and spatters off instead of turning to gas.
constexpr const char* kMechanics = "mechanics: PMC6925591 Table 1; thermal and electric: IT'IS database, Gabriel 1996";

}  // namespace

std::vector<Material> default_materials() {
    std::vector<Material> materials(1);
    materials[0].name = "none";

    Material fat;
    fat.name = "fat";
    fat.density_kg_per_m3 = 911.0;
    fat.youngs_modulus_Pa = 5e3;
    fat.specific_heat_J_per_kgK = 2348.0;
    fat.thermal_conductivity_W_per_mK = 0.21;
    fat.water_mass_fraction = 0.15;
    fat.dry_specific_heat_J_per_kgK = 2023.5;
    fat.removal_temperature_K = 473.15;
    fat.solid_latent_heat_J_per_kg = 0.3e6;
    fat.perfusion_m3_per_s_kg = perfusion_from_ml_per_min_kg(33.0);
    fat.electric_conductivity_S_per_m = 0.025;
    fat.source = "E 2-10 kPa, middle of the published range; thermal: IT'IS database; electric: doi 10.1186/s12938-018-0473-9";
    materials.push_back(fat);

    Material duct;
    duct.name = "cystic_duct";
    duct.density_kg_per_m3 = 1071.0;
    duct.youngs_modulus_Pa = 500e3;
    duct.specific_heat_J_per_kgK = 3700.0;
    duct.thermal_conductivity_W_per_mK = 0.52;
    duct.water_mass_fraction = 0.70;
    duct.dry_specific_heat_J_per_kgK = 2563.7;
    duct.perfusion_m3_per_s_kg = perfusion_from_ml_per_min_kg(30.0);
    duct.arrhenius_frequency_per_s = 1.606e45;  // collagen
    duct.arrhenius_energy_J_per_mol = 3.06e5;
    duct.electric_conductivity_S_per_m = 0.5;
    duct.source = kMechanics;
    materials.push_back(duct);

    Material artery;
    artery.name = "cystic_artery";
    artery.density_kg_per_m3 = 1102.0;
    artery.youngs_modulus_Pa = 630e3;
    artery.specific_heat_J_per_kgK = 3306.0;
    artery.thermal_conductivity_W_per_mK = 0.46;
    artery.water_mass_fraction = 0.70;
    artery.dry_specific_heat_J_per_kgK = 1250.3;
    artery.arrhenius_frequency_per_s = 5.6e63;
    artery.arrhenius_energy_J_per_mol = 4.3e5;
    artery.electric_conductivity_S_per_m = 0.32;
    artery.source = kMechanics;
    materials.push_back(artery);

    Material wall;
    wall.name = "gallbladder_wall";
    wall.density_kg_per_m3 = 1071.0;
    wall.youngs_modulus_Pa = 255e3;
    wall.specific_heat_J_per_kgK = 3716.0;
    wall.thermal_conductivity_W_per_mK = 0.52;
    wall.water_mass_fraction = 0.75;
    wall.dry_specific_heat_J_per_kgK = 2303.0;
    wall.perfusion_m3_per_s_kg = perfusion_from_ml_per_min_kg(30.0);
    wall.arrhenius_frequency_per_s = 1.606e45;
    wall.arrhenius_energy_J_per_mol = 3.06e5;
    wall.electric_conductivity_S_per_m = 0.9;
    wall.source = kMechanics;
    materials.push_back(wall);

    Material liver;
    liver.name = "liver";
    liver.density_kg_per_m3 = 1079.0;
    liver.youngs_modulus_Pa = 5.4e3;
    liver.specific_heat_J_per_kgK = 3540.0;
    liver.thermal_conductivity_W_per_mK = 0.52;
    liver.water_mass_fraction = 0.70;
    liver.dry_specific_heat_J_per_kgK = 2030.3;
    liver.perfusion_m3_per_s_kg = perfusion_from_ml_per_min_kg(860.0);
    liver.electric_conductivity_S_per_m = 0.15;
    liver.source = kMechanics;
    materials.push_back(liver);
    return materials;
}

MaterialIndex find_material(const std::vector<Material>& materials, const std::string& name) {
    for (std::size_t k = 1; k < materials.size(); ++k)
        if (materials[k].name == name) return static_cast<MaterialIndex>(k);
    return kNoMaterial;
}

}  // namespace calot::tissue
