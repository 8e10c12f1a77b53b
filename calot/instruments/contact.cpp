#include "calot/instruments/contact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace calot::instruments {

namespace {

/// Constraints are made this far ahead of touching, beyond what the instrument moves in the tick: tissue rebounds at
/// some 0.1 m/s at most.
constexpr double kMargin_m = 2e-4;
/// Two constraints at one hexel must differ in direction by more than 60 degrees.
constexpr float kWedgeCosine = 0.5f;
/// Ways out along a capsule's axis are taken as if they led across it at this squared sine.
constexpr double kLeastSine2 = 0.05;
/// Points along a capsule at which an organ's distance is taken are at most this far apart; the shaft's are further.
constexpr double kWireSample_m = 2.5e-3;
constexpr int kMostSamples = 12;
/// More than the instruments have.
constexpr std::size_t kMostCapsules = 16;

/// How far along `direction` (unit) a place `away` from the axis is from leaving a cylinder about `axis` (unit), or a
/// sphere where `axis` is 0. Requires the place to lie inside.
double way_out_m(const Vec3& away, const Vec3& direction, const Vec3& axis, double radius_m) {
    const Vec3 d = direction - glm::dot(direction, axis) * axis, q = away - glm::dot(away, axis) * axis;
    const double a = std::fmax(kLeastSine2, glm::dot(d, d)), b = glm::dot(d, q),
                 c = glm::dot(q, q) - radius_m * radius_m;
    return (-b + std::sqrt(std::fmax(0.0, b * b - a * c))) / a;
}

double speed(const tissue::Capsule& c) {
    return std::fmax(glm::length(c.velocity_a_m_per_s), glm::length(c.velocity_b_m_per_s));
}

double margin_m(const tissue::Model& model, const tissue::Exchange& exchange) {
    double fastest = 0.0;
    for (const tissue::Capsule& c : exchange.capsules) fastest = std::fmax(fastest, speed(c));
    return kMargin_m + fastest * model.tick_s;
}

bool overlap(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

/// The part [t0, t1] of the segment a, b inside a box; false when there is none.
bool clip(const Vec3& a, const Vec3& b, const Box& box, double& t0, double& t1) {
    t0 = 0.0, t1 = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = b[axis] - a[axis];
        if (std::fabs(d) < 1e-12) {
            if (a[axis] < box.low[axis] || a[axis] > box.high[axis]) return false;
            continue;
        }
        const double u = (box.low[axis] - a[axis]) / d, v = (box.high[axis] - a[axis]) / d;
        t0 = std::fmax(t0, std::fmin(u, v));
        t1 = std::fmin(t1, std::fmax(u, v));
    }
    return t0 <= t1;
}

/// Gradient of a distance by central differences, normalised.
Vec3 outward_of(const anatomy::Shape& shape, const Vec3& p) {
    constexpr double kStep_m = 1e-5;
    Vec3 gradient(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step(0.0);
        step[axis] = kStep_m;
        gradient[axis] = shape.distance_m(p + step) - shape.distance_m(p - step);
    }
    const double length = glm::length(gradient);
    return length > 0.0 ? gradient / length : Vec3(0.0);
}

Vec3 organ_force_N(const anatomy::Shape& shape, const std::vector<tissue::Capsule>& capsules,
                   tissue::Instrument instrument) {
    const Box bounds = shape.bounds_m();
    double deepest_m = 0.0;
    Vec3 where(0.0);
    for (const tissue::Capsule& c : capsules) {
        if (c.instrument != instrument) continue;
        const Box wide{bounds.low - c.radius_m, bounds.high + c.radius_m};
        double t0, t1;
        if (!overlap(wide, {glm::min(c.a_m, c.b_m), glm::max(c.a_m, c.b_m)}) || !clip(c.a_m, c.b_m, wide, t0, t1))
            continue;
        const double length_m = (t1 - t0) * glm::length(c.b_m - c.a_m);
        const int samples = std::min(kMostSamples, 2 + static_cast<int>(length_m / kWireSample_m));
        for (int k = 0; k < samples; ++k) {
            const Vec3 p = glm::mix(c.a_m, c.b_m, t0 + (t1 - t0) * k / (samples - 1));
            const double depth_m = c.radius_m - shape.distance_m(p);
            if (depth_m > deepest_m) {
                deepest_m = depth_m;
                where = p;
            }
        }
    }
    return deepest_m > 0.0 ? kOrganStiffness_N_per_m * deepest_m * outward_of(shape, where) : Vec3(0.0);
}

}  // namespace

