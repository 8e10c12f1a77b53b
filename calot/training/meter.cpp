#include "calot/training/meter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace calot::training {

namespace {

constexpr std::size_t kMostEvents = 4000;
constexpr double kTraction_N = 0.05;
constexpr double kGentle_N = 0.5;
constexpr double kOrganGap_m = 0.1e-3;
constexpr float kTouchGap_m = 0.05e-3f;
/// A hole through a wall of a millimetre.
constexpr double kBreach_m3 = 1e-9;
/// Touches closer together are one.
constexpr std::int64_t kTicksOfTouch = 500;
/// Collagen and protein denature in seconds from here on.
constexpr double kHotTip_K = 333.15;
constexpr std::int64_t kTicksPerOrganLook = 4;

/// Bits of Meter's archive: another layout gets another number.
constexpr std::uint32_t kArchiveVersion = 2;

Structure make_structure(const simulation::Simulation& run, const char* material) {
    return Structure(run.model(), tissue::find_material(run.model().materials, material), run.setup().camera.eye_m);
}

bool near_box(const Box& box, const Vec3& p, double reach_m) {
    return glm::all(glm::greaterThan(p, box.low - reach_m)) && glm::all(glm::lessThan(p, box.high + reach_m));
}

}  // namespace

Meter::Meter(const simulation::Simulation& run, std::vector<Target> targets)
    : tick_s_(run.model().tick_s),
      hexel_volume_m3_(run.model().hexel_volume_m3()),
      trocar_m_(run.setup().script.trocar_m()),
      fat_(tissue::find_material(run.model().materials, "fat")),
      structures_{make_structure(run, "cystic_duct"), make_structure(run, "cystic_artery")},
      liver_hexels_(hexels_at_organ(run.model(), "liver")),
      targets_(std::move(targets)),
      hook_(run.model().tick_s),
      grasper_(run.model().tick_s),
      touched_(targets_.size(), 0) {
    between_ = fat_between(run.model(), structures_[0], structures_[1], fat_, between_count_);
    for (std::size_t k = 0; k < run.model().organs.size(); ++k) {
        const std::string& name = run.model().organs[k].name;
        if (name != "peritoneum" && name != "omentum") dangerous_organs_.push_back(k);
    }
    events_.reserve(kMostEvents);
    sums_.liver_peak_K = liver_hexels_.empty() ? 0.0 : run.model().thermal.body_temperature_K;
    for (std::size_t which = 0; which < 2; ++which) {
        sums_.state[which] = structures_[which].look(run.state());
        // What lies bare from the start is no achievement.
        while (sums_.exposure_steps[which] < static_cast<int>(kExposureSteps.size()) &&
               sums_.state[which].exposed >= kExposureSteps[static_cast<std::size_t>(sums_.exposure_steps[which])])
            ++sums_.exposure_steps[which];
    }
}

void Meter::add_event(const Event& event) {
    if (events_.size() < kMostEvents) events_.push_back(event);
}

void Meter::after_tick(const simulation::Simulation& run, const tissue::Input& input) {
    const std::int64_t tick = run.figures().tick;
    sums_.ticks = tick;
    move(input, tick);
    watch_pedal(run, input);
    watch_contact(run, input);
    if (tick % kTicksPerOrganLook == 0) watch_organs(run, input);
    watch_removal(run);
    watch_targets(input);
    heat(run);
    if (tick % kTicksPerLook == 0) look(run, 0);
    if (tick % kTicksPerLook == kTicksPerLook / 2) look(run, 1);
    if (tick % kTicksPerPoint == 0) add_point(run);
}

void Meter::move(const tissue::Input& input, std::int64_t tick) {
    hook_.after_tick(input.hook.position_m, tick);
    if (!input.grasper.present) return;
    grasper_used_ = true;
    grasper_.after_tick(input.grasper.pose.position_m, tick);
}

