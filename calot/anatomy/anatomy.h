#pragma once
// An operating field: deformable tissues, rigid organs, named landmarks.
//
// World frame: metres; origin in the middle of Calot's triangle; +x to the patient's left (right in the usual
// laparoscopic picture), +y cranial (towards the liver, up in the picture), +z anterior (towards the laparoscope).

#include <map>
#include <string>
#include <vector>

#include "calot/anatomy/shape.h"

namespace calot::anatomy {

/// A deformable tissue. Where several overlap, the last in Anatomy::tissues wins.
struct TissueRegion {
    std::string name;      ///< "fat", "cystic_duct", "cystic_artery", ...
    std::string material;  ///< name of a tissue::Material
    ShapePtr shape;
};

/// A rigid organ; see tissue::RigidOrgan.
struct Organ {
    std::string name;
    std::string material;
    bool holds_tissue = true;
    ShapePtr shape;
};

struct Anatomy {
    std::vector<TissueRegion> tissues;
    std::vector<Organ> organs;
    std::map<std::string, Vec3>
        landmarks_m;                      ///< "triangle", "duct_middle", "artery_middle", "fat_window", "trocar", ...
    std::map<std::string, double> facts;  ///< what this patient is like: "duct_length_mm", "artery_anterior" (0/1), ...
    Box field;                            ///< tissue outside this box is not sampled
};

}  // namespace calot::anatomy
