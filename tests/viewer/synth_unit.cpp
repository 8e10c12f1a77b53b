#include "calot/viewer/synth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace calot::viewer {
namespace {

std::vector<std::int16_t> play(Synth& synth, const SoundScene& scene, double seconds) {
    std::vector<std::int16_t> samples(static_cast<std::size_t>(seconds * Synth::kRate));
    synth.render(scene, samples.data(), static_cast<int>(samples.size()));
    return samples;
}

double loudness(const std::vector<std::int16_t>& samples) {
    double sum = 0.0;
    for (const std::int16_t sample : samples) sum += static_cast<double>(sample) * sample;
    return std::sqrt(sum / static_cast<double>(samples.size()));
}

/// Share of the energy at a frequency (Goertzel).
double strength_at(const std::vector<std::int16_t>& samples, double frequency_Hz) {
    double re = 0.0, im = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double angle = 6.283185307179586 * frequency_Hz * static_cast<double>(k) / Synth::kRate;
        re += samples[k] * std::cos(angle);
        im += samples[k] * std::sin(angle);
    }
    return std::hypot(re, im) / static_cast<double>(samples.size());
}

SoundScene quiet() {
    SoundScene scene;
    scene.pulse_per_s = 0.0;
    return scene;
}

TEST(Synth, silence_is_silent) {
    Synth synth;
    EXPECT_EQ(loudness(play(synth, quiet(), 0.5)), 0.0);
    SoundScene muted;
    muted.volume = 0.0;
    muted.cutting = true;
    Synth other;
    EXPECT_EQ(loudness(play(other, muted, 0.5)), 0.0);
}

TEST(Synth, cut_and_coag_have_tones_of_their_own) {
    SoundScene cut = quiet(), coag = quiet();
    cut.cutting = true;
    coag.coagulating = true;
    Synth a, b;
    const auto cutting = play(a, cut, 0.5), coagulating = play(b, coag, 0.5);
    EXPECT_GT(strength_at(cutting, 470.0), 10.0 * strength_at(cutting, 330.0));
    EXPECT_GT(strength_at(coagulating, 330.0), 10.0 * strength_at(coagulating, 470.0));
}

TEST(Synth, more_steam_sizzles_louder) {
    SoundScene little = quiet(), much = quiet();
    little.sizzle = 0.2;
    much.sizzle = 1.0;
    Synth a, b;
    EXPECT_GT(loudness(play(b, much, 0.5)), 2.0 * loudness(play(a, little, 0.5)));
}

TEST(Synth, nothing_clicks_when_it_starts_and_ends) {
    Synth synth;
    SoundScene scene = quiet();
    int last = 0, largest = 0;
    for (int k = 0; k < 40; ++k) {
        scene.cutting = k % 4 < 2;
        for (const std::int16_t sample : play(synth, scene, 0.02)) {
            largest = std::max(largest, std::abs(sample - last));
            last = sample;
        }
    }
    EXPECT_LT(largest, 900);  // a tone of 940 Hz at this loudness alone makes some 800 a sample
}

}  // namespace
}  // namespace calot::viewer
