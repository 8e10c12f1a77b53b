// Boiling, gasification, Stefan fronts and thermal damage against closed forms.

#include <fmt/format.h>

#include "calot/validation/closed_forms.h"
#include "calot/validation/heat_rig.h"
#include "calot/validation/spoil.h"

namespace calot::validation {

namespace {

using thermal::bar_cell;
using thermal::HeatRun;

const char* const kSuite = "phase";
constexpr double kBody_K = 310.15, kBoiling_K = 373.15;

tissue::Material tissue_named(const char* name) {
    const auto materials = tissue::default_materials();
    tissue::Material m = materials[tissue::find_material(materials, name)];
    m.perfusion_m3_per_s_kg = 0.0;
    m.vessel_transfer_W_per_m3K = 0.0;
    return m;
}

/// Depth [m] to which water at 100 C has boiled off when one end is held at 400 C, over Neumann's.
struct Front {
    Points seen, exact;  ///< mm against s
    double ratio = 0.0;
};
Front boil_off_front(const Options& options, int n) {
    tissue::Material m = tissue_named("liver");
    m.removal_temperature_K = 2000.0;
    const double length = 4e-3, s = length / n, hot_K = 673.15;
    const double water = m.density_kg_per_m3 * m.water_mass_fraction;
    const double dry = m.density_kg_per_m3 * (1.0 - m.water_mass_fraction) * m.dry_specific_heat_J_per_kgK;
    const double a = m.thermal_conductivity_W_per_mK / dry;
    tissue::Model model = thermal::bar_model(n, s, 0.08 * s * s / a, {m});
    model.hexel_held.set(model.hexels.index(n + 1, 1, 1));  // only the hot end faces gas
    model.thermal.held_transfer_W_per_m2K = 0.0;
    model.thermal.gas_transfer_W_per_m2K = 1e9;
    model.thermal.gas_temperature_K = hot_K;
    HeatRun run(spoiled(options, std::move(model)));
    for (int k = 0; k < n; ++k) run.heat(bar_cell(run.model, k), kBoiling_K);
    run.start();
    const double lambda = stefan_lambda(dry * (hot_K - kBoiling_K) / (water * kLatentHeatOfWater_J_per_kg));
    const double until = std::pow(0.5 * length / (2.0 * lambda), 2.0) / a;  // the front is half way then
    const auto steps = static_cast<int>(std::lround(until / run.model.tick_s));
    Front front;
    for (int part = 1; part <= 20; ++part) {
        run.run(steps * part / 20 - static_cast<int>(run.state.tick));
        const double t = static_cast<double>(run.state.tick) * run.model.tick_s;
        double depth = 0.0;
        for (int k = 0; k < n; ++k)
            depth += s * (1.0 - static_cast<double>(
                                    run.state.water_kg_per_m3[static_cast<std::size_t>(bar_cell(run.model, k))]) /
                                    water);
        const double exact = 2.0 * lambda * std::sqrt(a * t);
        front.seen.emplace_back(t, depth * 1e3);
        front.exact.emplace_back(t, exact * 1e3);
        front.ratio = depth / exact;
    }
    return front;
}

std::vector<Case> stefan(const Options& options) {
    Points errors;
    const Front coarse = boil_off_front(options, 8);
    Case result = compare(kSuite, "Stefan front", coarse.seen.back().second, coarse.exact.back().second, "mm", 0.01,
                          "Neumann's similarity solution: Carslaw & Jaeger 1959, 11.2");
    result.note = "depth to which liver at 100 C is dry, one end at 400 C, at 8 cells across";
    result.figures.push_back({"Stefan front at 8 cells across",
                              "time, s",
                              "depth of the dry layer, mm",
                              {{"closed form", coarse.exact, false}, {"Calot", coarse.seen, true}}});
    for (const int n : options.quick ? std::vector<int>{20, 40, 80} : std::vector<int>{20, 40, 80, 160})
        errors.emplace_back(n, std::abs(boil_off_front(options, n).ratio - 1.0));
    // The front moves cell by cell, and how far it is within a cell is known only while that cell boils: first order.
    converge(result, errors, 0.9, "cells across");
    return {result};
}

/// One insulated hexel under constant heat: energies per volume when it boils, is dry, is gone.
struct BoilOff {
    double boils = 0.0, dry = 0.0, gone = 0.0, step = 0.0;
    Points temperature;  ///< C against J/mm^3
};
BoilOff boil_off(const Options& options, tissue::PhaseModel phase) {
    const double density = 5e8, dt = 1e-4;
    tissue::Model model = thermal::box_model({1, 1, 1}, 0.6e-3, dt, {tissue_named("liver")});
    thermal::insulate(model);
    model.thermal.phase_model = phase;
    HeatRun run(spoiled(options, std::move(model)));
    run.set_joule({0, 0, 0}, {1, 1, 1}, [=](const Int3&) { return density; });
    const std::int64_t cell = run.model.hexels.index(0, 0, 0);
    const auto h = static_cast<std::size_t>(cell);
    BoilOff out;
    out.step = density * dt;
    while (run.state.hexel_present.test(cell) && run.state.tick < 200000) {
        const float before = run.state.water_kg_per_m3[h];
        run.tick();
        const double delivered = run.state.energy_J.delivered / run.model.hexel_volume_m3();
        if (out.boils == 0.0 && run.state.water_kg_per_m3[h] < before) out.boils = delivered;
        if (out.dry == 0.0 && run.state.water_kg_per_m3[h] == 0.0f) out.dry = delivered;
        if (run.state.tick % 400 == 1)
            out.temperature.emplace_back(delivered * 1e-9, kBody_K + run.rise_K(cell) - 273.15);
        out.gone = delivered;
    }
    return out;
}

std::vector<Case> lumped(const Options& options) {
    const tissue::Material m = tissue_named("liver");
    const double rho = m.density_kg_per_m3, f = m.water_mass_fraction, solids = rho * (1.0 - f);
    const double to_boil = rho * m.specific_heat_J_per_kgK * (kBoiling_K - kBody_K);
    const double to_dry = to_boil + rho * f * kLatentHeatOfWater_J_per_kg;
    const double to_heat = to_dry + solids * m.dry_specific_heat_J_per_kgK * (m.removal_temperature_K - kBoiling_K);
    const double to_remove = to_heat + solids * m.solid_latent_heat_J_per_kg;
    const BoilOff seen = boil_off(options, tissue::PhaseModel::water_then_solids);
    const char* source = "energy: rho c dT + rho f L, then the solids' own";
    Case boils =
        compare(kSuite, "lumped boil-off: boiling begins", seen.boils * 1e-9, to_boil * 1e-9, "J/mm3", 1e-3, source);
    Case dry = compare(kSuite, "lumped boil-off: dry", seen.dry * 1e-9, to_dry * 1e-9, "J/mm3", 1e-3, source);
    Case gone = compare(kSuite, "lumped boil-off: gone", seen.gone * 1e-9, to_remove * 1e-9, "J/mm3", 1e-3, source);
    gone.figures.push_back({"A hexel of liver under constant heat",
                            "energy, J/mm3",
                            "temperature, C",
                            {{"closed form",
                              {{0.0, kBody_K - 273.15},
                               {to_boil * 1e-9, 100.0},
                               {to_dry * 1e-9, 100.0},
                               {to_heat * 1e-9, m.removal_temperature_K - 273.15},
                               {to_remove * 1e-9, m.removal_temperature_K - 273.15}},
                              false},
                             {"Calot", seen.temperature, true}}});
    const BoilOff once = boil_off(options, tissue::PhaseModel::threshold);
    Case threshold = compare(kSuite, "threshold model: gone", once.gone * 1e-9, to_dry * 1e-9, "J/mm3", 1e-3,
                             "Pan et al. 2019: one latent heat at one temperature, rho c dT + rho f L");
    return {boils, dry, gone, threshold};
}

double time_to_damage_s(const Options& options, const char* name, double celsius, double step_s) {
    tissue::Material m = tissue_named(name);
    m.thermal_conductivity_W_per_mK = 0.0;
    tissue::Model model = thermal::box_model({1, 1, 1}, 0.6e-3, step_s, {m});
    thermal::insulate(model);
    HeatRun run(spoiled(options, std::move(model)));
    const std::int64_t cell = run.model.hexels.index(0, 0, 0);
    run.heat(cell, kelvin_from_celsius(celsius));
    run.start();
    const float& damage = run.state.damage[static_cast<std::size_t>(cell)];
    while (damage < 1.0f && run.state.tick < 100'000) run.tick();
    return static_cast<double>(run.state.tick) * step_s / static_cast<double>(damage);
}

std::vector<Case> arrhenius(const Options& options) {
    struct Row {
        const char* tissue;
        double celsius, seconds;
    };
    std::vector<Case> cases;
    Figure figure{"Time until damage is done", "temperature, C", "log10 of seconds to Omega = 1", {}, false};
    for (const char* name : {"liver", "cystic_artery", "cystic_duct"}) {
        const tissue::Material m = tissue_named(name);
        Curve curve{std::string(name) + ", exp(Ea/RT)/A", {}, false};
        for (double c = 48.0; c <= 92.0; c += 1.0)
            curve.points.emplace_back(
                c, std::log10(arrhenius_time_s(m.arrhenius_frequency_per_s, m.arrhenius_energy_J_per_mol,
                                               kelvin_from_celsius(c))));
        figure.curves.push_back(curve);
    }
    Curve seen{"Calot", {}, true};
    for (const Row& row : {Row{"liver", 50, 61},
                           {"liver", 60, 3.45},
                           {"liver", 70, 0.229},
                           {"cystic_artery", 60, 4.7e3},
                           {"cystic_artery", 70, 51},
                           {"cystic_artery", 80, 0.72}}) {
        const double seconds = time_to_damage_s(options, row.tissue, row.celsius, row.seconds / 400.0);
        seen.points.emplace_back(row.celsius, std::log10(seconds));
        cases.push_back(compare(kSuite, fmt::format("damage of {} at {:g} C", row.tissue, row.celsius), seconds,
                                row.seconds, "s", 0.015,
                                "Arrhenius, times to two or three digits: docs/physics.md, section 6"));
    }
    const tissue::Material duct = tissue_named("cystic_duct");
    const double exact =
        arrhenius_time_s(duct.arrhenius_frequency_per_s, duct.arrhenius_energy_J_per_mol, kelvin_from_celsius(70.0));
    const double seconds = time_to_damage_s(options, "cystic_duct", 70.0, exact / 400.0);
    seen.points.emplace_back(70.0, std::log10(seconds));
    cases.push_back(compare(kSuite, "damage of cystic_duct at 70 C", seconds, exact, "s", 1e-3,
                            "exp(Ea / RT) / A with the tissue's own A and Ea"));
    figure.curves.push_back(seen);
    cases.front().figures.push_back(figure);
    return cases;
}

}  // namespace

std::vector<Check> phase_checks() {
    return {{kSuite, "lumped boil-off", true, lumped},
            {kSuite, "Stefan front", true, stefan},
            {kSuite, "Arrhenius damage", true, arrhenius}};
}

}  // namespace calot::validation
