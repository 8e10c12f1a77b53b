// Rigid organs round the triangle. Exact distances; make_calots_triangle caches them.

#include <cmath>

#include "calot/anatomy/calots_parts.h"
#include "calot/anatomy/noise.h"
#include "calot/anatomy/shapes.h"
#include "calot/base/units.h"

namespace calot::anatomy {

namespace {

constexpr double mm = kMillimetre;

/// What the laparoscope can see, with room to spare: organs end here.
const Box kSeen{Vec3(-92, -72, -45) * mm, Vec3(78, 84, 40) * mm};

/// Waves of `height_m` on a surface; the distance shrinks so that it stays a bound.
struct Waves {
    double height_m, size_m;
    std::uint32_t seed;
    double operator()(const Vec3& p, double distance) const {
        const double slope = height_m / size_m * kGradientNoiseSlope;
        return (distance + height_m * gradient_noise(p / size_m, seed)) / (1.0 + slope);
    }
};

/// The liver's underside rises from the hilum to its edge in front; the gallbladder lies in a bed on it.
ShapePtr liver(const TriangleLayout& t) {
    const Vec3 low_point = t.liver_point_m, under = t.liver_normal;
    const Vec3 edge_point(0.0, low_point.y + varied(t, 21, 21.0, 27.0) * mm, 20.0 * mm);
    const Vec3 front = glm::normalize(Vec3(varied(t, 22, -0.15, 0.15), 0.36, 0.93));
    const Waves waves{2.2 * mm, 34.0 * mm, static_cast<std::uint32_t>(t.patient.seed) + 1};
    return make_shape(
        [=](const Vec3& p) {
            const double body = smooth_max(glm::dot(p - low_point, under), glm::dot(p - edge_point, front), 13.0 * mm);
            return std::max(waves(p, body), box_distance_m(kSeen, p));
        },
        kSeen);
}

/// The gallbladder's outer face, slightly uneven.
ShapePtr gallbladder(const TriangleLayout& t) {
    const Tube tube(t.gallbladder);
    const Waves waves{0.7 * mm, 13.0 * mm, static_cast<std::uint32_t>(t.patient.seed) + 2};
    const Box bounds{glm::max(tube.bounds_m().low - 1 * mm, kSeen.low),
                     glm::min(tube.bounds_m().high + 1 * mm, kSeen.high)};
    return make_shape([=](const Vec3& p) { return std::max(waves(p, tube.distance_m(p)), box_distance_m(kSeen, p)); },
                      bounds);
}

/// Peritoneum behind the triangle. It covers the bile duct below the junction (the hepatoduodenal ligament's free
/// edge) and the hepatic artery to the right of the common duct: both show as soft ridges.
ShapePtr peritoneum(const TriangleLayout& t) {
    const Vec3 point(0.0, 0.0, t.backdrop_z_m), normal = glm::normalize(Vec3(0.04, 0.10, 1.0));
    const Waves waves{3.0 * mm, 27.0 * mm, static_cast<std::uint32_t>(t.patient.seed) + 3};
    std::vector<TubePoint> bile_duct, artery;
    for (const TubePoint& p : t.common_duct)
        if (p.position_m.y < t.junction_m.y - 7 * mm) bile_duct.push_back({p.position_m, p.radius_m + 1.6 * mm});
    for (const TubePoint& p : t.hepatic_artery)
        if (p.position_m.x > t.junction_m.x + 7 * mm) artery.push_back({p.position_m, p.radius_m + 1.4 * mm});
    const Tube over_duct(bile_duct), over_artery(artery);
    const Box box{kSeen.low, Vec3(kSeen.high.x, 45.0 * mm, 6.0 * mm)};
    return make_shape(
        [=](const Vec3& p) {
            double distance = waves(p, glm::dot(p - point, normal));
            distance = smooth_min(distance, over_duct.distance_m(p), 9.0 * mm);
            distance = smooth_min(distance, over_artery.distance_m(p), 7.0 * mm);
            return std::max(distance, box_distance_m(box, p));
        },
        box);
}

/// Fat of the greater omentum along the lower border of the picture; rigid, far from where one works.
ShapePtr omentum(const TriangleLayout& t) {
    const double y = std::min(-38.0 * mm, t.junction_m.y - 27.0 * mm), z = t.backdrop_z_m;
    const Tube tube(smooth_curve({{Vec3(-80 * mm, y + varied(t, 23, 0, 8) * mm, z), 12 * mm},
                                  {Vec3(-48 * mm, y + varied(t, 24, 0, 7) * mm, z + 1 * mm), 11 * mm},
                                  {Vec3(-22 * mm, y + varied(t, 25, -3, 3) * mm, z + 2 * mm), 10 * mm},
                                  {Vec3(2 * mm, y - 4 * mm, z + 1 * mm), 9 * mm},
                                  {Vec3(16 * mm, y - 9 * mm, z), 8 * mm}},
                                 4));
    const double size = 1.15 * *t.patient.lobule_size_m, height = 1.6 * mm;
    const auto seed = static_cast<std::uint32_t>(t.patient.seed) + 7;
    const Box bounds{glm::max(tube.bounds_m().low - 3 * mm, kSeen.low),
                     glm::min(tube.bounds_m().high + 3 * mm, kSeen.high)};
    return make_shape(
        [=](const Vec3& p) {
            const double body = tube.distance_m(p) -
                                height * (lobule_noise(p / size, seed) + gradient_noise(p / (2.5 * size), seed + 1));
            return std::max(body / (1.0 + height / size * (kLobuleNoiseSlope + 0.4 * kGradientNoiseSlope)),
                            box_distance_m(kSeen, p));
        },
        bounds);
}

ShapePtr duodenum(const TriangleLayout& t) {
    const Vec3 j = t.junction_m;
    const std::vector<TubePoint> axis = smooth_curve({{Vec3(j.x + 62 * mm, -22 * mm, -16 * mm), 13 * mm},
                                                      {Vec3(j.x + 34 * mm, -36 * mm, -10 * mm), 15 * mm},
                                                      {Vec3(j.x + 4 * mm, -50 * mm, -8 * mm), 16 * mm},
                                                      {Vec3(j.x - 32 * mm, -62 * mm, -10 * mm), 15 * mm},
                                                      {Vec3(j.x - 60 * mm, -80 * mm, -12 * mm), 14 * mm}},
                                                     4);
    const Tube tube(axis);
    const Waves waves{1.6 * mm, 12.0 * mm, static_cast<std::uint32_t>(t.patient.seed) + 4};
    const Box bounds{glm::max(tube.bounds_m().low - 2 * mm, kSeen.low),
                     glm::min(tube.bounds_m().high + 2 * mm, kSeen.high)};
    return make_shape([=](const Vec3& p) { return std::max(waves(p, tube.distance_m(p)), box_distance_m(kSeen, p)); },
                      bounds);
}

}  // namespace

std::vector<Organ> make_organs(const TriangleLayout& t) {
    return {{"liver", "liver", true, liver(t)},
            {"gallbladder", "gallbladder_wall", true, gallbladder(t)},
            {"common_duct", "cystic_duct", true, make_clipped(make_tube(t.common_duct), kSeen)},
            {"hepatic_artery", "cystic_artery", true, make_clipped(make_tube(t.hepatic_artery), kSeen)},
            {"peritoneum", "fat", true, peritoneum(t)},
            {"omentum", "fat", false, omentum(t)},
            {"duodenum", "gallbladder_wall", false, duodenum(t)}};
}

}  // namespace calot::anatomy
