#include "calot/tissue/material.h"

#include <array>

namespace calot::tissue {

namespace {

using M = Material;
constexpr double kKelvin = 273.15;
constexpr double kPerMinuteAndMl = 1e-6 / 60.0;  ///< ml/(min kg) to m^3/(s kg)

/// A value of a built-in tissue in its field's unit, with its source.
struct Row {
    const char* key;
    double value;
    const char* source;
};
struct Tissue {
    const char* name;
    std::vector<Row> rows;
};

// Dry specific heats follow from those of living tissue, less their water's: (c - f 4187) / (1 - f).
// Removal temperature and latent heat of solids are chosen: dried organic matter pyrolyses at 250-400 C and takes about
// 1 MJ/kg to gasify. Fat goes sooner and for less: its melted lipid smokes at about 190 C, and most of it runs and
// spatters off instead of turning to gas.
// Streaming blood: laminar flow in a tube at constant wall temperature has Nu = 3.66, so that a metre of vessel of
// diameter D passes 3.66 pi k_blood per kelvin [W/(m K)], whatever D; over the cross-section pi D^2/4 that makes
// 4 * 3.66 k / D^2. D = 1.7 mm (the standard patient's artery, which is drawn solid) and k = 0.52 give 2.6e6 W/(m^3 K).
const std::vector<Tissue>& tissues() {
    static const std::vector<Tissue> all{
        {"fat",
         {{"density_kg_per_m3", 911.0, "itis"},
          {"youngs_modulus_kPa", 5.0, "fat-mechanics"},
          {"poisson_ratio", 0.45, "incompressible"},
          {"specific_heat_J_per_kgK", 2348.0, "itis"},
          {"thermal_conductivity_W_per_mK", 0.21, "itis"},
          {"water_mass_fraction", 0.15, "water"},
          {"dry_specific_heat_J_per_kgK", 2023.5, "derived"},
          {"removal_temperature_C", 200.0, "chosen"},
          {"solid_latent_heat_J_per_kg", 0.3e6, "chosen"},
          {"perfusion_ml_per_min_kg", 33.0, "itis"},
          {"vessel_transfer_W_per_m3K", 0.0, "no-vessel"},
          {"arrhenius_frequency_per_s", 7.39e39, "liver-damage"},
          {"arrhenius_energy_J_per_mol", 2.577e5, "liver-damage"},
          {"electric_conductivity_S_per_m", 0.025, "fat-electric"},
          {"electric_temperature_coefficient_per_K", 0.02, "duck"},
          {"electric_dry_conductivity_S_per_m", 1e-4, "chosen-dry"}}},
        {"cystic_duct",
         {{"density_kg_per_m3", 1071.0, "itis"},
          {"youngs_modulus_kPa", 500.0, "biliary-mechanics"},
          {"poisson_ratio", 0.45, "incompressible"},
          {"specific_heat_J_per_kgK", 3700.0, "itis"},
          {"thermal_conductivity_W_per_mK", 0.52, "itis"},
          {"water_mass_fraction", 0.70, "water"},
          {"dry_specific_heat_J_per_kgK", 2563.7, "derived"},
          {"removal_temperature_C", 300.0, "chosen"},
          {"solid_latent_heat_J_per_kg", 1e6, "chosen"},
          {"perfusion_ml_per_min_kg", 30.0, "itis"},
          {"vessel_transfer_W_per_m3K", 0.0, "no-vessel"},
          {"arrhenius_frequency_per_s", 1.606e45, "collagen-damage"},
          {"arrhenius_energy_J_per_mol", 3.06e5, "collagen-damage"},
          {"electric_conductivity_S_per_m", 0.5, "gabriel"},
          {"electric_temperature_coefficient_per_K", 0.02, "duck"},
          {"electric_dry_conductivity_S_per_m", 1e-4, "chosen-dry"}}},
        {"cystic_artery",
         {{"density_kg_per_m3", 1102.0, "itis"},
          {"youngs_modulus_kPa", 630.0, "biliary-mechanics"},
          {"poisson_ratio", 0.45, "incompressible"},
          {"specific_heat_J_per_kgK", 3306.0, "itis"},
          {"thermal_conductivity_W_per_mK", 0.46, "itis"},
          {"water_mass_fraction", 0.70, "water"},
          {"dry_specific_heat_J_per_kgK", 1250.3, "derived"},
          {"removal_temperature_C", 300.0, "chosen"},
          {"solid_latent_heat_J_per_kg", 1e6, "chosen"},
          {"perfusion_ml_per_min_kg", 0.0, "no-perfusion"},
          {"vessel_transfer_W_per_m3K", 2.6e6, "nusselt"},
          {"arrhenius_frequency_per_s", 5.6e63, "artery-damage"},
          {"arrhenius_energy_J_per_mol", 4.3e5, "artery-damage"},
          {"electric_conductivity_S_per_m", 0.32, "gabriel"},
          {"electric_temperature_coefficient_per_K", 0.02, "duck"},
          {"electric_dry_conductivity_S_per_m", 1e-4, "chosen-dry"}}},
        {"gallbladder_wall",
         {{"density_kg_per_m3", 1071.0, "itis"},
          {"youngs_modulus_kPa", 255.0, "biliary-mechanics"},
          {"poisson_ratio", 0.45, "incompressible"},
          {"specific_heat_J_per_kgK", 3716.0, "itis"},
          {"thermal_conductivity_W_per_mK", 0.52, "itis"},
          {"water_mass_fraction", 0.75, "water"},
          {"dry_specific_heat_J_per_kgK", 2303.0, "derived"},
          {"removal_temperature_C", 300.0, "chosen"},
          {"solid_latent_heat_J_per_kg", 1e6, "chosen"},
          {"perfusion_ml_per_min_kg", 30.0, "itis"},
          {"vessel_transfer_W_per_m3K", 0.0, "no-vessel"},
          {"arrhenius_frequency_per_s", 1.606e45, "collagen-damage"},
          {"arrhenius_energy_J_per_mol", 3.06e5, "collagen-damage"},
          {"electric_conductivity_S_per_m", 0.9, "gabriel"},
          {"electric_temperature_coefficient_per_K", 0.02, "duck"},
          {"electric_dry_conductivity_S_per_m", 1e-4, "chosen-dry"}}},
        {"liver",
         {{"density_kg_per_m3", 1079.0, "itis"},
          {"youngs_modulus_kPa", 5.4, "biliary-mechanics"},
          {"poisson_ratio", 0.45, "incompressible"},
          {"specific_heat_J_per_kgK", 3540.0, "itis"},
          {"thermal_conductivity_W_per_mK", 0.52, "itis"},
          {"water_mass_fraction", 0.70, "water"},
          {"dry_specific_heat_J_per_kgK", 2030.3, "derived"},
          {"removal_temperature_C", 300.0, "chosen"},
          {"solid_latent_heat_J_per_kg", 1e6, "chosen"},
          {"perfusion_ml_per_min_kg", 860.0, "itis"},
          {"vessel_transfer_W_per_m3K", 0.0, "no-vessel"},
          {"arrhenius_frequency_per_s", 7.39e39, "liver-damage"},
          {"arrhenius_energy_J_per_mol", 2.577e5, "liver-damage"},
          {"electric_conductivity_S_per_m", 0.15, "gabriel"},
          {"electric_temperature_coefficient_per_K", 0.02, "duck"},
          {"electric_dry_conductivity_S_per_m", 1e-4, "chosen-dry"}}},
    };
    return all;
}

const MaterialField* find_field(const std::string& key) {
    for (const MaterialField& field : material_fields())
        if (key == field.key) return &field;
    return nullptr;
}

}  // namespace

bool MaterialField::plausible(const Material& material) const {
    const double slack = 1e-9 * (high - low);  // of the change of units
    return value(material) >= low - slack && value(material) <= high + slack;
}

// Ranges are those of soft tissues from fat to vessel walls as the sources give them, rounded outward.
const std::vector<MaterialField>& material_fields() {
    static const std::vector<MaterialField> fields{
        {"density_kg_per_m3", "kg/m3", &M::density_kg_per_m3, 1.0, 0.0, 900.0, 1200.0, "mass per volume"},
        {"youngs_modulus_kPa", "kPa", &M::youngs_modulus_Pa, 1e3, 0.0, 0.5, 2000.0, "stiffness at small strain"},
        {"poisson_ratio", "", &M::poisson_ratio, 1.0, 0.0, 0.3, 0.495, "0.5 would be incompressible"},
        {"specific_heat_J_per_kgK", "J/(kg K)", &M::specific_heat_J_per_kgK, 1.0, 0.0, 2000.0, 4200.0,
         "alive, water included"},
        {"thermal_conductivity_W_per_mK", "W/(m K)", &M::thermal_conductivity_W_per_mK, 1.0, 0.0, 0.15, 0.65,
         "heat conduction"},
        {"water_mass_fraction", "", &M::water_mass_fraction, 1.0, 0.0, 0.05, 0.95, "kg water per kg tissue"},
        {"dry_specific_heat_J_per_kgK", "J/(kg K)", &M::dry_specific_heat_J_per_kgK, 1.0, 0.0, 1000.0, 3000.0,
         "of what is left without water"},
        {"removal_temperature_C", "C", &M::removal_temperature_K, 1.0, kKelvin, 150.0, 600.0,
         "dry solids turn to gas from here on"},
        {"solid_latent_heat_J_per_kg", "J/kg", &M::solid_latent_heat_J_per_kg, 1.0, 0.0, 1e5, 5e6,
         "to gasify the dry solids"},
        {"perfusion_ml_per_min_kg", "ml/(min kg)", &M::perfusion_m3_per_s_kg, kPerMinuteAndMl, 0.0, 0.0, 5000.0,
         "blood through capillaries; none where coagulated"},
        {"vessel_transfer_W_per_m3K", "W/(m3 K)", &M::vessel_transfer_W_per_m3K, 1.0, 0.0, 0.0, 3e7,
         "to blood that streams through the vessel"},
        {"arrhenius_frequency_per_s", "1/s", &M::arrhenius_frequency_per_s, 1.0, 0.0, 1e30, 1e110,
         "of thermal damage: A"},
        {"arrhenius_energy_J_per_mol", "J/mol", &M::arrhenius_energy_J_per_mol, 1.0, 0.0, 1.5e5, 8e5,
         "of thermal damage: Ea"},
        {"electric_conductivity_S_per_m", "S/m", &M::electric_conductivity_S_per_m, 1.0, 0.0, 0.01, 2.0,
         "at about 450 kHz and 37 C"},
        {"electric_temperature_coefficient_per_K", "1/K", &M::electric_temperature_coefficient_per_K, 1.0, 0.0, 0.005,
         0.04, "share by which it rises per kelvin, up to boiling"},
        {"electric_dry_conductivity_S_per_m", "S/m", &M::electric_dry_conductivity_S_per_m, 1.0, 0.0, 1e-6, 0.01,
         "without water"},
    };
    return fields;
}

const std::vector<Reference>& material_references() {
    static const std::vector<Reference> references{
        {"itis",
         "Hasgall et al., IT'IS database for thermal and electromagnetic parameters of biological tissues, 4.1, "
         "2022, doi 10.13099/VIP21000-04-1; bile duct after its gallbladder"},
        {"gabriel",
         "Gabriel, Gabriel, Corthout 1996, Phys. Med. Biol. 41:2231, doi 10.1088/0031-9155/41/11/001, at 450 "
         "kHz; liver, artery, gallbladder of the IT'IS database; bile duct between wall and artery"},
        {"duck",
         "Duck 1990, Physical Properties of Tissue: 1 to 3 % per kelvin below 100 C, as the body's electrolytes do"},
        {"chosen-dry", "chosen: two to four decades less, as impedance rises when tissue desiccates"},
        {"fat-electric",
         "0.0248 to 0.0251 S/m from 400 kHz to 1 MHz, doi 10.1186/s12938-018-0473-9; infiltrated 0.044"},
        {"biliary-mechanics", "PMC6925591, table 1, E = 3 G"},
        {"fat-mechanics", "middle of the published range for fat at small strain, 2 to 10 kPa"},
        {"incompressible", "nearly incompressible, as all wet tissue; 0.45 keeps the time step long"},
        {"water", "within what textbooks give: adipose tissue 0.1 to 0.2, other soft tissues 0.7 to 0.8"},
        {"derived", "from the living tissue's less its water's: (c - f 4187) / (1 - f)"},
        {"chosen", "chosen, not published; the reason stands in calot/tissue/material.cpp"},
        {"nusselt",
         "laminar flow, Nu = 3.66 (Incropera et al., Fundamentals of Heat and Mass Transfer, section 8.4): "
         "4 Nu k / D^2 with k = 0.52 W/(m K), D = 1.7 mm"},
        {"no-vessel", "no large vessel runs in it"},
        {"no-perfusion", "its own blood streams: see vessel_transfer_W_per_m3K"},
        {"liver-damage",
         "as models of radiofrequency ablation of liver use them, for example Chang and Nguyen 2004, doi "
         "10.1186/1475-925X-3-27: 61 s at 50 C, 0.23 s at 70 C; for fat for want of its own"},
        {"artery-damage", "artery: Agah et al. 1994, Lasers Surg. Med. 15:176"},
        {"collagen-damage", "collagen: Pearce et al. 1993, Proc. SPIE 1876:180"},
    };
    return references;
}

std::string material_source(const Material& material, const MaterialField& field) {
    for (const Tissue& tissue : tissues()) {
        if (material.name != tissue.name) continue;
        for (const Row& row : tissue.rows)
            if (row.key == std::string(field.key) && row.value * field.factor + field.offset == material.*field.member)
                return row.source;
    }
    return "";
}

std::vector<Material> default_materials() {
    std::vector<Material> materials(1);
    materials[0].name = "none";
    for (const Tissue& tissue : tissues()) {
        Material& material = materials.emplace_back();
        material.name = tissue.name;
        material.source = "`calot materials " + material.name + "` names the source of every value";
        for (const Row& row : tissue.rows) {
            const MaterialField& field = *find_field(row.key);
            material.*field.member = row.value * field.factor + field.offset;
        }
    }
    return materials;
}

MaterialIndex find_material(const std::vector<Material>& materials, const std::string& name) {
    for (std::size_t k = 1; k < materials.size(); ++k)
        if (materials[k].name == name) return static_cast<MaterialIndex>(k);
    return kNoMaterial;
}

}  // namespace calot::tissue
