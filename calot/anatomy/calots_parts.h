#pragma once
// Inside of make_calots_triangle: how one patient's parts lie, and the solids made of them.

#include "calot/anatomy/calots_triangle.h"
#include "calot/anatomy/tube.h"

namespace calot::anatomy {

/// Centre lines of one patient and the planes that its organs hang on.
struct TriangleLayout {
    TriangleParameters patient;                    ///< all values set
    Vec3 neck_m{0.0};                              ///< where the duct leaves the gallbladder
    Vec3 junction_m{0.0};                          ///< where it meets the common duct's axis
    std::vector<TubePoint> duct;                   ///< from inside the neck to inside the common duct
    std::vector<std::vector<TubePoint>> arteries;  ///< from inside the hepatic artery to inside the gallbladder
    std::vector<TubePoint> gallbladder;            ///< from the neck to the fundus
    std::vector<TubePoint> common_duct;            ///< from the hilum to behind the duodenum
    std::vector<TubePoint> hepatic_artery;
    Vec3 liver_point_m{0.0}, liver_normal{0.0};  ///< plane of its underside, normal out of the liver
    double backdrop_z_m = 0.0;                   ///< of the peritoneum behind the triangle
};

TriangleLayout lay_out(const TriangleParameters& drawn);

/// The rigid organs of a patient, exact (not cached).
std::vector<Organ> make_organs(const TriangleLayout& layout);

/// The fat with its lobules, clinging to the organs; they are yet to be cut out of it.
ShapePtr make_fat(const TriangleLayout& layout, const std::vector<Organ>& organs);

/// A fixed number for this patient in [low, high], by the name of its use.
double varied(const TriangleLayout& layout, std::uint64_t use, double low, double high);

}  // namespace calot::anatomy
