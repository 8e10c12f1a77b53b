// Where everything lies: centre lines, in millimetres of the world frame, x to the right of the picture, y up, z to
// the laparoscope. Offsets without a source are chosen to look right from the laparoscope.

#include <algorithm>
#include <cmath>

#include "calot/anatomy/calots_parts.h"
#include "calot/base/random.h"
#include "calot/base/units.h"

namespace calot::anatomy {

namespace {

constexpr double mm = kMillimetre;

Vec3 at_mm(double x, double y, double z) {
    return Vec3(x, y, z) * mm;
}

/// Gallbladder: neck, Hartmann's pouch, body, fundus, pulled up and to the left of the picture.
void lay_gallbladder(TriangleLayout& t) {
    const double width = 0.5 * *t.patient.gallbladder_width_m, duct = 0.5 * *t.patient.duct_diameter_m;
    const double pouch = width * varied(t, 1, 0.56, 0.70);
    const Vec3 neck = t.neck_m, body = neck + at_mm(-22.0, 3.0, -1.0);
    double reach = 1.0;  // how far the fundus is beyond the pouch, so that the whole has the drawn length
    for (int turn = 0; turn < 4; ++turn) {
        const std::vector<TubePoint> control{
            {neck, duct + 0.9 * mm},
            {neck + at_mm(-4.0, 1.2, 0.4), duct + 2.6 * mm},
            {neck + at_mm(-12.0, -1.5, 1.0), pouch},
            {body, 0.80 * width},
            {body + reach * at_mm(-13.0, 16.0, -3.0), width},
            {body + reach * at_mm(-25.0, 38.0, -8.0), width},
            {body + reach * at_mm(-32.0, 52.0, -16.0), 0.72 * width},
        };
        t.gallbladder = smooth_curve(control, 5);
        const double length = length_m(t.gallbladder) + t.gallbladder.back().radius_m;
        reach = std::max(0.3, reach + (*t.patient.gallbladder_length_m - length) / (64.0 * mm));
    }
}

void lay_common_duct(TriangleLayout& t) {
    const double radius = 0.5 * *t.patient.common_duct_diameter_m;
    const Vec3 j = t.junction_m;
    const double lean = varied(t, 2, -1.5, 3.0);
    t.common_duct = smooth_curve({{Vec3(j.x + (lean + 1.0) * mm, 44.0 * mm, j.z - 9.0 * mm), 0.85 * radius},
                                  {Vec3(j.x + lean * mm, 22.0 * mm, j.z - 3.5 * mm), 0.92 * radius},
                                  {j + at_mm(0.3 * lean, 8.0, -0.5), radius},
                                  {j, radius},
                                  {j + at_mm(0.5, -14.0, -1.5), 1.05 * radius},
                                  {j + at_mm(2.0, -34.0, -8.0), 1.05 * radius},
                                  {j + at_mm(4.0, -56.0, -16.0), radius}},
                                 4);
}

void lay_hepatic_artery(TriangleLayout& t) {
    // The right hepatic artery passes behind the common hepatic duct, then turns up into the liver.
    const double radius = varied(t, 3, 1.7, 2.1) * mm;
    const double x = t.junction_m.x, z = t.junction_m.z - 0.5 * *t.patient.common_duct_diameter_m - radius - 0.4 * mm;
    t.hepatic_artery = smooth_curve({{Vec3(x + 24 * mm, -6 * mm, z - 13 * mm), 1.2 * radius},
                                     {Vec3(x + 9 * mm, 2 * mm, z - 2.5 * mm), 1.1 * radius},
                                     {Vec3(x, 6.5 * mm, z), radius},
                                     {Vec3(x - 4.5 * mm, 9 * mm, z + 1.5 * mm), radius},
                                     {Vec3(x - 7 * mm, 16 * mm, z + 0.5 * mm), 0.9 * radius},
                                     {Vec3(x - 8 * mm, 30 * mm, z - 4 * mm), 0.8 * radius}},
                                    4);
}

/// The cystic duct, from 3 mm inside the neck to the common duct's axis; `chord` between neck and junction.
void lay_duct(TriangleLayout& t, double chord) {
    const double angle = *t.patient.duct_angle_rad, radius = 0.5 * *t.patient.duct_diameter_m;
    const Vec3 along(std::cos(angle), -std::sin(angle), 0.0), across(std::sin(angle), std::cos(angle), 0.0);
    const Vec3 middle = at_mm(0.0, -0.5 * *t.patient.artery_gap_m / mm, 0.0);
    t.neck_m = middle - 0.5 * chord * along + at_mm(0, 0, 1.2);
    t.junction_m = middle + 0.5 * chord * along + at_mm(0, 0, -4.5);
    const double sway = varied(t, 4, -1.6, 1.6) * mm, sag = varied(t, 5, -1.2, 1.6) * mm;
    const std::vector<TubePoint> course =
        resample(smooth_curve({{t.neck_m - 3.0 * mm * along, radius},
                               {t.neck_m, radius},
                               {middle - 0.22 * chord * along + sway * across + at_mm(0, 0, 0.9), radius},
                               {middle + 0.20 * chord * along - sag * across, radius},
                               {t.junction_m, radius}},
                              8),
                 41);
    // Spiral valve (of Heister): 4 to 10 folds in the first two thirds; outside they show as slight waves of the width
    // and a corkscrew of the axis.
    const double folds = std::floor(varied(t, 6, 5.0, 9.0)), phase = varied(t, 7, 0.0, 6.28);
    t.duct = course;
    for (std::size_t k = 0; k < course.size(); ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(course.size() - 1);
        const double strength = std::clamp(5.0 * share - 0.3, 0.0, 1.0) * std::clamp(4.0 * (0.75 - share), 0.0, 1.0);
        const double turn = 6.2831853 * folds * share / 0.7 + phase;
        t.duct[k].radius_m += 0.08 * radius * strength * std::sin(turn);
        t.duct[k].position_m +=
            0.16 * radius * strength * (std::cos(0.5 * turn) * across + std::sin(0.5 * turn) * Vec3(0, 0, 1));
    }
}

/// Moves what comes nearer to the duct than `gap` away from it.
void keep_clear_of_duct(std::vector<TubePoint>& artery, const std::vector<TubePoint>& duct, double gap) {
    for (TubePoint& a : artery)
        for (const TubePoint& d : duct) {
            const Vec3 off = a.position_m - d.position_m;
            const double distance = glm::length(off), wanted = a.radius_m + d.radius_m + gap;
            if (distance < wanted) a.position_m += (wanted - distance) / std::max(distance, 1e-6) * off;
        }
}

/// The cystic artery from the right hepatic artery, left of the common hepatic duct, to the gallbladder. It mostly
/// runs above the duct and somewhat deeper; the anterior variant crosses in front of the duct onto the pouch.
void lay_arteries(TriangleLayout& t) {
    const double radius = 0.5 * *t.patient.artery_diameter_m, gap = *t.patient.artery_gap_m;
    const bool anterior = *t.patient.artery_anterior;
    const Vec3 origin = point_at(t.hepatic_artery, 0.62).position_m;
    const double y = 0.5 * gap, bow = varied(t, 8, -1.0, 1.5) * mm, wave = varied(t, 9, -1.2, 1.2) * mm;
    const double depth = anterior ? varied(t, 10, 0.5, 1.5) * mm : varied(t, 10, -3.0, -0.8) * mm;
    std::vector<TubePoint> control{{origin, 1.05 * radius},
                                   {Vec3(0.5 * origin.x, y + bow + 0.5 * wave, 0.5 * depth + 0.35 * origin.z), radius},
                                   {Vec3(0.0, y, depth), radius}};
    if (anterior) {
        const TubePoint crossed = point_at(t.duct, 0.22);
        control.push_back({crossed.position_m + Vec3(0, 0, crossed.radius_m + radius + 0.8 * mm), 0.95 * radius});
        control.push_back({t.neck_m + at_mm(-10, -4, 6), 0.85 * radius});
    } else {
        control.push_back({t.neck_m + at_mm(1, 6.5, -1) + Vec3(0, wave, 0), 0.95 * radius});
        control.push_back({t.neck_m + at_mm(-8, 2.5, 0), 0.85 * radius});
    }
    t.arteries.push_back(resample(smooth_curve(control, 8), 33));
    if (*t.patient.double_artery) {
        // The deep branch leaves soon after the origin and runs along the liver bed.
        const TubePoint fork = point_at(t.arteries[0], 0.12);
        const Vec3 middle(0.5 * mm, y + 4.5 * mm, std::min(depth, 0.0) - 4.0 * mm);
        t.arteries.push_back(resample(smooth_curve({{fork.position_m, 0.85 * radius},
                                                    {Vec3(0.5 * (fork.position_m.x + middle.x), y + 3.5 * mm,
                                                          0.5 * (fork.position_m.z + middle.z)),
                                                     0.8 * radius},
                                                    {middle, 0.8 * radius},
                                                    {t.neck_m + at_mm(-8, 10, -4), 0.75 * radius},
                                                    {t.neck_m + at_mm(-20, 9, -3), 0.7 * radius}},
                                                   8),
                                      33));
    }
    for (auto& artery : t.arteries) keep_clear_of_duct(artery, t.duct, 0.4 * mm);
}

/// Length of the duct between the surfaces of neck and common duct.
double free_length_m(const TriangleLayout& t) {
    const Tube neck(t.gallbladder), common(t.common_duct);
    const std::vector<TubePoint> fine = resample(t.duct, 201);
    double length = 0.0;
    for (std::size_t k = 1; k < fine.size(); ++k) {
        const Vec3 p = 0.5 * (fine[k].position_m + fine[k - 1].position_m);
        if (neck.distance_m(p) > 0.0 && common.distance_m(p) > 0.0)
            length += glm::length(fine[k].position_m - fine[k - 1].position_m);
    }
    return length;
}

}  // namespace

double varied(const TriangleLayout& layout, std::uint64_t use, double low, double high) {
    return Random(layout.patient.seed, 2000 + use).uniform(low, high);
}

TriangleLayout lay_out(const TriangleParameters& drawn) {
    TriangleLayout t;
    t.patient = drawn;
    // The chord is adjusted until the free length is the drawn one; it converges by a factor of about 20 a turn.
    double chord = *drawn.duct_length_m;
    for (int turn = 0; turn < 6; ++turn) {
        lay_duct(t, chord);
        lay_gallbladder(t);
        lay_common_duct(t);
        chord += *drawn.duct_length_m - free_length_m(t);
    }
    lay_hepatic_artery(t);
    lay_arteries(t);
    t.liver_point_m = at_mm(0.0, 0.5 * *drawn.artery_gap_m / mm + varied(t, 11, 11.0, 13.5), -8.0);
    const double tilt = varied(t, 12, -0.08, 0.10);
    t.liver_normal = glm::normalize(Vec3(tilt, -0.72, 0.66));
    t.backdrop_z_m = varied(t, 13, -14.5, -13.0) * mm;
    return t;
}

}  // namespace calot::anatomy
