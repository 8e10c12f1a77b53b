#pragma once
// The sounds of the operating room, synthesised: generator tones, sizzle, suction, irrigation, the pulse monitor.

#include <cstdint>

namespace calot::viewer {

/// What is to be heard.
struct SoundScene {
    bool cutting = false, coagulating = false;
    double sizzle = 0.0;  ///< 0 ... 1
    bool suction = false, irrigation = false;
    double pulse_per_s = 1.2;  ///< 0: no monitor
    double volume = 0.6;       ///< 0 silent ... 1
};

class Synth {
  public:
    static constexpr int kRate = 44100;

    /// The next `count` samples, -32767 to 32767, going on from the last ones without a click.
    void render(const SoundScene& scene, std::int16_t* samples, int count);

  private:
    double noise();

    std::uint64_t counter_ = 0;
    double phase_ = 0.0, second_phase_ = 0.0;
    double tone_ = 0.0, pitch_Hz_ = 500.0, sizzle_ = 0.0, suction_ = 0.0, water_ = 0.0, volume_ = 0.0;  ///< now
    double low_ = 0.0, band_ = 0.0, crackle_ = 0.0;                                                     ///< filters
    double gurgle_ = 0.0, beat_s_ = 0.0;
};

}  // namespace calot::viewer
