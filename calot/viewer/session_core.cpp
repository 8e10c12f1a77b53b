#include "calot/viewer/session_core.h"

#include <algorithm>
#include <utility>

#include "calot/instruments/grasper.h"

namespace calot::viewer {

namespace {

constexpr double kJawTime_s = 0.25;      ///< from wide open to closed
constexpr double kJawOpen = 0.5;         ///< as far as the trainee opens them
constexpr double kBoilingTime_s = 0.08;  ///< over which the sizzle is averaged

Vec3 landmark_or(const anatomy::Anatomy& anatomy, const char* name, const Vec3& otherwise) {
    const auto found = anatomy.landmarks_m.find(name);
    return found != anatomy.landmarks_m.end() ? found->second : otherwise;
}

}  // namespace

Theatre theatre_of(const simulation::Setup& setup) {
    Theatre theatre;
    const Vec3 centre_m = setup.camera.target_m;
    theatre.right.centre_m = theatre.left.centre_m = centre_m;
    theatre.right.port_m = setup.script.trocar_m();
    // The left hand's port lies on the other side, lower: in the right upper abdomen, where the surgeon's left hand is.
    const Vec3 across = theatre.right.port_m - centre_m;
    theatre.left.port_m =
        landmark_or(setup.anatomy, "grasper_trocar", centre_m + Vec3(-across.x, 0.6 * across.y, across.z));
    if (glm::length(setup.grasper_trocar_m) > 0.0) theatre.left.port_m = setup.grasper_trocar_m;
    const auto& keys = setup.script.keyframes();
    if (!keys.empty()) theatre.right_start.roll_rad = keys.front().roll_rad;
    // Both tips in sight, clear of the tissue: a third of the way from it to the lens.
    render::Camera camera;
    camera.eye_m = setup.camera.eye_m;
    camera.target_m = centre_m;
    camera.field_of_view_deg = setup.camera.field_of_view_deg;
    const Vec3 between_m = centre_m + 0.33 * (camera.eye_m - centre_m);
    theatre.right_start.tip_m = moved_in_view(between_m, camera, theatre.right, 0.16, 0.14, 0.0);
    theatre.left_start.tip_m = moved_in_view(between_m, camera, theatre.left, -0.26, 0.16, 0.0);
    return theatre;
}

Theatre theatre_of(const simulation::Simulation& run) {
    Theatre theatre = theatre_of(run.setup());
    const tissue::State& state = run.figures();
    if (state.tick == 0) return theatre;
    theatre.right_start.tip_m = state.hook.position_m;
    theatre.right_start.roll_rad = haptics::roll_of(theatre.right.port_m, state.hook, run.setup().hook);
    if (state.grasper.present == 0) return theatre;
    instruments::HookShape straight;  // the grasper's reference point lies on its axis
    straight.foot_length_m = 0.0;
    theatre.left_start.tip_m = state.grasper.pose.position_m;
    theatre.left_start.roll_rad = haptics::roll_of(theatre.left.port_m, state.grasper.pose, straight);
    theatre.left_start.closed = state.grasper.held > 0 || state.grasper.jaw < 0.5 * kJawOpen;
    return theatre;
}

SessionCore::SessionCore(std::unique_ptr<simulation::Simulation> run, std::vector<std::shared_ptr<Observer>> observers)
    : run_(std::move(run)),
      observers_(std::move(observers)),
      theatre_(theatre_of(*run_)),
      right_(theatre_.right_start),
      left_(theatre_.left_start),
      jaw_(run_->figures().grasper.present != 0 ? run_->figures().grasper.jaw : kJawOpen),
      picture_(run_->setup()) {
    input_.hook = right_.pose(theatre_.right.port_m, run_->setup().hook);
    for (const auto& observer : observers_) observer->begin(*run_);
}

void SessionCore::end() {
    if (std::exchange(ended_, true)) return;
    for (const auto& observer : observers_) observer->end(*run_);
}

tissue::Input SessionCore::input_for(const Controls& controls) {
    const double dt_s = run_->model().tick_s;
    right_.advance({within_reach(controls.right.tip_m, theatre_.right), controls.right.roll_rad, controls.right.closed},
                   run_->figures().hook_force_N, dt_s);
    tissue::Input input;
    input.hook = right_.pose(theatre_.right.port_m, run_->setup().hook);
    left_.advance({within_reach(controls.left.tip_m, theatre_.left), controls.left.roll_rad, controls.left.closed},
                  run_->figures().grasper.force_N, dt_s);
    // Jaws take a moment to open and close, so that tissue is not hit by them.
    const double wanted = controls.left.closed ? 0.0 : kJawOpen;
    jaw_ += std::clamp(wanted - jaw_, -dt_s / kJawTime_s, dt_s / kJawTime_s);
    input.grasper.present = true;
    input.grasper.pose =
        instruments::grasper_pose_through_trocar(theatre_.left.port_m, left_.tip_m(), left_.roll_rad());
    input.grasper.jaw = jaw_;
    // Both pedals at once: cutting wins, as on generators.
    input.pedal = controls.yellow || controls.blue;
    input.mode = controls.yellow ? (controls.blended_cut ? tissue::GeneratorMode::blend : tissue::GeneratorMode::cut)
                                 : tissue::GeneratorMode::coag;
    input.power_setting_W = controls.yellow ? controls.cut_W : controls.blue ? controls.coag_W : 0.0;
    input.wipe_tip = controls.wipe_tip;
    input.suction = controls.suction;
    input.irrigation = controls.irrigation;
    return input;
}

/// The device's hand in place of the controls' right one, which goes on from there once the device is let go.
void SessionCore::follow_device(const Controls& controls) {
    if (!device_ || !device_->drive(input_)) return;
    const Vec3& port_m = theatre_.right.port_m;
    right_ = HeldInstrument(
        {input_.hook.position_m, haptics::roll_of(port_m, input_.hook, run_->setup().hook), controls.right.closed});
    if (!input_.pedal || controls.yellow || controls.blue) return;
    input_.mode = controls.blended_cut ? tissue::GeneratorMode::blend : tissue::GeneratorMode::cut;
    input_.power_setting_W = controls.cut_W;  // the stylus' button is a yellow pedal
}

bool SessionCore::tick(const Controls& controls) {
    input_ = input_for(controls);
    follow_device(controls);
    const bool ok = run_->tick(input_);
    if (device_) device_->feel(run_->figures());
    double gas_kg = 0.0;
    for (const tissue::GasEvent& event : run_->exchange().gas)
        gas_kg += static_cast<double>(event.steam_kg) + static_cast<double>(event.smoke_kg);
    const double dt_s = run_->model().tick_s;
    boiling_kg_per_s_ += (gas_kg / dt_s - boiling_kg_per_s_) * dt_s / kBoilingTime_s;
    for (const auto& observer : observers_) observer->after_tick(*run_, input_);
    return ok;
}

void fill_snapshot(const simulation::Simulation& run, const tissue::Input& input, Picture& picture,
                   Snapshot& snapshot) {
    begin_snapshot(run, input, picture, snapshot);
    picture.go_on(run, snapshot.view.tissue.size(), snapshot.moment, snapshot.view);
}

void begin_snapshot(const simulation::Simulation& run, const tissue::Input& input, Picture& picture,
                    Snapshot& snapshot) {
    const tissue::State& state = run.figures();
    picture.begin(run, input, snapshot.moment, snapshot.view);
    snapshot.tick = state.tick;
    snapshot.time_s = run.time_s();
    snapshot.generator = state.generator;
    snapshot.input = input;
    snapshot.hook_force_N = state.hook_force_N;
    snapshot.tip_m = input.hook.position_m;
    snapshot.bleeding_m3_per_s = run.bleeding().flow_m3_per_s();
    snapshot.blood_lost_m3 = run.bleeding().lost_m3();
    snapshot.status = state.status;
    snapshot.hottest_K = 310.15f;
    for (const tissue::NearHexel& near : run.exchange().near)
        if (near.bare_gap_m < 1e-3f)
            snapshot.hottest_K =
                std::max(snapshot.hottest_K, run.work().thermal.temperature_K[static_cast<std::size_t>(near.hexel)]);
}

void SessionCore::fill(Snapshot& snapshot) {
    begin(snapshot);
    go_on(snapshot, snapshot.view.tissue.size());
}

void SessionCore::begin(Snapshot& snapshot) {
    begin_snapshot(*run_, input_, picture_, snapshot);
    snapshot.tip_m = right_.tip_m();
    snapshot.boiling_kg_per_s = boiling_kg_per_s_;
}

}  // namespace calot::viewer
