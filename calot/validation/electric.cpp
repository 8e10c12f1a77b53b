// Electrodes against closed forms: point, disc, sphere, a disc on two layers.

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "calot/validation/closed_forms.h"
#include "calot/validation/electric_rig.h"
#include "calot/validation/spoil.h"

namespace calot::validation {

namespace {

using electric::Rig;

const char* const kSuite = "electric";
constexpr double kPi = std::numbers::pi;
constexpr double kResidual = 1e-4;
constexpr double kTolerance = 0.02;  // at 8 cells across

/// Radii of electrodes in cells; tolerances are asked of 4, 8 cells across.
std::vector<int> radii(const Options& options) {
    return options.quick ? std::vector<int>{2, 4, 6} : std::vector<int>{2, 4, 6, 8};
}

/// A block of two tissues whose upper layer is `layer` hexels thick, metal on a disc of its top; 0: one tissue.
Rig layered_rig(const Options& options, int window, int radius, int layer, double upper_S_per_m, double lower_S_per_m) {
    const double s = 0.6e-3;
    const Int3 hexels(window + 16, window + 16, window + 8);
    const Vec3 high = s * Vec3(hexels);
    anatomy::Anatomy anatomy;
    const double cut = layer > 0 ? high.z - layer * s : 0.0;
    anatomy.tissues.push_back({"upper", "fat", anatomy::make_box(Vec3(0.0, 0.0, cut), high)});
    if (layer > 0)
        anatomy.tissues.push_back({"lower", "liver", anatomy::make_box(Vec3(0.0), Vec3(high.x, high.y, cut))});
    anatomy.field = Box{Vec3(0.0), high};
    auto materials = tissue::default_materials();
    materials[tissue::find_material(materials, "fat")].electric_conductivity_S_per_m = upper_S_per_m;
    materials[tissue::find_material(materials, "liver")].electric_conductivity_S_per_m = lower_S_per_m;
    tissue::Model model = tissue::sample(anatomy, {.hexel_spacing_m = s, .hexels_per_edge = 4}, materials);
    model.electric.window_cells = window;
    model.electric.relative_residual = kResidual;
    model.electric.max_iterations = 200;
    Rig rig(spoiled(options, std::move(model)));
    const int middle = 4 + (window + 16) / 2, top = 4 + window + 8 - 1;
    rig.state.field_low = Int3(middle - window / 2, middle - window / 2, 16);
    for (int y = -radius; y < radius; ++y)
        for (int x = -radius; x < radius; ++x)
            if ((x + 0.5) * (x + 0.5) + (y + 0.5) * (y + 0.5) < radius * radius)
                rig.touch({middle + x, middle + y, top});
    return rig;
}

/// A deep block about a ball of metal, `centre` in its middle; its hexels are no tissue, those about it are touched.
struct Buried {
    Rig rig;
    Int3 centre;
    int metal = 0;  ///< hexels
};
Buried buried_rig(const Options& options, int window, double radius, double conductivity_S_per_m) {
    tissue::Model model = electric::full_box(Int3(window + 16), conductivity_S_per_m);
    model.electric.window_cells = window;
    model.electric.relative_residual = kResidual;
    model.electric.max_iterations = 200;
    const Int3 centre(4 + (window + 16) / 2);
    Buried buried{Rig(spoiled(options, std::move(model))), centre};
    Rig& rig = buried.rig;
    rig.state.field_low = centre - window / 2;
    // A ball of less than a hexel is one hexel about its centre; larger ones lie between hexels.
    const double shift = radius < 1.0 ? 0.0 : 0.5;
    const int reach = static_cast<int>(radius) + 2;
    const auto is_metal = [&](const Int3& step) { return glm::length(Vec3(step) + shift) < radius; };
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const Int3 step(x, y, z);
                if (is_metal(step)) {
                    rig.state.hexel_present.clear(rig.model.hexels.index(centre + step));
                    ++buried.metal;
                    continue;
                }
                bool beside = false;
                for (int axis = 0; axis < 3; ++axis)
                    for (const int side : {-1, 1}) {
                        Int3 other = step;
                        other[axis] += side;
                        beside = beside || is_metal(other);
                    }
                if (beside) rig.touch(centre + step);
            }
    return buried;
}

std::vector<Case> point(const Options& options) {
    const double sigma = 0.15;
    Buried buried = buried_rig(options, 48, 0.5, sigma);
    Rig& rig = buried.rig;
    rig.solve();
    const electric::Window& window = rig.work->window;
    const Int3 centre = window.from_hexel(buried.centre);
    const double s = rig.model.hexels.spacing_m, current = 1.0 / rig.resistance_Ohm();
    Points seen, exact, errors;
    for (int r = 2; r <= 18; ++r) {
        const std::size_t at =
            static_cast<std::size_t>(centre.x + r + window.cells * (centre.y + window.cells * centre.z));
        const double phi = static_cast<double>(rig.state.potential[at]), form = current / (4.0 * kPi * sigma * s * r);
        seen.emplace_back(r, phi);
        exact.emplace_back(r, form);
        if (r == 2 || r == 4 || r == 8) errors.emplace_back(r, std::abs(phi / form - 1.0));
    }
    Case result = compare(kSuite, "point electrode: potential at 8 cells", seen[6].second * 1e3, exact[6].second * 1e3,
                          "mV per V", kTolerance, "phi = I / (4 pi sigma r)");
    result.figures.push_back({"Potential about a point electrode",
                              "distance, cells",
                              "share of the electrode's",
                              {{"closed form", exact, false}, {"Calot", seen, true}}});
    result.note = "the current is the solver's own, so this is the field's shape and the far boundary";
    result.order = observed_order(errors);
    return {result};
}

std::vector<Case> disc(const Options& options) {
    const double sigma = 0.025;
    Points errors;
    Case result;
    for (const int radius : radii(options)) {
        Rig rig = layered_rig(options, 12 * radius, radius, 0, sigma, sigma);
        rig.solve();
        const double a = rig.model.hexels.spacing_m * std::sqrt(static_cast<double>(rig.exchange.near.size()) / kPi);
        const double exact = 1.0 / (4.0 * sigma * a);
        errors.emplace_back(2 * radius, rig.resistance_Ohm() / exact - 1.0);
        if (radius == 4)
            result = compare(kSuite, "disc electrode on a half-space", rig.resistance_Ohm(), exact, "Ohm", kTolerance,
                             "R = 1 / (4 sigma a), a from the number of hexels that touch");
    }
    result.note = "8 cells across";
    converge(result, errors, 0.0, "cells across the disc");
    return {result};
}

std::vector<Case> sphere(const Options& options) {
    const double sigma = 0.1;
    Points errors;
    Case result;
    for (const int radius : radii(options)) {
        Buried buried = buried_rig(options, 12 * radius, radius, sigma);
        Rig& rig = buried.rig;
        rig.solve();
        const double a = rig.model.hexels.spacing_m * std::cbrt(3.0 * buried.metal / (4.0 * kPi));
        const double exact = 1.0 / (4.0 * kPi * sigma * a);
        errors.emplace_back(2 * radius, rig.resistance_Ohm() / exact - 1.0);
        if (radius == 4)
            result = compare(kSuite, "buried sphere electrode", rig.resistance_Ohm(), exact, "Ohm", kTolerance,
                             "R = 1 / (4 pi sigma a), a from the number of hexels that are metal");
    }
    result.note = "8 cells across";
    converge(result, errors, 0.0, "cells across the sphere");
    return {result};
}

/// A layer three radii thick. The ratio to the resistance without it is free of the electrode's own error.
std::vector<Case> layered(const Options& options) {
    const int radius = 4, depth = 12, window = 96;
    const double upper = 0.1;
    Rig uniform = layered_rig(options, window, radius, 0, upper, upper);
    uniform.solve();
    std::vector<Case> cases;
    Curve form{"closed form", {}, false}, seen{"Calot", {}, true};
    for (double decade = -2.0; decade <= 2.01; decade += 0.1)
        form.points.emplace_back(std::pow(10.0, decade),
                                 layered_disc_factor(1.0, std::pow(10.0, decade), static_cast<double>(depth) / radius));
    for (const double contrast : {3.0, 1.0 / 3.0}) {
        Rig rig = layered_rig(options, window, radius, depth, upper, upper * contrast);
        rig.solve();
        // A spoilt conductivity cancels in the ratio; the uniform resistance is the disc's case.
        const double ratio = rig.resistance_Ohm() / uniform.resistance_Ohm();
        seen.points.emplace_back(contrast, ratio);
        cases.push_back(compare(kSuite, fmt::format("layered half-space: {:.2g} times as conductive below", contrast),
                                ratio, layered_disc_factor(1.0, contrast, static_cast<double>(depth) / radius), "1",
                                kTolerance, "images of a disc in a layer three radii thick, over R without the layer"));
    }
    cases.front().figures.push_back({"Resistance of a disc on a layer three radii thick",
                                     "conductivity below over that of the layer",
                                     "over that without layer",
                                     {form, seen},
                                     true});
    return cases;
}

/// Current times voltage is the heat plus what flows out.
std::vector<Case> power(const Options& options) {
    tissue::Model model = tissue::sample(anatomy::make_block({.size_m = Vec3(0.024, 0.024, 0.0096)}), {});
    Rig rig(spoiled(options, std::move(model)));
    for (int y = 20; y < 28; ++y)
        for (int x = 23; x < 25; ++x) rig.touch({x, y, 19});
    rig.solve();
    const tissue::GeneratorState& generator = rig.state.generator;
    const double in = rig.work->electrode_conductance_S * generator.voltage_V * generator.voltage_V;
    const tissue::JouleHeat& joule = rig.exchange.joule;
    return {compare(kSuite, "V I against heat and outflow", joule.total_W + joule.outflow_W + joule.wire_W, in, "W",
                    5e-4, "conservation: current out of the metal times voltage")};
}

}  // namespace

std::vector<Check> electric_checks() {
    return {{kSuite, "point electrode", true, point},
            {kSuite, "disc electrode", true, disc},
            {kSuite, "sphere electrode", true, sphere},
            {kSuite, "layered half-space", true, layered},
            {kSuite, "power", true, power}};
}

}  // namespace calot::validation
