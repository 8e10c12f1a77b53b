#include "calot/anatomy/calots_triangle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "calot/anatomy/cached.h"
#include "calot/anatomy/calots_parts.h"
#include "calot/anatomy/shapes.h"
#include "calot/base/units.h"

namespace calot::anatomy {

namespace {

constexpr double mm = kMillimetre;

/// Tissue reaches so far into rigid organs, so that no gap shows where they meet: half a standard hexel.
constexpr double kOverlap = 0.3 * mm;

/// The deformable part of a solid: what lies outside the rigid organs.
ShapePtr outside_of(const ShapePtr& solid, const std::vector<Organ>& organs) {
    return make_shape(
        [solid, organs](const Vec3& p) {
            double distance = solid->distance_m(p);
            for (const Organ& organ : organs) distance = std::max(distance, -kOverlap - organ.shape->distance_m(p));
            return distance;
        },
        solid->bounds_m());
}

const Organ& organ_named(const Anatomy& anatomy, const std::string& name) {
    for (const Organ& organ : anatomy.organs)
        if (organ.name == name) return organ;
    assert(false);
    return anatomy.organs[0];
}

/// The first point of `shape` seen from the front (+z) along the line through `p`; NaN where there is none.
Vec3 front_of(const Shape& shape, const Vec3& p) {
    Vec3 q(p.x, p.y, shape.bounds_m().high.z + 1 * mm);
    for (int step = 0; step < 2000 && q.z > shape.bounds_m().low.z; ++step) {
        const double distance = shape.distance_m(q);
        if (distance < 1e-6) return q;
        q.z -= std::max(distance / kDistanceSlack, 1e-6);
    }
    return Vec3(std::numeric_limits<double>::quiet_NaN());
}

/// The stretch of a centre line outside the organs at its ends.
std::vector<TubePoint> free_part(const std::vector<TubePoint>& line, const Shape& a, const Shape& b) {
    std::vector<TubePoint> part;
    for (const TubePoint& p : resample(line, 161))
        if (a.distance_m(p.position_m) > 0.0 && b.distance_m(p.position_m) > 0.0) part.push_back(p);
    return part;
}

/// Fat in front of a tube, over the middle eight tenths of its free part [m].
struct Cover {
    double mean = 0.0, least = 1e9;
};
Cover cover_of(const Shape& fat, const std::vector<TubePoint>& part) {
    Cover cover;
    constexpr int kPlaces = 17;
    for (int k = 0; k < kPlaces; ++k) {
        const TubePoint p = point_at(part, 0.1 + 0.8 * k / (kPlaces - 1));
        const double thickness = front_of(fat, p.position_m).z - (p.position_m.z + p.radius_m);
        cover.mean += thickness / kPlaces;
        cover.least = std::min(cover.least, thickness);
    }
    return cover;
}

void add_landmarks_and_facts(Anatomy& anatomy, const TriangleLayout& t) {
    const Shape& fat = *anatomy.tissues[0].shape;
    const Shape& gallbladder = *organ_named(anatomy, "gallbladder").shape;
    const Shape& common = *organ_named(anatomy, "common_duct").shape;
    const Shape& hepatic = *organ_named(anatomy, "hepatic_artery").shape;
    const std::vector<TubePoint> duct = free_part(t.duct, gallbladder, common);
    const std::vector<TubePoint> artery = free_part(t.arteries[0], gallbladder, hepatic);
    auto& at = anatomy.landmarks_m;
    at["gallbladder_neck"] = t.neck_m;
    at["common_duct"] = t.junction_m;
    at["duct_start"] = duct.front().position_m;
    at["duct_middle"] = point_at(duct, 0.5).position_m;
    at["duct_end"] = duct.back().position_m;
    at["artery_start"] = artery.front().position_m;
    at["artery_middle"] = point_at(artery, 0.5).position_m;
    at["artery_end"] = artery.back().position_m;
    at["triangle"] = 0.5 * (at["duct_middle"] + at["artery_middle"]);
    at["front_of_duct"] = front_of(fat, at["duct_middle"]);
    at["front_of_artery"] = front_of(fat, at["artery_middle"]);
    at["between"] = front_of(fat, at["triangle"]);
    at["fat_window"] = at["between"];
    // The working port below the breastbone: the hook comes from the upper right of the picture, about 45 degrees off
    // the laparoscope's axis, 16 cm from the field.
    at["trocar"] = Vec3(80, 42, 130) * mm;
    at["camera"] = Vec3(-3, -26, 76) * mm;
    at["camera_target"] = Vec3(-3, 3, 0) * mm;

    auto& facts = anatomy.facts;
    for (const TriangleQuantity& q : triangle_quantities()) {
        const bool angle = q.member == &TriangleParameters::duct_angle_rad;
        facts[std::string(q.name) + (angle ? "_deg" : "_mm")] =
            *(t.patient.*q.member) * (angle ? 180.0 / 3.14159265358979323846 : 1e3);
    }
    facts["duct_length_mm"] = length_m(duct) * 1e3;
    facts["artery_length_mm"] = length_m(artery) * 1e3;
    facts["gallbladder_length_mm"] = (length_m(t.gallbladder) + t.gallbladder.back().radius_m) * 1e3;
    const Cover over_duct = cover_of(fat, duct), over_artery = cover_of(fat, artery);
    facts["fat_over_duct_mm"] = over_duct.mean * 1e3;
    facts["fat_over_duct_least_mm"] = over_duct.least * 1e3;
    facts["fat_over_artery_mm"] = over_artery.mean * 1e3;
    facts["fat_over_artery_least_mm"] = over_artery.least * 1e3;
    facts["artery_anterior"] = *t.patient.artery_anterior;
    facts["double_artery"] = *t.patient.double_artery;
    facts["seed"] = static_cast<double>(t.patient.seed);
}

}  // namespace

Anatomy make_calots_triangle(const TriangleParameters& parameters) {
    const TriangleLayout layout = lay_out(draw_triangle(parameters));
    Anatomy anatomy;
    anatomy.organs = make_organs(layout);
    // Large flat organs bear a coarser grid than thin tubes.
    for (Organ& organ : anatomy.organs) {
        const std::string& name = organ.name;
        const double spacing = name == "common_duct" || name == "hepatic_artery" ? 0.8 * mm
                               : name == "gallbladder"                           ? 1.0 * mm
                               : name == "liver" || name == "duodenum"           ? 2.0 * mm
                                                                                 : 1.5 * mm;
        organ.shape = make_cached(organ.shape, spacing);
    }
    std::vector<ShapePtr> arteries;
    for (const auto& artery : layout.arteries) arteries.push_back(make_tube(artery));
    anatomy.tissues = {{"fat", "fat", outside_of(make_fat(layout, anatomy.organs), anatomy.organs)},
                       {"cystic_duct", "cystic_duct", outside_of(make_tube(layout.duct), anatomy.organs)},
                       {"cystic_artery", "cystic_artery",
                        outside_of(arteries.size() == 1 ? arteries[0] : make_union(arteries), anatomy.organs)}};
    // Duct and artery lie within the fat as long as they are free. A small field makes small lattices.
    anatomy.field = tight_bounds_m(*anatomy.tissues[0].shape, 0.6 * mm);
    add_landmarks_and_facts(anatomy, layout);
    return anatomy;
}

}  // namespace calot::anatomy
