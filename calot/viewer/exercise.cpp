#include "calot/viewer/exercise.h"

namespace calot::viewer {

Exercise free_practice() {
    Exercise exercise;
    exercise.id = "free";
    exercise.name = "exercise.free";
    exercise.about = "exercise.free.about";
    return exercise;
}

const std::vector<Patient>& patients() {
    static const std::vector<Patient> list{
        {1, 1, "patient.slender", {"triangle.fat_thickness_mm=2.4", "triangle.lobule_height_mm=1"}},
        {7, 1, "patient.wide_duct", {"triangle.fat_thickness_mm=2.6", "triangle.duct_diameter_mm=4.5"}},
        {3, 2, "patient.usual", {"triangle.fat_thickness_mm=3.6"}},
        {11, 2, "patient.short_duct", {"triangle.fat_thickness_mm=3.4", "triangle.duct_length_mm=21"}},
        {5, 3, "patient.anterior_artery", {"triangle.fat_thickness_mm=4.5", "triangle.artery_anterior=true"}},
        {13, 3, "patient.double_artery", {"triangle.fat_thickness_mm=5", "triangle.double_artery=true"}},
    };
    return list;
}

const std::vector<Patient>& patients_of(const Exercise& exercise) {
    return exercise.own_patients.empty() ? patients() : exercise.own_patients;
}

}  // namespace calot::viewer
