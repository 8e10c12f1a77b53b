#pragma once
// A parametric Calot's triangle: a patient for every seed, made of smooth implicit solids. Calot's triangle lies
// between the cystic duct (below), the common hepatic duct (right in the picture) and the liver (above); the cystic
// artery crosses it, fat fills and hides it.
//
//                 l i v e r  (underside of segments IV and V, above and behind)
//        \  gall  \______________________________________
//         \ bladder \   fat   ___ cystic artery ___/ |  |
//          \  pouch  )_______/                       |  |  common hepatic duct
//           \__neck__)====== cystic duct =======\__  |  |
//                                                  \=|  |
//             peritoneum behind                      |  |  common bile duct

#include <cstdint>
#include <optional>
#include <vector>

#include "calot/anatomy/anatomy.h"

namespace calot::anatomy {

/// A patient: drawn from the seed, except for what is given. Ranges and sources: triangle_quantities().
struct TriangleParameters {
    std::uint64_t seed = 1;
    std::optional<double> duct_length_m{};    ///< cystic duct, from the neck to the common duct
    std::optional<double> duct_diameter_m{};  ///< outer, between the folds of the spiral valve
    std::optional<double> duct_angle_rad{};   ///< of its course below the horizontal of the picture
    std::optional<double> artery_diameter_m{};
    std::optional<double> artery_gap_m{};  ///< height of the artery above the duct in the middle of the triangle
    std::optional<double> common_duct_diameter_m{};
    std::optional<double> gallbladder_length_m{};
    std::optional<double> gallbladder_width_m{};
    std::optional<double> fat_thickness_m{};  ///< in front of the duct, below the lobules
    std::optional<double> lobule_size_m{};
    std::optional<double> lobule_height_m{};
    std::optional<bool> artery_anterior{};  ///< crosses in front of the duct
    std::optional<bool> double_artery{};    ///< a second, deeper branch
};

/// A number of a patient: its range over seeds, the widest range that may be asked for, where both come from.
struct TriangleQuantity {
    const char* name;  ///< "duct_length", ...
    std::optional<double> TriangleParameters::*member;
    double drawn_low, drawn_high;  ///< SI
    double least, most;            ///< SI
    const char* source;
};

const std::vector<TriangleQuantity>& triangle_quantities();

/// All optional values set: what was given, the rest drawn from the seed. Giving one value changes no other. Throws
/// InputError where a given value is out of range.
TriangleParameters draw_triangle(const TriangleParameters& parameters);

/// Tissues: "fat", "cystic_duct", "cystic_artery". Organs: "liver", "gallbladder", "common_duct", "hepatic_artery",
/// "peritoneum", "omentum", "duodenum". Landmarks: "triangle", "fat_window", "duct_start", "duct_middle", "duct_end",
/// "artery_start", "artery_middle", "artery_end", "gallbladder_neck", "common_duct", "front_of_duct",
/// "front_of_artery", "between", "trocar", "camera", "camera_target". Facts: all quantities, measured on the finished
/// solids ("duct_length_mm", "fat_over_duct_mm", "fat_over_duct_least_mm", ...), "artery_anterior", "double_artery".
Anatomy make_calots_triangle(const TriangleParameters& parameters);

}  // namespace calot::anatomy