void Meter::add_point(const simulation::Simulation& run) {
    Sums& s = sums_;
    TrackPoint point;
    point.time_s = static_cast<float>(run.time_s());
    point.force_peak_N = static_cast<float>(s.force_since_point_N);
    point.power_W =
        static_cast<float>((s.energy_J - s.energy_at_point_J) / (static_cast<double>(kTicksPerPoint) * tick_s_));
    for (std::size_t which = 0; which < 2; ++which) {
        point.exposed[which] = static_cast<float>(s.state[which].exposed);
        point.peak_K[which] = static_cast<float>(s.state[which].peak_K);
    }
    s.force_since_point_N = 0.0;
    s.energy_at_point_J = s.energy_J;
    track_.push_back(point);
}

void Meter::watch_pedal(const simulation::Simulation& run, const tissue::Input& input) {
    Sums& s = sums_;
    const double now_s = run.time_s();
    if (input.pedal) {
        if (s.pedal_now == 0) {
            ++s.activations;
            s.energy_at_start_J = s.energy_J;
            add_event({now_s, EventKind::activation_start, "", 0.0});
        }
        ++s.pedal;
        ++s.pedal_now;
        s.pedal_longest = std::max(s.pedal_longest, s.pedal_now);
        if (run.figures().generator.current_A > 0.0) ++s.pedal_contact;
        s.energy_J += run.figures().generator.power_W * tick_s_;
    } else if (s.pedal_now > 0) {
        s.pedal_now = 0;
        add_event({now_s, EventKind::activation_end, "", s.energy_J - s.energy_at_start_J});
    }
}

void Meter::watch_contact(const simulation::Simulation& run, const tissue::Input& input) {
    Sums& s = sums_;
    const Vec3 force_N = run.figures().hook_force_N;
    const double size_N = glm::length(force_N);
    s.force_peak_N = std::max(s.force_peak_N, size_N);
    s.force_since_point_N = std::max(s.force_since_point_N, size_N);
    const double pull_N = -glm::dot(force_N, glm::normalize(trocar_m_ - input.hook.position_m));
    s.pull_peak_N = std::max(s.pull_peak_N, pull_N);
    if (input.pedal && run.figures().generator.current_A > 0.0 && pull_N >= kTraction_N) ++s.pedal_traction;
    s.in_contact = size_N > 0.0;
    if (s.in_contact) {
        ++s.contact;
        s.gentle += size_N < kGentle_N;
    }

    const tissue::Exchange& exchange = run.exchange();
    std::array<bool, 2> touching{};
    for (const tissue::Contact& contact : exchange.contacts) {
        if (contact.gap_m > kTouchGap_m) continue;
        const auto hexel = static_cast<std::size_t>(exchange.near[static_cast<std::size_t>(contact.near)].hexel);
        const tissue::MaterialIndex material = run.model().hexel_material[hexel];
        for (std::size_t which = 0; which < 2; ++which)
            touching[which] =
                touching[which] || (structures_[which].exists() && material == structures_[which].material());
    }
    for (std::size_t which = 0; which < 2; ++which) {
        if (touching[which] && (s.touched_at[which] < 0 || s.ticks - s.touched_at[which] > kTicksOfTouch))
            add_event({run.time_s(), EventKind::touch, run.model().materials[structures_[which].material()].name,
                       input.pedal ? 1.0 : 0.0});
        if (touching[which]) s.touched_at[which] = s.ticks;
    }
    const bool hot = !input.pedal && run.figures().tip.temperature_K >= kHotTip_K;
    s.hot_touch += hot && (touching[0] || touching[1]);
}

void Meter::watch_organs(const simulation::Simulation& run, const tissue::Input& input) {
    const bool was_at_organ = sums_.at_organ;
    sums_.at_organ = false;
    if (!input.pedal) return;
    for (std::size_t k : dangerous_organs_) {
        const tissue::RigidOrgan& organ = run.model().organs[k];
        const Box bounds = organ.shape->bounds_m();
        for (const tissue::Capsule& capsule : run.capsules()) {
            if (!capsule.bare) continue;
            for (double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                const Vec3 p = glm::mix(capsule.a_m, capsule.b_m, t);
                const double reach_m = capsule.radius_m + kOrganGap_m;
                if (!near_box(bounds, p, reach_m) || organ.shape->distance_m(p) > reach_m) continue;
                if (!was_at_organ) add_event({run.time_s(), EventKind::organ_touch, organ.name, 0.0});
                sums_.at_organ = true;
                sums_.organ_touch += kTicksPerOrganLook;
                return;
            }
        }
    }
}

