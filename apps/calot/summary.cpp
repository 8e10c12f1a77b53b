#include "summary.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calot::app {

namespace {

using Json = nlohmann::ordered_json;

/// What each press of the pedal did. Spread: farthest tissue that reached a level, from the cut's edge, or from where
/// metal touched when nothing was removed.
Json activations_json(const std::vector<simulation::Activation>& activations) {
    static constexpr std::array<const char*, 3> kModes{"cut", "blend", "coag"};
    Json list = Json::array();
    for (const simulation::Activation& a : activations) {
        Json spread;
        for (std::size_t k = 0; k < simulation::kSpreadLevels; ++k)
            spread[simulation::kSpreadNames[k]] = a.spread_m[k] * 1e3;
        list.push_back({{"start_s", a.start_s},
                        {"stop_s", a.stop_s},
                        {"mode", kModes[static_cast<std::size_t>(a.mode)]},
                        {"power_setting_W", a.power_setting_W},
                        {"energy_J", a.energy_J},
                        {"hexels_removed", a.hexels_removed},
                        {"spread_from", a.from_cut ? "cut" : "contact"},
                        {"spread_mm", spread},
                        {"tip_temperature_K", a.tip_temperature_K}});
    }
    return list;
}

}  // namespace

std::string summary_json(const RunRecord& r) {
    Json j;
    j["scene"] = r.scene;
    j["version"] = CALOT_VERSION;
    j["seed"] = r.seed;
    j["duration_s"] = r.duration_s;
    j["ticks"] = r.ticks;
    j["threads"] = r.threads;
    j["backend"] = r.backend;
    j["interrupted"] = r.interrupted;
    j["status"] =
        r.status.ok ? Json("ok") : Json{{"field", r.status.field}, {"cell", r.status.cell}, {"tick", r.status.tick}};
    j["phyxels_initial"] = r.phyxels_initial;
    j["phyxels_removed"] = r.phyxels_removed;
    j["hexels_initial"] = r.hexels_initial;
    j["hexels_removed"] = r.last.hexels_burnt + r.last.hexels_fallen;
    j["hexels_burnt"] = r.last.hexels_burnt;
    j["hexels_fallen"] = r.last.hexels_fallen;
    j["links_severed"] = r.last.links_severed;
    j["tip"] = {{"temperature_K", r.last.tip.temperature_K}, {"char_kg", r.last.tip.char_kg}};
    j["volume_removed_m3"] = r.last.volume_removed_m3;
    j["max_temperature_K"] = r.max_temperature_K;
    const tissue::EnergyBudget& e = r.last.energy_J;
    // `latent` is the latent part of `gas`; the others add up to `delivered`.
    j["energy_J"] = {
        {"delivered", e.delivered}, {"stored", r.last.stored_J}, {"latent", e.latent},   {"gas", e.gas},
        {"surface", e.surface},     {"perfusion", e.perfusion},  {"outflow", e.outflow}, {"debris", e.debris},
        {"tip", e.tip + e.transit}};
    j["energy_imbalance"] = r.energy_imbalance;
    // The account of the field itself: greatest share by which V I differs from heat and outflow, of all solves.
    j["field"] = {{"status", r.last.field.imbalance < 5e-4 ? "ok" : "inexact"},
                  {"power_imbalance", r.last.field.imbalance},
                  {"last_residual", r.last.field.residual}};
    Json current = Json::array();
    for (const Conductor& conductor : r.conductors)
        current.push_back(
            {{"tissue", conductor.name},
             {"energy_J", r.last.stray.energy_J[conductor.material]},
             {"highest_current_density_A_per_m2", r.last.stray.highest_density_A_per_m2[conductor.material]}});
    j["current"] = current;
    // Means are over the ticks in contact.
    j["force_N"] = {{"max", r.force_N.max()},
                    {"mean", r.force_N.count() > 0 ? r.force_N.sum() / static_cast<double>(r.force_N.count()) : 0.0}};
    j["surface"] = {{"vertices", r.surface_vertices},
                    {"triangles", r.surface_triangles},
                    {"closed", r.surface_closed},
                    {"volume_m3", r.surface_volume_m3}};
    Json injuries = Json::array();
    for (const Injury& injury : r.injuries)
        injuries.push_back({{"structure", injury.structure},
                            {"hexels_removed", injury.hexels_removed},
                            {"hexels_damaged", injury.hexels_damaged},
                            {"volume_m3", injury.volume_m3},
                            {"max_temperature_K", injury.max_temperature_K},
                            {"first_time_s", injury.first_time_s}});
    j["injuries"] = injuries;
    j["activations"] = activations_json(r.activations);
    if (r.scored) j["score"] = Json::parse(training::to_json(*r.scored));
    j["state_hash"] = fmt::format("{:016x}", r.state_hash);
    j["wall_s"] = r.wall_s;
    // Simulated time over the wall time of the ticks: pictures and files not counted.
    j["realtime_factor"] = r.wall_ticks_s > 0.0 ? r.duration_s / r.wall_ticks_s : 0.0;
    j["tick_us"] = {{"median", r.tick_us.at(0.5)}, {"p99", r.tick_us.at(0.99)}, {"max", r.tick_us.max()}};
    Json stages;
    for (int k = 0; k < simulation::kStages; ++k) stages[simulation::kStageNames[k]] = r.stages_us[k].at(0.5);
    j["stages_us"] = stages;
    // Stages that work only every few ticks show in their means, not in their medians.
    Json means;
    for (int k = 0; k < simulation::kStages; ++k)
        means[simulation::kStageNames[k]] =
            r.stages_us[k].sum() / static_cast<double>(std::max<std::int64_t>(1, r.ticks));
    j["stages_mean_us"] = means;
    Json most;
    for (int k = 0; k < simulation::kStages; ++k) most[simulation::kStageNames[k]] = r.stages_us[k].max();
    j["stages_max_us"] = most;
    j["video"] = r.video;
    Json stills = Json::array();
    for (const Still& still : r.stills) stills.push_back(still.file);
    j["stills"] = stills;
    j["renderer"] = r.renderer;
    j["notes"] = r.notes;
    return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace calot::app
