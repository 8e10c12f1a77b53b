// The table's physics: parameters of the rooms, materials.

#include "calot/scene/keys_build.h"

// clang-format off: a table, one key after the other
namespace calot::scene {

namespace {

Group deformation_group() {
    Group group{"deformation", "Elasticity (docs/physics.md section 2).", {}, {}};
    KeyTable<Scene> t(group);
    t.choice(
        "law", {"stable_neo_hookean", "saint_venant_kirchhoff"}, [](Scene & s) -> auto& { return s.deformation.law; },
        "Elastic law. The second is that of Pan et al. 2019; it inverts when pressed hard.");
    t.number(
        "volume_stiffness_kPa", kKilopascal, 0, 1e4,
        [](Scene & s) -> auto& { return s.deformation.volume_stiffness_Pa; }, "k_v, only with saint_venant_kirchhoff.");
    t.number(
        "hourglass_alpha", kNoUnit, 0, 2, [](Scene & s) -> auto& { return s.deformation.hourglass_alpha; },
        "Share of Young's modulus that resists zero-energy modes; 0.3 to 0.6 is usual.");
    t.number(
        "damping_per_s", named("1/s"), 0, 1000, [](Scene & s) -> auto& { return s.deformation.damping_per_s; },
        "Velocities decay at this rate.");
    t.number(
        "time_step_safety", kNoUnit, 0.05, 1, [](Scene & s) -> auto& { return s.deformation.time_step_safety; },
        "Time step over phyxel spacing by wave speed.");
    t.number(
        "mass_fraction_floor", kNoUnit, 0.01, 1, [](Scene & s) -> auto& { return s.deformation.mass_fraction_floor; },
        "Phyxels are never lighter than this share of a full one.");
    t.number(
        "tear_stretch", kNoUnit, 1.2, 100, [](Scene & s) -> auto& { return s.deformation.tear_stretch; },
        "Tissue stretched to more than this many times its length tears.");
    t.number(
        "singular_ratio", kNoUnit, 0, 0.5, [](Scene & s) -> auto& { return s.deformation.singular_ratio; },
        "Phyxels whose links span space worse than this have no stress of their own.");
    t.vector(
        "gravity_m_per_s2", named("m/s2"), -100, 100, [](Scene & s) -> auto& { return s.deformation.gravity_m_per_s2; },
        "None by default: the anatomy is given as it hangs.");
    t.integer(
        "substeps", kNoUnit, 0, 1000, [](Scene & s) -> auto& { return s.deformation.substeps; },
        "Of one tick (1 ms); 0: as many as the softest tissue needs.");
    return group;
}

Group electric_group() {
    Group group{"electric", "The electric field about the tip (section 5).", {}, {}};
    KeyTable<Scene> t(group);
    t.integer(
        "refresh_ticks", named("ticks"), 1, 1000, [](Scene & s) -> auto& { return s.electric.refresh_ticks; },
        "The field is solved anew so often.");
    t.integer(
        "window_cells", named("hexels"), 8, 256, [](Scene & s) -> auto& { return s.electric.window_cells; },
        "Edge of the cube about the tip in which it is solved.");
    t.number(
        "relative_residual", kNoUnit, 1e-9, 0.5, [](Scene & s) -> auto& { return s.electric.relative_residual; },
        "Accuracy of the solution.");
    t.integer(
        "max_iterations", kNoUnit, 1, 10000, [](Scene & s) -> auto& { return s.electric.max_iterations; }, "");
    t.number(
        "voltage_limit_V", named("V"), 1, 10000, [](Scene & s) -> auto& { return s.electric.voltage_limit_V; },
        "RMS. The generator gives its power up to this voltage.");
    return group;
}

Group thermal_group() {
    Group group{"thermal", "Heat, boiling, removal (section 6).", {}, {}};
    KeyTable<Scene> t(group);
    t.choice(
        "phase_model", {"water_then_solids", "threshold"}, [](Scene & s) -> auto& { return s.thermal.phase_model; },
        "Water boils, then dry tissue chars and goes; or one threshold for all (Pan et al. 2019).");
    t.integer(
        "refresh_ticks", named("ticks"), 1, 8, [](Scene & s) -> auto& { return s.thermal.refresh_ticks; },
        "A heat step takes so many: 1, 2, 4 or 8.");
    t.number(
        "body_temperature_C", kCelsius, 0, 60, [](Scene & s) -> auto& { return s.thermal.body_temperature_K; },
        "Of tissue at the start, and of blood.");
    t.number(
        "gas_temperature_C", kCelsius, -20, 80, [](Scene & s) -> auto& { return s.thermal.gas_temperature_K; },
        "Of the insufflated gas.");
    t.number(
        "gas_transfer_W_per_m2K", named("W/(m2 K)"), 0, 1e5,
        [](Scene & s) -> auto& { return s.thermal.gas_transfer_W_per_m2K; }, "Heat transfer to gas.");
    t.number(
        "held_transfer_W_per_m2K", named("W/(m2 K)"), 0, 1e5,
        [](Scene & s) -> auto& { return s.thermal.held_transfer_W_per_m2K; },
        "Heat transfer to the organs that hold the tissue.");
    t.number(
        "blood_density_kg_per_m3", named("kg/m3"), 500, 2000,
        [](Scene & s) -> auto& { return s.thermal.blood_density_kg_per_m3; }, "");
    t.number(
        "blood_specific_heat_J_per_kgK", named("J/(kg K)"), 500, 10000,
        [](Scene & s) -> auto& { return s.thermal.blood_specific_heat_J_per_kgK; }, "");
    t.number(
        "boiling_temperature_C", kCelsius, 60, 200, [](Scene & s) -> auto& { return s.thermal.boiling_temperature_K; },
        "");
    t.number(
        "threshold_temperature_C", kCelsius, 40, 1000,
        [](Scene & s) -> auto& { return s.thermal.threshold_temperature_K; }, "Only with phase_model = \"threshold\".");
    t.number(
        "tip_transfer_W_per_m2K", named("W/(m2 K)"), 0, 1e6,
        [](Scene & s) -> auto& { return s.thermal.tip_transfer_W_per_m2K; },
        "Heat transfer between the hook's bare wire and tissue.");
    t.number(
        "tip_char_share", kNoUnit, 0, 1, [](Scene & s) -> auto& { return s.thermal.tip_char_share; },
        "Of the solids that burn beside the wire, this share stays on it.");
    return group;
}

Group contact_group() {
    Group group{"contact", "Between instrument and tissue (section 8).", {}, {}};
    KeyTable<Scene> t(group);
    t.number(
        "stiffness_N_per_m", named("N/m"), 0.1, 1e5, [](Scene & s) -> auto& { return s.contact.stiffness_N_per_m; },
        "Of each touched hexel.");
    t.number(
        "friction", kNoUnit, 0, 2, [](Scene & s) -> auto& { return s.contact.friction; },
        "Coulomb coefficient of wet tissue on steel.");
    return group;
}

Group smoke_group() {
    Group group{"smoke", "Steam and smoke (section 9).", {}, {}};
    KeyTable<Scene> t(group);
    t.number(
        "suction_per_s", named("1/s"), 0, 100, [](Scene & s) -> auto& { return s.smoke.suction_per_s; },
        "Share of all smoke that is drawn off in a second.");
    t.number(
        "buoyancy_m_per_s2", named("m/s2"), -10, 10, [](Scene & s) -> auto& { return s.smoke.buoyancy_m_per_s2; }, "");
    t.integer(
        "max_particles", kNoUnit, 0, 100000, [](Scene & s) -> auto& { return s.smoke.max_particles; }, "");
    return group;
}

}  // namespace

std::vector<Group> physics_groups() {
    return {deformation_group(), electric_group(), thermal_group(), contact_group(), smoke_group()};
}

Group material_group(const std::string& name, std::size_t index) {
    Group group{"materials." + name, "", {}, {}};
    using M = tissue::Material;
    KeyTable<Scene> t(group);
    auto number = [&](const char* key, const Unit& unit, double low, double high, double M::*member, const char* doc) {
        t.number(
            key, unit, low, high, [=](Scene & s) -> auto& { return s.materials[index].*member; }, doc);
    };
    number("density_kg_per_m3", named("kg/m3"), 50, 20000, &M::density_kg_per_m3, "");
    number("youngs_modulus_kPa", kKilopascal, 0.05, 1e5, &M::youngs_modulus_Pa, "At small strain.");
    number("poisson_ratio", kNoUnit, 0, 0.495, &M::poisson_ratio, "");
    number("specific_heat_J_per_kgK", named("J/(kg K)"), 100, 20000, &M::specific_heat_J_per_kgK,
           "Alive, water included.");
    number("thermal_conductivity_W_per_mK", named("W/(m K)"), 1e-3, 500, &M::thermal_conductivity_W_per_mK, "");
    number("water_mass_fraction", kNoUnit, 0, 0.99, &M::water_mass_fraction, "");
    number("dry_specific_heat_J_per_kgK", named("J/(kg K)"), 100, 20000, &M::dry_specific_heat_J_per_kgK,
           "Of what is left without water.");
    number("removal_temperature_C", kCelsius, 100, 3000, &M::removal_temperature_K,
           "Dry tissue turns to gas from here on.");
    number("solid_latent_heat_J_per_kg", named("J/kg"), 1e3, 1e8, &M::solid_latent_heat_J_per_kg,
           "Taken up meanwhile.");
    number("perfusion_ml_per_min_kg", kFlow, 0, 1e5, &M::perfusion_m3_per_s_kg, "Blood flow.");
    number("vessel_transfer_W_per_m3K", named("W/(m3 K)"), 0, 1e9, &M::vessel_transfer_W_per_m3K,
           "To blood that streams through a vessel of this tissue.");
    number("arrhenius_frequency_per_s", named("1/s"), 0, 1e120, &M::arrhenius_frequency_per_s, "Of thermal damage.");
    number("arrhenius_energy_J_per_mol", named("J/mol"), 1e3, 1e7, &M::arrhenius_energy_J_per_mol,
           "Of thermal damage.");
    number("electric_conductivity_S_per_m", named("S/m"), 0, 1e3, &M::electric_conductivity_S_per_m,
           "At about 450 kHz.");
    t.text(
        "source", [=](Scene & s) -> auto& { return s.materials[index].source; }, "Where the values come from.");
    return group;
}

}  // namespace calot::scene
