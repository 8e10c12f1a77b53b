#pragma once
// What the surgeon's hands and feet say, once a tick. A run is a pure function of scene and inputs.

#include <array>
#include <cstdint>

#include "calot/base/vec.h"

namespace calot::tissue {

enum class GeneratorMode : std::uint8_t { cut, blend, coag };

/// A setting that surgeons know by its name.
struct GeneratorPreset {
    const char* name;
    GeneratorMode mode;
    double power_W;
};
/// Usual settings of a monopolar hook in laparoscopic cholecystectomy: cut 30 to 35 W, coagulate 30 to 40 W, up to 55 W
/// in the bed of the liver (SAGES manual on the fundamental use of surgical energy; manufacturers' tables).
inline constexpr std::array<GeneratorPreset, 6> kGeneratorPresets{{{"cut 35", GeneratorMode::cut, 35.0},
                                                                   {"cut 60", GeneratorMode::cut, 60.0},
                                                                   {"blend 35", GeneratorMode::blend, 35.0},
                                                                   {"coag 30", GeneratorMode::coag, 30.0},
                                                                   {"coag 40", GeneratorMode::coag, 40.0},
                                                                   {"coag 55", GeneratorMode::coag, 55.0}}};

/// Pose of an instrument: its reference point (the middle of the hook's foot) and its frame. In the instrument's frame
/// the shaft runs along -z (from the tip towards the trocar) and the hook's foot along +x.
struct Pose {
    Vec3 position_m{0.0};
    Quat orientation{1.0, 0.0, 0.0, 0.0};
};

/// The left hand's grasper. In its frame the shaft runs along -z as the hook's does, the jaws open along +x and -x, and
/// the reference point lies between the tips of the closed jaws.
struct GrasperInput {
    bool present = false;  ///< in the field at all
    Pose pose;
    double jaw = 1.0;  ///< 0 closed ... 1 wide open
};

struct Input {
    Pose hook;
    GrasperInput grasper;
    bool pedal = false;
    GeneratorMode mode = GeneratorMode::cut;
    double power_setting_W = 0.0;
    bool wipe_tip = false;  ///< the char on the hook is wiped off
    // Through the hook's channel. They change what is seen, never the state.
    bool suction = false;     ///< draws off blood and smoke
    bool irrigation = false;  ///< washes
};

}  // namespace calot::tissue
