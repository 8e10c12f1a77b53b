#include "surface_series.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace calot::app {

namespace {

constexpr double kBrowns_K = 423.15;  ///< dry tissue browns above about 150 C

}  // namespace

SurfaceSeries::SurfaceSeries(const std::string& directory, double every_s) : directory_(directory), every_s_(every_s) {
    if (every_s_ > 0.0) std::filesystem::create_directories(directory_ + "/surface");
}

void SurfaceSeries::write(const simulation::Simulation& run) {
    const surface::Mesh& mesh = run.surface().smooth_mesh();
    const std::vector<std::int64_t>& owner = run.surface().owner();
    run.world_surface(world_);
    const std::size_t points = mesh.position_m.size();
    std::vector<float> temperature(points), peak(points), damage(points), material(points), displacement(3 * points);
    std::vector<float> water(points), charred(points);
    for (std::size_t k = 0; k < points; ++k) {
        const auto hexel = static_cast<std::size_t>(owner[k]);
        temperature[k] = run.work().thermal.temperature_K[hexel];
        peak[k] = run.state().peak_temperature_K[hexel];
        damage[k] = run.state().damage[hexel];
        const tissue::Material& tissue = run.model().materials[run.model().hexel_material[hexel]];
        const double alive_kg_per_m3 = tissue.density_kg_per_m3 * tissue.water_mass_fraction;
        water[k] =
            alive_kg_per_m3 > 0.0 ? static_cast<float>(run.state().water_kg_per_m3[hexel] / alive_kg_per_m3) : 0.0f;
        // From where tissue browns to where it turns to gas.
        charred[k] = static_cast<float>(std::clamp(
            (static_cast<double>(peak[k]) - kBrowns_K) / std::max(1.0, tissue.removal_temperature_K - kBrowns_K), 0.0,
            1.0));
        material[k] = static_cast<float>(run.model().hexel_material[hexel]);
        for (int c = 0; c < 3; ++c) displacement[3 * k + c] = world_.position_m[k][c] - mesh.position_m[k][c];
    }
    const std::string file = fmt::format("surface/t{:08.3f}s.vtp", run.time_s());
    surface::write_vtp(directory_ + "/" + file, world_.position_m, mesh.index,
                       {{"temperature_K", 1, temperature},
                        {"peak_temperature_K", 1, peak},
                        {"damage", 1, damage},
                        {"water_share", 1, water},
                        {"char", 1, charred},
                        {"material", 1, material},
                        {"displacement_m", 3, displacement}});
    entries_.push_back({run.time_s(), file});
    surface::write_pvd(directory_ + "/surface.pvd", entries_);
    while (due(run.time_s())) next_s_ += every_s_;
}

}  // namespace calot::app
