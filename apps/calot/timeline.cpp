#include "timeline.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include "calot/thermal/heat.h"

namespace calot::app {

namespace {

constexpr std::size_t kMostKept = 4000;

constexpr const char* kHeader =
    "time_s,tip_x_m,tip_y_m,tip_z_m,force_x_N,force_y_N,force_z_N,force_N,pedal,power_setting_W,power_W,voltage_V,"
    "current_A,impedance_Ohm,max_temperature_K,hexels_burnt,hexels_fallen,links_severed,volume_removed_m3,"
    "steam_and_smoke_kg,delivered_J,stored_J,latent_J,gas_J,surface_J,perfusion_J,outflow_J,debris_J,tip_J,tip_K,tip_"
    "char_kg,peak_voltage_V,contacts,arcs";

std::string csv_line(const TimelineRow& r) {
    return fmt::format(
        "{:.3f},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:d},{:g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},"
        "{:.6g},{:.6g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.2f},{:.6g},{:.6g},{},{}",
        r.time_s, r.tip_m.x, r.tip_m.y, r.tip_m.z, r.force_N.x, r.force_N.y, r.force_N.z, glm::length(r.force_N),
        r.pedal, r.power_setting_W, r.generator.power_W, r.generator.voltage_V, r.generator.current_A,
        r.generator.impedance_Ohm, r.max_temperature_K, r.hexels_burnt, r.hexels_fallen, r.links_severed,
        r.volume_removed_m3, r.emitted_kg, r.energy_J.delivered, r.stored_J, r.energy_J.latent, r.energy_J.gas,
        r.energy_J.surface, r.energy_J.perfusion, r.energy_J.outflow, r.energy_J.debris,
        r.energy_J.tip + r.energy_J.transit, r.tip.temperature_K, r.tip.char_kg, r.generator.peak_voltage_V,
        r.generator.current_A > 0.0 ? r.field.contacts : 0, r.generator.current_A > 0.0 ? r.field.arcs : 0);
}

}  // namespace

double max_temperature_K(const simulation::Simulation& run) {
    const Array<float>& temperature = run.work().thermal.temperature_K;
    const Array<std::uint64_t>& words = run.state().hexel_present.words();
    float hottest = 0.0f;
    for (std::size_t w = 0; w < words.size(); ++w)
        for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1)
            hottest = std::max(hottest, temperature[64 * w + static_cast<std::size_t>(__builtin_ctzll(bits))]);
    return hottest;
}

TimelineRow make_row(const simulation::Simulation& run, const tissue::Input& input) {
    const tissue::State& state = run.state();
    TimelineRow row;
    row.time_s = run.time_s();
    row.tip_m = input.hook.position_m;
    row.force_N = state.hook_force_N;
    row.pedal = input.pedal;
    row.power_setting_W = input.pedal ? input.power_setting_W : 0.0;
    row.generator = state.generator;
    row.max_temperature_K = max_temperature_K(run);
    row.hexels_burnt = state.hexels_burnt;
    row.hexels_fallen = state.hexels_fallen;
    row.links_severed = state.links_severed;
    row.volume_removed_m3 =
        static_cast<double>(state.hexels_burnt + state.hexels_fallen) * run.model().hexel_volume_m3();
    row.emitted_kg = run.smoke().emitted_kg();
    row.energy_J = state.energy_J;
    row.tip = state.tip;
    row.field = state.field;
    row.stray = state.stray;
    row.stored_J = thermal::stored_J(run.model(), state);
    return row;
}

std::vector<Conductor> conductors(const tissue::Model& model) {
    std::array<bool, tissue::kStrayMaterials> held{};
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h) {
        const std::size_t material = model.hexel_material[static_cast<std::size_t>(h)];
        if (material < held.size() && model.hexel_initial.test(h)) held[material] = true;
    }
    std::vector<Conductor> all;
    for (std::size_t m = 1; m < held.size(); ++m)
        if (held[m]) all.push_back({m, model.materials[m].name});
    return all;
}

Timeline::Timeline(const std::string& path, std::vector<Conductor> conductors)
    : path_(path), conductors_(std::move(conductors)), file_(nullptr, std::fclose) {
    if (path_.empty()) return;
    file_.reset(std::fopen(path_.c_str(), "wb"));
    std::string header = kHeader;
    for (const Conductor& conductor : conductors_) header += fmt::format(",{}_W", conductor.name);
    if (!file_ || std::fputs((header + "\n").c_str(), file_.get()) < 0) fail();
}

void Timeline::add(const TimelineRow& row) {
    if (file_) {
        std::string line = csv_line(row);
        for (const Conductor& conductor : conductors_)
            line += fmt::format(",{:.6g}", row.stray.power_W[conductor.material]);
        line += '\n';
        if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size()) fail();
    }
    if (seen_++ % stride_ == 0) kept_.push_back(row);
    if (kept_.size() < kMostKept) return;
    std::size_t half = 0;  // long runs: every other row makes room
    for (std::size_t k = 0; k < kept_.size(); k += 2) kept_[half++] = kept_[k];
    kept_.resize(half);
    stride_ *= 2;
}

void Timeline::flush() {
    if (file_ && std::fflush(file_.get()) != 0) fail();
}

void Timeline::fail() const {
    throw std::system_error(errno, std::generic_category(), "cannot write " + path_);
}

}  // namespace calot::app
