// Elastic bodies against finite elements and Saint-Venant's torsion.
//
// References are B-bar finite elements of two resolutions, extrapolated (Richardson, second order).

#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "calot/deformation/embedding.h"
#include "calot/validation/closed_forms.h"
#include "calot/validation/elastic_rig.h"
#include "calot/validation/fem.h"
#include "calot/validation/spoil.h"

namespace calot::validation {

namespace {

using deformation::rig::Body;
using deformation::rig::ClampedBox;
using deformation::rig::kSpacing_m;

const char* const kSuite = "deformation";
constexpr double kTolerance = 0.03;  // at 6 cells across
constexpr double kOrder = 1.5;

tissue::Material fat() {
    return tissue::default_materials()[1];
}

/// How the surface cuts the outer cells of a bar: along their faces, or through their middles.
enum class Sides { full, half_full };

/// A bar of fat, so many spacings across and along, held at one end.
tissue::Model bar(int across, int along, Sides sides) {
    if (sides == Sides::full) return deformation::rig::block({across, across, along}, true);
    // A little more than a whole number of spacings takes a cell more, centred; no hexel lies in that little.
    const double wide = (across + 0.02) * kSpacing_m;
    return tissue::sample(anatomy::make_block({.size_m = Vec3(wide, wide, along * kSpacing_m), .held_below = true}),
                          {.hexel_spacing_m = kSpacing_m / 4, .hexels_per_edge = 4});
}

/// With gravity, and a damping that brings it to rest soonest.
Body make_body(const Options& options, tissue::Model plain, const Vec3& gravity, double slowest_rad_per_s) {
    tissue::Model model = spoiled(options, std::move(plain));
    model.deformation.gravity_m_per_s2 = gravity;
    model.deformation.damping_per_s = 2.0 * slowest_rad_per_s;
    return Body(std::move(model));
}
void settle(Body& body, double slowest_rad_per_s) {
    const int ticks = static_cast<int>(12.0 / slowest_rad_per_s / body.model.tick_s);
    for (int k = 0; k < ticks; ++k) body.tick();
}

/// The reference of a box whose cross-section has edge 1: two meshes, extrapolated to none.
class Reference {
  public:
    Reference(const Options& options, const Vec3& size, const Vec3& body_force) {
        const tissue::Material m = fat();
        for (const int n : options.quick ? std::array{4, 8} : std::array{8, 12}) {
            meshes_.push_back(std::make_unique<ClampedBox>(size, Int3(size * static_cast<double>(n)),
                                                           m.youngs_modulus_Pa, m.poisson_ratio, body_force));
            weight_.push_back(static_cast<double>(n * n));
        }
    }
    double displacement_m(const Vec3& at, int axis) const {
        return (weight_[1] * meshes_[1]->displacement_m(at)[axis] - weight_[0] * meshes_[0]->displacement_m(at)[axis]) /
               (weight_[1] - weight_[0]);
    }

