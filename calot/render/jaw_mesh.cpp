#include "calot/render/jaw_mesh.h"

#include <algorithm>
#include <cmath>

namespace calot::render {

namespace {

constexpr double kTau = 6.283185307179586;
constexpr int kSides = 28, kTeeth = 14, kStations = 8 * kTeeth;
constexpr double kSlimmest = 0.68;    ///< at the tip, of the radius at the hinge
constexpr double kToothDepth = 0.16;  ///< of the radius
constexpr double kToothed = 0.15;     ///< of the length, from the hinge, that has no teeth
constexpr double kCorner = 0.35;      ///< of the inner face: 1 is round, 0 sharp

/// A jaw of radius 1: x inward, y across.
struct Profile {
    double x, y;
};

/// The outline at a share `t` of the length, from the hinge, at an angle from inward.
Profile outline(double t, double angle) {
    const double slim = 1.0 - (1.0 - kSlimmest) * t;
    const double round_at = 0.90;  // the tip is rounded off
    const double past = std::clamp((t - round_at) / (1.0 - round_at), 0.0, 1.0);
    const double end = std::max(0.04, std::sqrt(1.0 - past * past));
    const double cosine = std::cos(angle), sine = std::sin(angle);
    if (cosine <= 0.0) return {slim * end * cosine, slim * end * sine};
    // A tooth rises slowly and falls steeply, towards the hinge.
    const double phase = t * kTeeth - std::floor(t * kTeeth);
    const double toothed = std::clamp((t - kToothed) / 0.05, 0.0, 1.0);
    const double depth = toothed * kToothDepth * (phase < 0.75 ? 1.0 - phase / 0.75 : (phase - 0.75) / 0.25);
    const double across = std::copysign(std::pow(std::abs(sine), kCorner), sine);
    return {end * (1.0 - depth) * std::pow(cosine, kCorner), slim * end * across};
}

}  // namespace

void add_jaw(const Vec3& hinge_m, const Vec3& tip_m, double radius_m, const Vec3& inward, InstrumentMesh& mesh) {
    const Vec3 along = glm::normalize(tip_m - hinge_m);
    const Vec3 x = glm::normalize(inward - glm::dot(inward, along) * along), y = glm::cross(along, x);
    const Vec3 from_m = hinge_m - 0.6 * radius_m * along;  // into the joint
    const double length_m = glm::length(tip_m - from_m) + radius_m;
    const auto place = [&](double t, double angle) {
        const Profile p = outline(std::clamp(t, 0.0, 1.0), angle);
        return from_m + t * length_m * along + radius_m * (p.x * x + p.y * y);
    };
    const auto first = static_cast<std::uint32_t>(mesh.vertex.size());
    const double dt = 0.25 / kStations, da = 0.1 * kTau / kSides;
    for (int station = 0; station <= kStations; ++station) {
        const double t = static_cast<double>(station) / kStations;
        for (int side = 0; side <= kSides; ++side) {
            const double turn = static_cast<double>(side % kSides) / kSides, angle = kTau * turn;
            InstrumentVertex vertex;
            vertex.world_m = Vec3f(place(t, angle));
            const Vec3 lengthwise = place(std::min(1.0, t + dt), angle) - place(std::max(0.0, t - dt), angle);
            const Vec3 around = place(t, angle + da) - place(t, angle - da);
            vertex.normal = Vec3f(glm::normalize(glm::cross(around, lengthwise)));
            vertex.along = Vec3f(along);
            vertex.metal = 1.0f;
            vertex.axial_mm = static_cast<float>(1e3 * t * length_m);
            vertex.around = static_cast<float>(side) / kSides;
            mesh.vertex.push_back(vertex);
        }
    }
    for (std::uint32_t station = 0; station < kStations; ++station)
        for (std::uint32_t side = 0; side < kSides; ++side) {
            const std::uint32_t a = first + station * (kSides + 1) + side, b = a + 1, c = a + kSides + 1, d = c + 1;
            mesh.index.insert(mesh.index.end(), {a, b, c, b, d, c});
        }
    // The end: a fan about the pole.
    const auto pole = static_cast<std::uint32_t>(mesh.vertex.size());
    InstrumentVertex vertex;
    vertex.world_m = Vec3f(from_m + length_m * along);
    vertex.normal = vertex.along = Vec3f(along);
    vertex.metal = 1.0f;
    vertex.axial_mm = static_cast<float>(1e3 * length_m);
    mesh.vertex.push_back(vertex);
    const std::uint32_t last = first + kStations * (kSides + 1);
    for (std::uint32_t side = 0; side < kSides; ++side)
        mesh.index.insert(mesh.index.end(), {last + side, last + side + 1, pole});
}

}  // namespace calot::render
