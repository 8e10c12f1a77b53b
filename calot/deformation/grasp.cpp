#include "calot/deformation/grasp.h"

#include <algorithm>
#include <cmath>

namespace calot::deformation {

using tissue::GrasperState;
using tissue::Model;
using tissue::State;

namespace {

/// A place that slipped this far past the tips is lost.
constexpr float kPastTips_m = 2e-3f;
/// Tissue this far beside the jaws is still taken.
constexpr double kBeside_m = 1e-3;

Vec3 in_frame(const tissue::Pose& pose, const Vec3& world_m) {
    return glm::conjugate(pose.orientation) * (world_m - pose.position_m);
}
Vec3 in_world(const tissue::Pose& pose, const Vec3& place_m) {
    return pose.position_m + pose.orientation * place_m;
}

bool between_jaws(const JawSpace& space, double jaw, const Vec3& place_m) {
    if (place_m.z < -space.length_m || place_m.z > 0.0) return false;
    const double half_m = space.radius_m + (place_m.z + space.length_m) * std::sin(0.5 * space.opening_rad * jaw);
    return std::fabs(place_m.x) <= half_m && std::fabs(place_m.y) <= space.radius_m + kBeside_m;
}

/// Evenly chosen ones of the surface hexels between the jaws.
void take(GrasperState& grasper, const tissue::Exchange& exchange, const JawSpace& space) {
    const tissue::Pose& pose = exchange.grasper.pose;
    auto for_each_between = [&](const auto& body) {
        std::size_t count = 0;
        for (const tissue::NearHexel& near : exchange.near) {
            const Vec3 place_m = in_frame(pose, Vec3(near.world_m));
            if (between_jaws(space, exchange.grasper.jaw, place_m)) body(count++, near.hexel, place_m);
        }
        return count;
    };
    const std::size_t count = for_each_between([](std::size_t, std::int64_t, const Vec3&) {});
    const std::size_t kept = std::min<std::size_t>(count, tissue::kMostGrasped);
    std::size_t next = 0;
    for_each_between([&](std::size_t k, std::int64_t hexel, const Vec3& place_m) {
        if (next >= kept || k != next * count / kept) return;
        grasper.hexel[next] = hexel;
        grasper.place_m[next++] = Vec3f(place_m);
    });
    grasper.held = static_cast<std::int64_t>(next);
}

template <class Keep>
void keep_only(GrasperState& grasper, const Keep& keep) {
    std::size_t next = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(grasper.held); ++k) {
        if (!keep(k)) continue;
        grasper.hexel[next] = grasper.hexel[k];
        grasper.place_m[next++] = grasper.place_m[k];
    }
    grasper.held = static_cast<std::int64_t>(next);
    for (; next < grasper.hexel.size(); ++next) {  // nothing is left behind: the state is compared as bytes
        grasper.hexel[next] = 0;
        grasper.place_m[next] = Vec3f(0.0f);
    }
}

}  // namespace

void update_grasp(const Model&, State& state, const tissue::Exchange& exchange, const JawSpace& space) {
    GrasperState& grasper = state.grasper;
    const tissue::GrasperInput& now = exchange.grasper;
    if (!now.present || now.jaw > kLetGoJaw) {
        keep_only(grasper, [](std::size_t) { return false; });
        return;
    }
    keep_only(grasper, [&](std::size_t k) {
        return state.hexel_present.test(grasper.hexel[k]) && grasper.place_m[k].z <= kPastTips_m;
    });
    const bool closes = grasper.present != 0 && grasper.jaw > kTakeJaw && now.jaw <= kTakeJaw;
    if (closes && grasper.held == 0) take(grasper, exchange, space);
}

void add_held(const Model& model, const State& state, ContactWork& contact) {
    const GrasperState& grasper = state.grasper;
    for (std::size_t k = 0; k < static_cast<std::size_t>(grasper.held); ++k) {
        if (!state.hexel_present.test(grasper.hexel[k])) continue;
        ContactPoint point;
        point.near = static_cast<std::int32_t>(k);
        point.hexel = grasper.hexel[k];
        point.instrument = tissue::Instrument::grasper;
        point.stiffness_N_per_m = static_cast<float>(kHold_N_per_m / static_cast<double>(grasper.held));
        point.most_force_N = static_cast<float>(kGrip_N / static_cast<double>(grasper.held));
        contact.points.push_back(point);
    }
    static_cast<void>(model);
}

void place_held(const Model& model, const State& state, const tissue::Exchange& exchange, ContactWork& contact) {
    for (std::size_t c = 0; c < contact.points.size(); ++c) {
        ContactPoint& point = contact.points[c];
        if (!point.held()) continue;
        const float* psi = contact.psi.data() + c * static_cast<std::size_t>(contact.stride);
        Vec3f moved_m(0.0f);
        for (std::int32_t row = point.first; row < point.end; ++row) {
            if (psi[row] == 0.0f) continue;
            const auto phyxel = static_cast<std::size_t>(contact.phyxel[static_cast<std::size_t>(row)]);
            moved_m += psi[row] * Vec3f(state.displacement_m[0][phyxel], state.displacement_m[1][phyxel],
                                        state.displacement_m[2][phyxel]);
        }
        place_point(model, state, exchange, moved_m, point);
    }
}

Vec3 away_at_rest_m(const Model& model, const State& state, const ContactPoint& point) {
    const Vec3 place_m(state.grasper.place_m[static_cast<std::size_t>(point.near)]);
    return model.hexels.centre_m(point.hexel) - in_world(state.grasper.pose, place_m);
}

void place_point(const Model& model, const State& state, const tissue::Exchange& exchange, const Vec3f& moved_m,
                 ContactPoint& point) {
    const Vec3 place_m(state.grasper.place_m[static_cast<std::size_t>(point.near)]);
    const Vec3 from = in_world(state.grasper.pose, place_m), to = in_world(exchange.grasper.pose, place_m);
    point.away_m = Vec3f(model.hexels.centre_m(point.hexel) + Vec3(moved_m) - from);
    point.tool_velocity_m_per_s = Vec3f((to - from) / model.tick_s);
}

void slip_held(State& state, const tissue::Exchange& exchange, const ContactWork& contact) {
    for (const ContactPoint& point : contact.points) {
        if (!point.held()) continue;
        const float most_m = point.most_force_N / point.stiffness_N_per_m, away_m = glm::length(point.away_m);
        if (away_m <= most_m) continue;
        const Vec3f slip_m = point.away_m * (1.0f - most_m / away_m);
        state.grasper.place_m[static_cast<std::size_t>(point.near)] +=
            Vec3f(glm::conjugate(exchange.grasper.pose.orientation) * Vec3(slip_m));
    }
}

}  // namespace calot::deformation
