#include "calot/viewer/mapping.h"

#include <cmath>

namespace calot::viewer {

namespace {

constexpr double kDeadZone = 0.15;
constexpr double kScopeTurn_rad_per_s = 0.16, kScopeSpeed_m_per_s = 0.022;
constexpr double kLens_rad_per_s = 0.9, kHorizon_rad_per_s = 0.7;

/// Dead zone about the middle, then finer control near it than at the rim.
double shaped(double axis) {
    const double size = std::fabs(axis);
    if (size < kDeadZone) return 0.0;
    const double travel = std::fmin(1.0, (size - kDeadZone) / (1.0 - kDeadZone));
    return std::copysign(travel * travel, axis);
}

double between(const Devices& devices, Action minus, Action plus) {
    return (devices.is(plus) ? 1.0 : 0.0) - (devices.is(minus) ? 1.0 : 0.0);
}

}  // namespace

Mapping::Mapping(const Theatre& theatre) : theatre_(theatre) {
    controls_.right = theatre.right_start;
    controls_.left = theatre.left_start;
}

void Mapping::apply(const Devices& devices, double dt_s, Scope& scope) {
    move_scope(devices, dt_s, scope);
    left_active_ = devices.is(Action::left_hand);
    const double notch = sensitivity_.invert_wheel ? -sensitivity_.wheel_m : sensitivity_.wheel_m;
    const double deeper_m =
        notch * devices.wheel + between(devices, Action::back_out, Action::deeper) * sensitivity_.depth_m_per_s * dt_s;
    const double roll_rad =
        between(devices, Action::roll_left, Action::roll_right) * sensitivity_.roll_rad_per_s * dt_s;
    HandTarget& active = left_active_ ? controls_.left : controls_.right;
    move_hand(active, left_active_ ? theatre_.left : theatre_.right, scope, sensitivity_.mouse * devices.mouse_right,
              sensitivity_.mouse * devices.mouse_up, deeper_m, roll_rad);

    auto stick = [&](HandTarget& hand, const Reach& reach, double right, double up, bool depth) {
        right = shaped(right) * dt_s, up = shaped(up) * dt_s;
        if (depth)
            move_hand(hand, reach, scope, 0.0, 0.0, sensitivity_.depth_m_per_s * up,
                      sensitivity_.roll_rad_per_s * right);
        else
            move_hand(hand, reach, scope, sensitivity_.stick_per_s * right, sensitivity_.stick_per_s * up, 0.0, 0.0);
    };
    stick(controls_.right, theatre_.right, devices.pad.hook_right, devices.pad.hook_up, devices.pad.hook_depth);
    stick(controls_.left, theatre_.left, devices.pad.left_right, devices.pad.left_up, devices.pad.left_depth);

    if (devices.grasp_toggled) controls_.left.closed = !controls_.left.closed;
    controls_.yellow = devices.is(Action::yellow_pedal);
    controls_.blue = devices.is(Action::blue_pedal);
    controls_.suction = devices.is(Action::suction);
    controls_.wipe_tip = devices.is(Action::wipe_tip);
    controls_.irrigation = devices.is(Action::irrigation);
    ++controls_.sequence;
}

void Mapping::move_hand(HandTarget& hand, const Reach& reach, const Scope& scope, double right, double up,
                        double deeper_m, double roll_rad) {
    if (right != 0.0 || up != 0.0 || deeper_m != 0.0)
        hand.tip_m = moved_in_view(hand.tip_m, scope.camera(), reach, right, up, deeper_m);
    hand.roll_rad += roll_rad;
}

void Mapping::move_scope(const Devices& devices, double dt_s, Scope& scope) const {
    scope.turn(between(devices, Action::scope_left, Action::scope_right) * kScopeTurn_rad_per_s * dt_s,
               between(devices, Action::scope_down, Action::scope_up) * kScopeTurn_rad_per_s * dt_s);
    scope.advance(between(devices, Action::scope_out, Action::scope_in) * kScopeSpeed_m_per_s * dt_s);
    scope.rotate_lens(between(devices, Action::lens_left, Action::lens_right) * kLens_rad_per_s * dt_s);
    scope.roll(between(devices, Action::horizon_left, Action::horizon_right) * kHorizon_rad_per_s * dt_s);
}

}  // namespace calot::viewer
