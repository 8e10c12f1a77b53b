#pragma once
// Bodies of hexels made by hand, for checks of heat.

#include <cmath>
#include <functional>
#include <numbers>

#include "calot/base/random.h"
#include "calot/base/units.h"
#include "calot/thermal/heat.h"

namespace calot::thermal {

/// Numbers that make closed forms easy: rho c = 4e6 J/(m^3 K), a = 1.25e-7 m^2/s; no water, no blood, no damage.
inline tissue::Material plain_material(const char* name = "plain") {
    tissue::Material m;
    m.name = name;
    m.density_kg_per_m3 = 1000.0;
    m.specific_heat_J_per_kgK = 4000.0;
    m.thermal_conductivity_W_per_mK = 0.5;
    m.water_mass_fraction = 0.0;
    m.removal_temperature_K = 900.0;
    m.perfusion_m3_per_s_kg = 0.0;
    m.arrhenius_frequency_per_s = 0.0;
    return m;
}

/// No blood cools it.
inline void bloodless(tissue::Material& material) {
    material.perfusion_m3_per_s_kg = 0.0;
    material.vessel_transfer_W_per_m3K = 0.0;
}

/// Nothing leaves through faces.
inline void insulate(tissue::Model& model) {
    model.thermal.gas_transfer_W_per_m2K = 0.0;
    model.thermal.held_transfer_W_per_m2K = 0.0;
}

/// A box of hexels; `material_at` says what each is (kNoMaterial = gas). Every heat step is one tick of `dt_s`.
inline tissue::Model box_model(
    const Int3& size, double spacing_m, double dt_s, std::vector<tissue::Material> real,
    const std::function<tissue::MaterialIndex(const Int3&)>& material_at = [](const Int3&) {
        return tissue::MaterialIndex{1};
    }) {
    tissue::Model model;
    model.materials.resize(1);
    model.materials[0].name = "none";
    for (auto& m : real) model.materials.push_back(std::move(m));
    model.hexels = model.phyxels = Lattice::make(Vec3(0.5 * spacing_m), spacing_m, size);
    model.hexels_per_edge = 1;
    model.hexel_material.assign(static_cast<std::size_t>(model.hexels.cells), tissue::kNoMaterial);
    model.hexel_initial = model.hexel_held = BitArray(model.hexels.cells);
    model.phyxel_initial = model.phyxel_ghost = BitArray(model.phyxels.cells);
    model.electric.window_cells = 1;
    model.tick_s = dt_s;
    model.thermal.refresh_ticks = 1;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const std::int64_t cell = model.hexels.index(x, y, z);
                const tissue::MaterialIndex material = material_at({x, y, z});
                model.hexel_material[static_cast<std::size_t>(cell)] = material;
                if (material != tissue::kNoMaterial) model.hexel_initial.set(cell);
            }
    return model;
}

/// A bar of N hexels along x, one hexel thick. Its sides are held, its ends face gas; the ends may be made held as
/// well.
inline tissue::Model bar_model(
    int n, double spacing_m, double dt_s, std::vector<tissue::Material> real,
    const std::function<tissue::MaterialIndex(int)>& material_at = [](int) { return tissue::MaterialIndex{1}; }) {
    tissue::Model model = box_model({n + 2, 3, 3}, spacing_m, dt_s, std::move(real), [&](const Int3& c) {
        const bool inside = c.x >= 1 && c.x <= n && c.y == 1 && c.z == 1;
        return inside ? material_at(c.x - 1) : tissue::kNoMaterial;
    });
    for (int x = 1; x <= n; ++x)
        for (const Int3 side : {Int3(x, 0, 1), Int3(x, 2, 1), Int3(x, 1, 0), Int3(x, 1, 2)})
            model.hexel_held.set(model.hexels.index(side));
    return model;
}
inline std::int64_t bar_cell(const tissue::Model& model, int k) {
    return model.hexels.index(k + 1, 1, 1);
}

/// A run of heat alone.
struct HeatRun {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    Array<float> joule_W_per_m3;  ///< what Exchange::joule looks at
    Work work;

    explicit HeatRun(tissue::Model m) : model(std::move(m)), state(tissue::State::make(model)) {
        tissue::reserve_exchange(model, exchange);
        work = make_work(model, state);
    }
    /// Sets a hexel's temperature below boiling. Call start() when done.
    void heat(std::int64_t cell, double temperature_K) {
        const tissue::Material& m = model.materials[model.hexel_material[static_cast<std::size_t>(cell)]];
        state.enthalpy_J_per_m3[static_cast<std::size_t>(cell)] = static_cast<float>(
            (temperature_K - model.thermal.body_temperature_K) * m.density_kg_per_m3 * m.specific_heat_J_per_kgK);
    }
    void start() { work = make_work(model, state); }
    void tick() {
        exchange.gas.clear();
        exchange.removed_hexels.clear();
        conduct(model, state, exchange, work);
        remove_vaporised(model, state, exchange, work);
        ++state.tick;
    }
    void run(int ticks) {
        for (int k = 0; k < ticks; ++k) tick();
    }
    double rise_K(std::int64_t cell) const {
        return static_cast<double>(temperature_K(model, state, cell)) - model.thermal.body_temperature_K;
    }
    /// Joule heat in a box of hexels.
    void set_joule(const Int3& low, const Int3& size, const std::function<double(const Int3&)>& density_W_per_m3) {
        tissue::JouleHeat& joule = exchange.joule;
        joule.place(model.hexels, low, size);
        joule_W_per_m3.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y * size.z));
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const Int3 cell = low + Int3(x, y, z);
                    joule_W_per_m3[static_cast<std::size_t>(joule.index(cell))] =
                        model.hexels.contains(cell) ? static_cast<float>(density_W_per_m3(cell)) : 0.0f;
                }
        joule.density = {joule_W_per_m3.data(), joule_W_per_m3.size()};
    }
    /// Share of the delivered energy that the budget loses.
    double imbalance() const {
        const tissue::EnergyBudget& e = state.energy_J;
        return (e.delivered - e.accounted() - stored_J(model, state)) / e.delivered;
    }
};

}  // namespace calot::thermal