  private:
    std::vector<std::unique_ptr<ClampedBox>> meshes_;
    std::vector<double> weight_;
};

/// Mean displacement of each layer of a held body along `axis`, seen and expected; x: height over edge.
struct Layers {
    Points seen, expected;
    double top_seen = 0.0, top_expected = 0.0;
};
Layers layers(const Body& body, const Reference& reference, int axis, Sides sides) {
    const double shaved = sides == Sides::half_full ? kSpacing_m : 0.0;
    const Vec3 size = kSpacing_m * (Vec3(body.model.phyxels.size) - 2.0) - Vec3(shaved, shaved, 0.0);
    const Vec3 corner = body.model.phyxels.centre_m(Int3(1)) - 0.5 * kSpacing_m + 0.5 * Vec3(shaved, shaved, 0.0);
    const auto count = static_cast<std::size_t>(body.model.phyxels.size.z);
    std::vector<double> seen(count), expected(count), number(count);
    body.for_each_phyxel([&](std::int64_t p) {
        const auto z = static_cast<std::size_t>(body.model.phyxels.coordinates(p).z);
        number[z] += 1.0;
        seen[z] += body.displacement_m(p)[axis];
        // One reference for all resolutions: displacements grow as the square of the size.
        const Vec3 at = (body.model.phyxels.centre_m(p) - corner) / size.x;
        expected[z] += size.x * size.x * reference.displacement_m(at, axis);
    });
    Layers out;
    for (std::size_t z = 0; z < count; ++z) {
        if (number[z] == 0.0) continue;
        const double height = (static_cast<double>(z) - 0.5) * kSpacing_m / size.x;
        out.seen.emplace_back(height, seen[z] / number[z] * 1e6);
        out.expected.emplace_back(height, expected[z] / number[z] * 1e6);
    }
    out.top_seen = out.seen.back().second;
    out.top_expected = out.expected.back().second;
    return out;
}

/// A held bar under its own weight; `slowest` gives its lowest frequency for so many cells across.
template <class Slowest>
std::vector<Case> sagging(const Options& options, const std::string& name, int aspect, int axis, double gravity,
                          const std::vector<int>& cells, Sides sides, double least_order, const Slowest& slowest) {
    Vec3 pull(0.0);
    pull[axis] = gravity;
    const Reference reference(options, Vec3(1, 1, aspect), pull * fat().density_kg_per_m3);
    Points errors;
    Case result;
    for (const int n : cells) {
        Body body = make_body(options, bar(n, aspect * n, sides), pull, slowest(n));
        settle(body, slowest(n));
        const Layers at = layers(body, reference, axis, sides);
        errors.emplace_back(n, at.top_seen / at.top_expected - 1.0);
        if (n != 6) continue;
        result = compare(kSuite, name, at.top_seen, at.top_expected, "um", kTolerance,
                         "B-bar finite elements, two meshes, extrapolated");
        result.figures.push_back({name + " at 6 cells across",
                                  "height over edge",
                                  "displacement, um",
                                  {{"finite elements", at.expected, false}, {"Calot", at.seen, true}}});
    }
    result.note = "mean displacement of the layer at the free end, 6 cells across";
    converge(result, errors, least_order, "cells across");
    return {result};
}

std::vector<Case> cantilever(const Options& options) {
    const auto slowest = [](int n) {
        const double length = 4 * n * kSpacing_m;
        return 3.516 * (length / 4 / std::sqrt(12.0)) / (length * length) *
               std::sqrt(fat().youngs_modulus_Pa / fat().density_kg_per_m3);
    };
    const std::vector<int> cells = options.quick ? std::vector<int>{4, 6, 8} : std::vector<int>{4, 6, 8, 12};
    std::vector<Case> cases = sagging(options, "cantilever", 4, 0, 0.02, cells, Sides::full, kOrder, slowest);
    if (!options.quick)
        cases.push_back(sagging(options, "cantilever, outer cells half full", 4, 0, 0.02, {4, 6, 8}, Sides::half_full,
                                kOrder, slowest)
                            .front());
    return cases;
}

std::vector<Case> cube(const Options& options) {
    return sagging(
        options, "cube under gravity", 1, 2, -0.1,
        options.quick ? std::vector<int>{4, 6, 8} : std::vector<int>{4, 6, 8, 12}, Sides::full, 0.0, [](int n) {
            return 0.5 * 1.5708 / (n * kSpacing_m) * std::sqrt(fat().youngs_modulus_Pa / fat().density_kg_per_m3);
        });
}

/// Angle over torque [rad/(N m)] of a free bar whose end layers are turned against each other; they may warp.
double torsion_compliance(const Options& options, int n, int length) {
    const double angle = 1e-3;
    const double slowest =
        std::numbers::pi / (length * kSpacing_m) * std::sqrt(fat().youngs_modulus_Pa / 2.9 / fat().density_kg_per_m3);
    tissue::Model model = spoiled(options, deformation::rig::block({n, n, length}, false, 1));
    model.deformation.damping_per_s = 1.4 * slowest;
    // The ends are put back after every tick: so a tick has to be a substep.
    model.tick_s /= model.deformation.substeps;
    model.deformation.substeps = 1;
    Body body(std::move(model));
    Vec3 middle(0.0);
    double count = 0.0;
    int low = 1 << 30, high = 0;
    body.for_each_phyxel([&](std::int64_t p) {
        middle += body.model.phyxels.centre_m(p);
        count += 1.0;
        low = std::min(low, body.model.phyxels.coordinates(p).z);
        high = std::max(high, body.model.phyxels.coordinates(p).z);
    });
    middle /= count;
    const auto turn = [&](std::int64_t p, double by) {
        const Vec3 r = body.model.phyxels.centre_m(p) - middle;
        const double along = body.displacement_m(p).z;
        body.set_displacement(p, Vec3(-by * r.y, by * r.x, along));
        const double speed = body.velocity_m_per_s(p).z;
        body.set_velocity(p, Vec3(0.0, 0.0, speed));
    };
    const auto hold_ends = [&] {
        body.for_each_phyxel([&](std::int64_t p) {
            const int z = body.model.phyxels.coordinates(p).z;
            if (z == low || z == high) turn(p, z == low ? 0.0 : angle);
        });
        deformation::update_gradients(body.model, body.state, body.work);
    };
    body.for_each_phyxel([&](std::int64_t p) {  // start from a uniform twist
        turn(p, angle * (body.model.phyxels.coordinates(p).z - low) / (high - low));
    });
    deformation::update_gradients(body.model, body.state, body.work);
    const int ticks = static_cast<int>(14.0 / slowest / body.model.tick_s);
    for (int k = 0; k < ticks; ++k) {
        body.tick();
        hold_ends();
    }
    // Only the ends bear forces: U = T angle / 2.
    return angle * angle / (2.0 * deformation::elastic_energy_J(body.model, body.state, body.work));
}

/// The difference of two lengths is free of the ends: d(angle / T) / dL = 1 / (G J).
std::vector<Case> torsion(const Options& options) {
    Points errors;
    Case result;
    const tissue::Material m = fat();
    for (const int n : options.quick ? std::vector<int>{4, 6, 8} : std::vector<int>{4, 6, 8, 12}) {
        const double edge = n * kSpacing_m, shear = m.youngs_modulus_Pa / (2.0 * (1.0 + m.poisson_ratio));
        const double per_length =
            (torsion_compliance(options, n, 4 * n) - torsion_compliance(options, n, 2 * n)) / (2 * n * kSpacing_m);
        const double stiffness = 1.0 / per_length, exact = shear * square_torsion_constant() * std::pow(edge, 4.0);
        errors.emplace_back(n, stiffness / exact - 1.0);
        if (n == 6)
            result = compare(kSuite, "torsion of a square bar", stiffness * 1e6, exact * 1e6, "uN m2", kTolerance,
                             "Saint-Venant: G J, J = 0.1406 edge^4");
    }
    result.note = "from two lengths, so that the ends drop out; 6 cells across";
    converge(result, errors, kOrder, "cells across");
    return {result};
}

constexpr double kBallRadii = 30.0;  ///< radius of the paraboloid over that of the contact: small strains

/// Force [N] of a rigid paraboloid on a block 6 x 6 x 3 contact radii large, held below.
double indent(const Options& options, int cells_per_radius, double depth_in_radii) {
    const int n = cells_per_radius;
    const double radius = n * kSpacing_m, depth = depth_in_radii * radius;
    const double slowest =
        0.5 * std::numbers::pi / (3.0 * radius) * std::sqrt(fat().youngs_modulus_Pa / 2.9 / fat().density_kg_per_m3);
    Body body = make_body(options, deformation::rig::block({6 * n, 6 * n, 3 * n}, true, 1), Vec3(0.0), slowest);
    body.model.contact.friction = 0.0;
    body.model.contact.stiffness_N_per_m = 2e3;
    // Points of contact: the middles of the hexels' upper faces, as many as can ever touch.
    const int top = 3 * n;
    const Vec3 low = body.model.hexels.centre_m(Int3(1, 1, top)),
               high = body.model.hexels.centre_m(Int3(6 * n, 6 * n, top));
    const Vec3 apex = 0.5 * (low + high);
    std::vector<tissue::NearHexel> points;
    for (int y = 1; y <= 6 * n; ++y)
        for (int x = 1; x <= 6 * n; ++x) {
            const Vec3 at = body.model.hexels.centre_m(Int3(x, y, top)) + Vec3(0, 0, 0.5 * kSpacing_m);
            if (std::hypot(at.x - apex.x, at.y - apex.y) > 1.12 * radius) continue;
            tissue::NearHexel near;
            near.hexel = body.model.hexels.index(x, y, top);
            near.rest_m = near.world_m = Vec3f(at);
            points.push_back(near);
        }
    const double surface_z = apex.z + 0.5 * kSpacing_m;
    const int ticks = static_cast<int>(14.0 / slowest / body.model.tick_s);
    std::vector<Vec3f> rest, world(points.size());
    std::vector<std::int64_t> owner;
    for (const tissue::NearHexel& p : points) rest.push_back(p.rest_m), owner.push_back(p.hexel);
    for (int tick = 0; tick < ticks; ++tick) {
        deformation::embed_points(body.model, body.state, body.work, rest, owner, world);
        body.exchange.near.clear();
        body.exchange.contacts.clear();
        for (std::size_t k = 0; k < points.size(); ++k) {
            points[k].world_m = world[k];
            const Vec3 at(world[k]);
            const double r2 = std::pow(at.x - apex.x, 2.0) + std::pow(at.y - apex.y, 2.0);
            const double tool_z = surface_z - depth + r2 / (2.0 * kBallRadii * radius);
            body.exchange.near.push_back(points[k]);
            body.exchange.contacts.push_back(
                {static_cast<std::int32_t>(k), Vec3f(0, 0, -1), static_cast<float>(tool_z - at.z), Vec3f(0.0f)});
        }
        body.tick();
    }
    return body.exchange.contact_force_N.z;
}

std::vector<Case> indentation(const Options& options) {
    const tissue::Material m = fat();
    // Depth at which Hertz's contact has the radius 1: a^2 / R.
    const double depth = 1.0 / kBallRadii;
    const double stiffness = m.youngs_modulus_Pa / (1.0 - m.poisson_ratio * m.poisson_ratio);
    const double hertz = 4.0 / 3.0 * stiffness * std::sqrt(kBallRadii) * std::pow(depth, 1.5);
    Points reference;
    for (const int n : options.quick ? std::vector<int>{3, 4} : std::vector<int>{4, 6}) {
        const ClampedBox box(Vec3(3.0), Int3(3 * n), m.youngs_modulus_Pa, m.poisson_ratio, Vec3(0.0), true);
        reference.emplace_back(n, 4.0 * box.press(kBallRadii, depth, 1.5));
    }
    const double n0 = reference[0].first, n1 = reference[1].first;
    const double converged = (n1 * n1 * reference[1].second - n0 * n0 * reference[0].second) / (n1 * n1 - n0 * n0);
    Points errors;
    Case result;
    for (const int n : options.quick ? std::vector<int>{2, 3, 4} : std::vector<int>{2, 3, 4, 5}) {
        const double radius = n * kSpacing_m, force = indent(options, n, depth) / (radius * radius);
        errors.emplace_back(2 * n, force / converged - 1.0);
        if (n == 3)
            result = compare(kSuite, "indentation by a rigid ball", force, converged, "N/a2", kTolerance,
                             "B-bar finite elements with one-sided contact, two meshes, extrapolated");
    }
    result.note = fmt::format(
        "block 6 x 6 x 3 contact radii, 6 cells across the contact of radius a; Hertz's half-space: {:.0f}", hertz);
    converge(result, errors, 0.0, "cells across the contact");
    return {result};
}

}  // namespace

std::vector<Check> deformation_checks() {
    return {{kSuite, "cantilever", true, cantilever},
            {kSuite, "cube", true, cube},
            {kSuite, "torsion", true, torsion},
            {kSuite, "indentation", true, indentation}};
}

}  // namespace calot::validation
