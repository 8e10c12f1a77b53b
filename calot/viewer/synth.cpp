#include "calot/viewer/synth.h"

#include <algorithm>
#include <cmath>

#include "calot/base/random.h"

namespace calot::viewer {

namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kDt_s = 1.0 / Synth::kRate;
// Generators must sound while they are active, cut and coagulate differently (IEC 60601-2-2, 201.12.4.2); pitches of a
// usual device.
constexpr double kCut_Hz = 470.0, kCoag_Hz = 330.0;
constexpr double kTone = 0.16, kSizzle = 0.40, kSuction = 0.16, kWater = 0.12, kMonitor = 0.05;
constexpr double kMonitor_Hz = 880.0, kMonitorLength_s = 0.07;

/// Moves `value` towards `target` within about `time_s`, so that nothing clicks.
void approach(double& value, double target, double time_s) {
    value += (target - value) * std::min(1.0, kDt_s / time_s);
}

}  // namespace

double Synth::noise() {
    return 2.0 * (static_cast<double>(mix64(counter_++) >> 11) * 0x1p-53) - 1.0;
}

void Synth::render(const SoundScene& scene, std::int16_t* samples, int count) {
    const bool active = scene.cutting || scene.coagulating;
    if (active) pitch_Hz_ = scene.cutting ? kCut_Hz : kCoag_Hz;
    for (int k = 0; k < count; ++k) {
        approach(tone_, active ? 1.0 : 0.0, 0.008);
        approach(sizzle_, std::clamp(scene.sizzle, 0.0, 1.0), 0.03);
        approach(suction_, scene.suction ? 1.0 : 0.0, 0.12);
        approach(water_, scene.irrigation ? 1.0 : 0.0, 0.08);
        approach(volume_, scene.volume, 0.02);
        phase_ = std::fmod(phase_ + kDt_s * pitch_Hz_, 1.0);
        second_phase_ = std::fmod(second_phase_ + kDt_s * 2.0 * pitch_Hz_, 1.0);
        double sum = kTone * tone_ * (std::sin(kTwoPi * phase_) + 0.25 * std::sin(kTwoPi * second_phase_));

        const double white = noise();
        low_ += 0.08 * (white - low_);    // below some 600 Hz
        band_ += 0.45 * (white - band_);  // the rest is hiss
        // Bubbles burst at random: short clicks that ring out, over the hiss of steam.
        if (sizzle_ > 0.01 && noise() > 1.0 - 0.012 * sizzle_) crackle_ += 1.4 * noise();
        crackle_ *= 0.93;
        sum += kSizzle * sizzle_ * (0.35 * (white - band_) + 0.5 * crackle_);
        gurgle_ = std::fmod(gurgle_ + kDt_s * (5.0 + 2.0 * low_), 1.0);
        sum += kSuction * suction_ * (3.0 * low_ * (0.8 + 0.2 * std::sin(kTwoPi * gurgle_)) + 0.2 * white);
        sum += kWater * water_ * (band_ - low_);

        if (scene.pulse_per_s > 0.0) {
            beat_s_ += kDt_s;
            if (beat_s_ > 1.0 / scene.pulse_per_s) beat_s_ = 0.0;
            if (beat_s_ < kMonitorLength_s)
                sum += kMonitor * std::sin(kTwoPi * kMonitor_Hz * beat_s_) *
                       std::sin(0.5 * kTwoPi * beat_s_ / kMonitorLength_s);
        }
        samples[k] = static_cast<std::int16_t>(32767.0 * std::clamp(volume_ * sum, -1.0, 1.0));
    }
}

}  // namespace calot::viewer
