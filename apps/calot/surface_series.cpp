#include "surface_series.h"

#include <filesystem>

#include <fmt/format.h>

namespace calot::app {

SurfaceSeries::SurfaceSeries(const std::string& directory, double every_s) : directory_(directory), every_s_(every_s) {
    if (every_s_ > 0.0) std::filesystem::create_directories(directory_ + "/surface");
}

void SurfaceSeries::write(const simulation::Simulation& run) {
    const surface::Mesh& mesh = run.surface().smooth_mesh();
    const std::vector<std::int64_t>& owner = run.surface().owner();
    run.world_surface(world_);
    const std::size_t points = mesh.position_m.size();
    std::vector<float> temperature(points), peak(points), damage(points), material(points), displacement(3 * points);
    for (std::size_t k = 0; k < points; ++k) {
        const auto hexel = static_cast<std::size_t>(owner[k]);
        temperature[k] = run.work().thermal.temperature_K[hexel];
        peak[k] = run.state().peak_temperature_K[hexel];
        damage[k] = run.state().damage[hexel];
        material[k] = static_cast<float>(run.model().hexel_material[hexel]);
        for (int c = 0; c < 3; ++c) displacement[3 * k + c] = world_.position_m[k][c] - mesh.position_m[k][c];
    }
    const std::string file = fmt::format("surface/t{:08.3f}s.vtp", run.time_s());
    surface::write_vtp(directory_ + "/" + file, world_.position_m, mesh.index,
                       {{"temperature_K", 1, temperature},
                        {"peak_temperature_K", 1, peak},
                        {"damage", 1, damage},
                        {"material", 1, material},
                        {"displacement_m", 3, displacement}});
    entries_.push_back({run.time_s(), file});
    surface::write_pvd(directory_ + "/surface.pvd", entries_);
    while (due(run.time_s())) next_s_ += every_s_;
}

}  // namespace calot::app
