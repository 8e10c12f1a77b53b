#pragma once
// From mouse, keys and pads to what the hands want. The window tells what is pressed, in the words below; it knows no
// anatomy, and this knows no window.

#include <array>
#include <bitset>

#include "calot/viewer/controls.h"
#include "calot/viewer/scope.h"
#include "calot/viewer/session.h"

namespace calot::viewer {

/// What a key, button or pedal can be bound to and held for.
enum class Action {
    yellow_pedal,
    blue_pedal,
    roll_left,
    roll_right,
    deeper,
    back_out,
    left_hand,  ///< mouse and roll move the grasper while it is held
    suction,
    irrigation,
    wipe_tip,  ///< char off the hook
    scope_left,
    scope_right,
    scope_up,
    scope_down,
    scope_in,
    scope_out,
    lens_left,
    lens_right,
    horizon_left,
    horizon_right,
    count
};

/// Devices at one moment.
struct Devices {
    std::bitset<static_cast<std::size_t>(Action::count)> held;
    double mouse_right = 0.0;  ///< since the last sample, in picture heights
    double mouse_up = 0.0;
    double wheel = 0.0;  ///< notches; up is deeper
    /// A pad's sticks, -1 to 1, dead zone left to the mapping: hook right/up, grasper right/up, hook deeper/roll.
    struct Pad {
        double hook_right = 0.0, hook_up = 0.0, left_right = 0.0, left_up = 0.0;
        bool hook_depth = false;  ///< the right stick moves depth and roll instead
        bool left_depth = false;  ///< the left one
    } pad;
    bool grasp_toggled = false;  ///< jaws: open <-> closed

    bool is(Action action) const { return held.test(static_cast<std::size_t>(action)); }
    void hold(Action action, bool down) {
        if (down) held.set(static_cast<std::size_t>(action));
    }
};

struct Sensitivity {
    double mouse = 0.6;           ///< tip movement per movement of the pointer, at equal size on the screen
    double wheel_m = 1.2e-3;      ///< a notch
    double depth_m_per_s = 0.02;  ///< keys and sticks
    double roll_rad_per_s = 2.2;
    double stick_per_s = 0.35;  ///< picture heights a second at full deflection
    bool invert_wheel = false;
};

/// Keeps what both hands want and moves the scope.
class Mapping {
  public:
    explicit Mapping(const Theatre& theatre);
    /// Applies one sample that covers `dt_s`.
    void apply(const Devices& devices, double dt_s, Scope& scope);
    const Controls& controls() const { return controls_; }
    Controls& controls() { return controls_; }
    Sensitivity& sensitivity() { return sensitivity_; }
    bool left_active() const { return left_active_; }

  private:
    void move_hand(HandTarget& hand, const Reach& reach, const Scope& scope, double right, double up, double deeper_m,
                   double roll_rad);
    void move_scope(const Devices& devices, double dt_s, Scope& scope) const;

    Theatre theatre_;
    Sensitivity sensitivity_;
    Controls controls_;
    bool left_active_ = false;
};

}  // namespace calot::viewer