// Capsules stand where they are at the end of the tick, tissue where it is at its start.
StartCapsule::StartCapsule(const tissue::Capsule& end, double dt_s)
    : capsule(&end),
      a_m(end.a_m - dt_s * end.velocity_a_m_per_s),
      ab_m(end.b_m - dt_s * end.velocity_b_m_per_s - a_m),
      length2_m2(glm::dot(ab_m, ab_m)) {
    if (length2_m2 == 0.0) return;
    axis = ab_m / std::sqrt(length2_m2);
    inverse_length2_per_m2 = 1.0 / length2_m2;
}

bool StartCapsule::further_than(const Vec3& p, double distance_m) const {
    constexpr double kRounding_m = 1e-7;
    const Vec3 ap = p - a_m;
    const double t = std::clamp(glm::dot(ap, ab_m) * inverse_length2_per_m2, 0.0, 1.0);
    const Vec3 away = ap - t * ab_m;
    return glm::dot(away, away) > (distance_m + kRounding_m) * (distance_m + kRounding_m);
}

Touch touch(const StartCapsule& start, const tissue::NearHexel& hexel, double point_radius_m) {
    const tissue::Capsule& capsule = *start.capsule;
    const Vec3 &a = start.a_m, &ab = start.ab_m;
    const Vec3 p(hexel.world_m);
    const double length2 = start.length2_m2, reach_m = capsule.radius_m + point_radius_m;
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
    const Vec3 away = p - (a + t * ab);
    const double distance_m = glm::length(away);
    const Vec3 radial = distance_m > 0.0 ? away / distance_m : Vec3(0.0, 0.0, 1.0);
    const Vec3 inward(-hexel.outward);

    Vec3 normal = radial;
    double gap_m = distance_m - reach_m;
    const bool backside = glm::dot(radial, inward) <= 0.0 && distance_m >= capsule.radius_m;
    if (gap_m < 0.0 && inward != Vec3(0.0) && !backside) {
        normal = inward;
        const bool on_side = t > 0.0 && t < 1.0;
        gap_m = -way_out_m(away, inward, on_side ? start.axis : Vec3(0.0), reach_m);
    }
    Touch result;
    result.normal = Vec3f(normal);
    result.gap_m = static_cast<float>(gap_m);
    result.tool_velocity_m_per_s = Vec3f(glm::mix(capsule.velocity_a_m_per_s, capsule.velocity_b_m_per_s, t));
    result.instrument = capsule.instrument;
    return result;
}

double contact_reach_m(const tissue::Model& model, const tissue::Exchange& exchange) {
    return 0.5 * model.hexels.spacing_m + 2.0 * margin_m(model, exchange);  // moved by one tick
}

void find_contacts(const tissue::Model& model, const tissue::State&, tissue::Exchange& exchange) {
    exchange.contacts.clear();
    const double point_radius_m = 0.5 * model.hexels.spacing_m;
    const auto margin = static_cast<float>(margin_m(model, exchange)),
               reach_m = static_cast<float>(contact_reach_m(model, exchange));
    std::array<StartCapsule, kMostCapsules> solid;
    std::size_t capsules = 0;
    for (const tissue::Capsule& capsule : exchange.capsules)
        if (capsule.solid && capsules < solid.size()) solid[capsules++] = {capsule, model.tick_s};
    for (std::size_t k = 0; k < exchange.near.size(); ++k) {
        const tissue::NearHexel& hexel = exchange.near[k];
        if (hexel.distance_m > reach_m) continue;
        Touch first, second;
        bool has_first = false, has_second = false;
        const Vec3 world_m(hexel.world_m);
        for (std::size_t c = 0; c < capsules; ++c) {
            if (solid[c].further_than(world_m, solid[c].capsule->radius_m + point_radius_m + double{margin})) continue;
            const Touch found = touch(solid[c], hexel, point_radius_m);
            if (found.gap_m > margin) continue;
            if (!has_first || found.gap_m < first.gap_m) {
                second = first;
                has_second = has_first;
                first = found;
                has_first = true;
            } else if (!has_second || found.gap_m < second.gap_m) {
                second = found;
                has_second = true;
            }
        }
        auto add = [&](const Touch& t) {
            exchange.contacts.push_back(
                {static_cast<std::int32_t>(k), t.normal, t.gap_m, t.tool_velocity_m_per_s, t.instrument});
        };
        if (has_first) add(first);
        if (has_second && glm::dot(first.normal, second.normal) < kWedgeCosine) add(second);
    }

    exchange.organ_force_N = exchange.grasper_organ_force_N = Vec3(0.0);
    for (const tissue::RigidOrgan& organ : model.organs) {
        exchange.organ_force_N += organ_force_N(*organ.shape, exchange.capsules, tissue::Instrument::hook);
        exchange.grasper_organ_force_N += organ_force_N(*organ.shape, exchange.capsules, tissue::Instrument::grasper);
    }
}

}  // namespace calot::instruments
