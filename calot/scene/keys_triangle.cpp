// The table's patient: what the seed draws, and what a scene may fix instead.

#include <fmt/format.h>

#include "calot/scene/keys_build.h"

// clang-format off: a table, one key after the other
namespace calot::scene {

namespace {

constexpr const char* kAnteriorName = "artery_anterior";
constexpr const char* kDoubleName = "double_artery";

/// A range's end in the file's unit, without the last digits that conversion left.
double rounded(double file_value) {
    return std::stod(fmt::format("{:.6g}", file_value));
}

}  // namespace

Group triangle_group() {
    Group group{"triangle", "The parametric patient, where anatomy.kind = \"calots_triangle\".", {}, {}};
    KeyTable<Scene> t(group);
    for (const anatomy::TriangleQuantity& quantity : anatomy::triangle_quantities()) {
        const bool angle = std::string(quantity.name).find("angle") != std::string::npos;
        const Unit& unit = angle ? kDegree : kMm;
        const std::string name = fmt::format("{}_{}", quantity.name, angle ? "deg" : "mm");
        const std::string documentation =
            fmt::format("Drawn from {:.3g} to {:.3g} {}: {}.", quantity.drawn_low / unit.factor,
                        quantity.drawn_high / unit.factor, unit.name, quantity.source);
        const auto member = quantity.member;
        t.drawn(name.c_str(), unit, rounded(quantity.least / unit.factor), rounded(quantity.most / unit.factor), [=](Scene& s) -> auto& { return s.triangle.*member; },
          documentation.c_str());
    }
    t.drawn_boolean(kAnteriorName, [](Scene& s) -> auto& { return s.triangle.artery_anterior; },
      "Whether the cystic artery crosses in front of the duct.");
    t.drawn_boolean(kDoubleName, [](Scene& s) -> auto& { return s.triangle.double_artery; },
      "Whether there is a second, deeper cystic artery.");
    return group;
}

}  // namespace calot::scene
