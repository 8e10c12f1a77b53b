#include "calot/simulation/script.h"

#include <algorithm>
#include <cassert>

#include "calot/instruments/grasper.h"
#include "calot/instruments/hook.h"

namespace calot::simulation {

Script::Script(const Vec3& trocar_m, std::vector<Keyframe> keyframes, std::vector<Burst> bursts)
    : trocar_m_(trocar_m), keyframes_(std::move(keyframes)), bursts_(std::move(bursts)) {
    assert(!keyframes_.empty());
    std::sort(bursts_.begin(), bursts_.end(), [](const Burst& a, const Burst& b) { return a.from_s < b.from_s; });
    for (const Keyframe& key : keyframes_) hook_.add(key.time_s, {key.tip_m.x, key.tip_m.y, key.tip_m.z, key.roll_rad});
    hook_.finish();
}

void Script::set_grasper(const Vec3& trocar_m, std::vector<GrasperKeyframe> keyframes) {
    grasper_trocar_m_ = trocar_m;
    grasper_keyframes_ = std::move(keyframes);
    grasper_ = {};
    for (const GrasperKeyframe& key : grasper_keyframes_)
        grasper_.add(key.time_s, {key.tip_m.x, key.tip_m.y, key.tip_m.z, key.roll_rad, key.jaw});
    grasper_.finish();
}

tissue::Input Script::at(double time_s) const {
    tissue::Input input;
    const auto hook = hook_.at(time_s);
    input.hook = instruments::pose_through_trocar(trocar_m_, Vec3(hook[0], hook[1], hook[2]), hook[3]);
    for (const Burst& burst : bursts_)
        if (time_s >= burst.from_s && time_s < burst.to_s) {
            input.pedal = true;
            input.mode = burst.mode;
            input.power_setting_W = burst.power_W;
            input.wipe_tip = burst.wiped && time_s < burst.from_s + 1.5e-3;
        }
    if (!grasper_.empty()) {
        const auto hand = grasper_.at(time_s);
        input.grasper.present = true;
        input.grasper.pose =
            instruments::grasper_pose_through_trocar(grasper_trocar_m_, Vec3(hand[0], hand[1], hand[2]), hand[3]);
        input.grasper.jaw = hand[4];
    }
    return input;
}

}  // namespace calot::simulation
