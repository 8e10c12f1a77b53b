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
        "window_cells", named("hexels"), 8, 256, [](Scene & s) -> auto& { return s.electric.window_cells; },
        "Edge of the cube about the tip in which it is solved.");
    t.number(
        "relative_residual", kNoUnit, 1e-9, 0.5, [](Scene & s) -> auto& { return s.electric.relative_residual; },
        "Accuracy of the solution.");
    t.number(
        "voltage_limit_V", named("V"), 1, 10000, [](Scene & s) -> auto& { return s.electric.voltage_limit_V; },
        "RMS, in every mode. The generator gives its power up to this voltage.");
    t.number(
        "current_limit_A", named("A"), 0.01, 100, [](Scene & s) -> auto& { return s.electric.current_limit_A; },
        "RMS. It gives its power up to this current.");
    static constexpr const char* kModes[3] = {"cut", "blend", "coag"};
    for (std::size_t mode = 0; mode < 3; ++mode) {
        const std::string name = kModes[mode];
        t.number((name + "_peak_V").c_str(), named("V"), 1, 20000,
                 [mode](Scene & s) -> auto& { return s.electric.peak_voltage_V[mode]; }, "Peak voltage of the mode.");
        t.number((name + "_crest_factor").c_str(), kNoUnit, 1, 20,
                 [mode](Scene & s) -> auto& { return s.electric.crest_factor[mode]; }, "Peak over RMS.");
    }
    t.number(
        "arc_threshold_V", named("V"), 0, 1e5, [](Scene & s) -> auto& { return s.electric.arc_threshold_V; },
        "Peak. Below, no arc strikes between metal and tissue.");
    t.number(
        "arc_field_kV_per_mm", Unit{"kV/mm", 1e6, 0.0}, 0.01, 1000,
        [](Scene & s) -> auto& { return s.electric.arc_field_V_per_m; }, "More for every millimetre of gas.");
    t.number(
        "arc_resistance_Ohm", named("Ohm"), 0, 1e7, [](Scene & s) -> auto& { return s.electric.arc_resistance_Ohm; },
        "Of one arc to one hexel,");
    t.number(
        "arc_resistance_Ohm_per_mm", Unit{"Ohm/mm", 1e3, 0.0}, 0, 1e7,
        [](Scene & s) -> auto& { return s.electric.arc_resistance_Ohm_per_m; }, "and more with its length.");
    t.number(
        "arc_wire_share", kNoUnit, 0, 1, [](Scene & s) -> auto& { return s.electric.arc_wire_share; },
        "Share of an arc's heat that the wire takes.");
    t.number(
        "arc_conductivity_S_per_m", named("S/m"), 0, 100,
        [](Scene & s) -> auto& { return s.electric.arc_conductivity_S_per_m; },
        "At least this, where arcs burn through tissue that has dried at the metal.");
    t.number(
        "char_conductivity_S_per_m", named("S/m"), 1e-6, 1e4,
        [](Scene & s) -> auto& { return s.electric.char_conductivity_S_per_m; }, "Of what sticks to the wire.");
    t.boolean(
        "return_placed", [](Scene & s) -> auto& { return s.electric.return_placed; },
        "The return electrode is at return_at; else far away.");
    t.text(
        "return_at", [](Scene & s) -> auto& { return s.return_electrode.landmark; },
        "Landmark near it; empty: the origin.");
    t.vector(
        "return_offset_mm", kMm, -2000, 2000, [](Scene & s) -> auto& { return s.return_electrode.offset_m; },
        "From that landmark to the return electrode.");
    t.number(
        "return_radius_mm", kMm, 5, 500, [](Scene & s) -> auto& { return s.electric.return_radius_m; },
        "Of a disc with the pad's area.");
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
    number("electric_temperature_coefficient_per_K", named("1/K"), 0, 0.2, &M::electric_temperature_coefficient_per_K,
           "Share by which it rises per kelvin, up to boiling.");
    number("electric_dry_conductivity_S_per_m", named("S/m"), 0, 1e3, &M::electric_dry_conductivity_S_per_m,
           "Without water.");
    t.text(
        "source", [=](Scene & s) -> auto& { return s.materials[index].source; }, "Where the values come from.");
    return group;
}

}  // namespace calot::scene