void Meter::watch_removal(const simulation::Simulation& run) {
    for (std::int64_t hexel : run.exchange().removed_hexels) {
        if (run.model().hexel_material[static_cast<std::size_t>(hexel)] != fat_) continue;
        ++sums_.fat_removed;
        sums_.between_removed += between_.test(hexel);
    }
}

void Meter::watch_targets(const tissue::Input& input) {
    if (!sums_.in_contact) return;
    for (std::size_t k = 0; k < targets_.size(); ++k) {
        if (touched_[k] || glm::distance(input.hook.position_m, targets_[k].position_m) > targets_[k].radius_m)
            continue;
        touched_[k] = 1;
        add_event({static_cast<double>(sums_.ticks) * tick_s_, EventKind::target, "", static_cast<double>(k + 1)});
    }
}

void Meter::look(const simulation::Simulation& run, std::size_t which) {
    if (which == 0) {
        sums_.liver_injured = 0;
        for (std::int64_t hexel : liver_hexels_) {
            const auto cell = static_cast<std::size_t>(hexel);
            sums_.liver_peak_K =
                std::max(sums_.liver_peak_K, static_cast<double>(run.state().peak_temperature_K[cell]));
            sums_.liver_injured += run.state().damage[cell] >= 1.0f;
        }
    }
    const Structure& structure = structures_[which];
    if (!structure.exists()) return;
    const StructureState now = structure.look(run.state());
    const std::string& name = run.model().materials[structure.material()].name;
    int& steps = sums_.exposure_steps[which];
    while (steps < static_cast<int>(kExposureSteps.size()) &&
           now.exposed >= kExposureSteps[static_cast<std::size_t>(steps)])
        add_event({run.time_s(), EventKind::exposed, name, kExposureSteps[static_cast<std::size_t>(steps++)]});
    if (now.injured > 0 && !sums_.injured[which]) {
        sums_.injured[which] = true;
        add_event({run.time_s(), EventKind::injured, name, static_cast<double>(now.injured)});
    }
    if (static_cast<double>(now.burnt) * hexel_volume_m3_ >= kBreach_m3 && sums_.burnt_at[which] < 0) {
        sums_.burnt_at[which] = sums_.ticks;
        add_event({run.time_s(), EventKind::burnt, name, static_cast<double>(now.burnt)});
    }
    sums_.state[which] = now;
}

void Meter::heat(const simulation::Simulation& run) {
    const tissue::StrayCurrent& stray = run.figures().stray;
    for (std::size_t which = 0; which < 2; ++which) {
        const std::size_t material = structures_[which].material();
        if (!structures_[which].exists() || material >= tissue::kStrayMaterials) continue;
        sums_.heat_J[which] = stray.energy_J[material];
        sums_.most_A_per_m2[which] = stray.highest_density_A_per_m2[material];
    }
}

void Meter::archive(Archive& archive) {
    std::uint32_t version = kArchiveVersion;
    archive.value(version);
    if (version != kArchiveVersion)
        throw std::runtime_error("what was measured was stored by another version of Calot");
    archive.value(sums_);
    archive.value(touched_);
    archive.value(events_);
    archive.value(track_);
    if (touched_.size() != targets_.size()) throw std::runtime_error("what was measured belongs to another task");
}

std::string Meter::save() const {
    Archive out;
    const_cast<Meter*>(this)->archive(out);  // writing changes nothing
    return out.bytes();
}

void Meter::restore(const std::string& bytes, std::span<const tissue::Input> inputs) {
    Archive in(bytes);
    archive(in);
    hook_ = MovementWatch(tick_s_);
    grasper_ = MovementWatch(tick_s_);
    grasper_used_ = false;
    for (std::size_t k = 0; k < inputs.size(); ++k) move(inputs[k], static_cast<std::int64_t>(k) + 1);
    if (!in.at_end()) throw std::runtime_error("what was measured belongs to another version of Calot");
    events_.reserve(kMostEvents);
}

namespace {

/// Points of one criterion: 2 from 60 %, 1 from 30 % (Metric "cvs_points").
int doublet_points(double share) {
    return share >= 0.6 ? 2 : share >= 0.3 ? 1 : 0;
}

}  // namespace

Metrics Meter::metrics(bool smoothness) const {
    const Sums& s = sums_;
    const auto seconds = [&](std::int64_t ticks) { return static_cast<double>(ticks) * tick_s_; };
    const auto share = [](std::int64_t part, std::int64_t whole) {
        return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(1, whole));
    };
    Metrics m;
    m["time_s"] = seconds(s.ticks);
    static constexpr std::array<const char*, 2> kNames{"duct", "artery"};
    std::int64_t hidden = 0;
    for (std::size_t which = 0; which < 2; ++which) {
        if (!structures_[which].exists()) continue;
        const std::string name = kNames[which];
        const StructureState& state = s.state[which];
        m[name + "_exposed"] = state.exposed;
        m[name + "_freed"] = state.freed;
        m[name + "_energy_J"] = s.heat_J[which];
        m[name + "_current_density_A_per_m2"] = s.most_A_per_m2[which];
        m[name + "_peak_K"] = state.peak_K;
        m[name + "_injured_m3"] = static_cast<double>(state.injured) * hexel_volume_m3_;
        m[name + "_burnt_m3"] = static_cast<double>(state.burnt) * hexel_volume_m3_;
        m[which == 0 ? "bile_leak_s" : "bleeding_s"] =
            s.burnt_at[which] < 0 ? 0.0 : seconds(s.ticks - s.burnt_at[which]);
        hidden += state.hidden;
    }
    if (structures_[0].exists() || structures_[1].exists()) {
        m["hidden_injury_m3"] = static_cast<double>(hidden) * hexel_volume_m3_;
        m["hot_touch_s"] = seconds(s.hot_touch);
    }
    if (between_count_ > 0) {
        m["triangle_cleared"] = share(s.between_removed, between_count_);
        m["cvs_points"] =
            doublet_points(m["triangle_cleared"]) + doublet_points(std::min(s.state[0].exposed, s.state[1].exposed));
    }
    m["fat_removed_m3"] = static_cast<double>(s.fat_removed) * hexel_volume_m3_;
    m["hook_path_m"] = hook_.path_m();
    if (grasper_used_) m["grasper_path_m"] = grasper_.path_m();
    if (smoothness) {
        m["hook_movements"] = hook_.movements();
        m["hook_smoothness"] = hook_.smoothness();
        if (grasper_used_) m["grasper_smoothness"] = grasper_.smoothness();
    }
    m["activations"] = static_cast<double>(s.activations);
    m["activation_s"] = seconds(s.pedal);
    m["activation_contact_s"] = seconds(s.pedal_contact);
    m["activation_open_s"] = seconds(s.pedal - s.pedal_contact);
    m["longest_activation_s"] = seconds(s.pedal_longest);
    m["activation_under_traction"] = share(s.pedal_traction, s.pedal_contact);
    m["energy_J"] = s.energy_J;
    if (!liver_hexels_.empty()) {
        m["liver_peak_K"] = s.liver_peak_K;
        m["liver_injured_m3"] = static_cast<double>(s.liver_injured) * hexel_volume_m3_;
    }
    if (!dangerous_organs_.empty()) m["organ_touch_s"] = seconds(s.organ_touch);
    m["force_peak_N"] = s.force_peak_N;
    m["pull_peak_N"] = s.pull_peak_N;
    m["gentle_contact"] = s.contact > 0 ? share(s.gentle, s.contact) : 1.0;
    if (!targets_.empty()) {
        const auto touched = static_cast<double>(std::count(touched_.begin(), touched_.end(), 1));
        m["targets_touched"] = touched;
        m["targets_left"] = static_cast<double>(targets_.size()) - touched;
    }
    for (auto at = m.begin(); at != m.end();) at = std::isnan(at->second) ? m.erase(at) : std::next(at);
    return m;
}

}  // namespace calot::training
