// A ball of hexels against the sphere that it was sampled from.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calot/validation/case.h"
#include "calot/validation/surface_bodies.h"

namespace calot::validation {

namespace {

const char* const kSuite = "surface";

double angle_deg(const Vec3& a, const Vec3& b) {
    return std::acos(std::min(1.0, glm::dot(glm::normalize(a), glm::normalize(b)))) * 180.0 / 3.14159265358979;
}

/// Lengths in L, the spacing of hexels.
struct Quality {
    double mean = 0.0, deviation = 0.0, normal_deg = 0.0, volume_share = 0.0;
    bool closed = false;
    Points spread;  ///< radius of each vertex less the mean, against its angle from the pole
};

Quality of_ball(const Options& options, double radius, const Vec3& shift) {
    const int size = static_cast<int>(2.0 * radius) + 6;
    const surface::Body body = surface::ball(size, radius * options.spoil.surface_radius, shift);
    const Vec3 centre_m = body.model.hexels.origin_m + surface::kTestSpacing_m * (Vec3(0.5 * (size - 1)) + shift);
    surface::Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    const surface::Mesh& mesh = surface.rest_mesh();
    Quality q;
    q.closed = surface::check(mesh).closed;
    q.volume_share = surface::volume_m3(mesh) / body.volume_m3();
    double sum = 0.0, squares = 0.0;
    const auto n = static_cast<double>(mesh.position_m.size());
    for (std::size_t v = 0; v < mesh.position_m.size(); ++v) {
        const Vec3 d = (Vec3(mesh.position_m[v]) - centre_m) / surface::kTestSpacing_m;
        sum += glm::length(d);
        squares += glm::dot(d, d);
        q.normal_deg += angle_deg(d, Vec3(mesh.normal[v])) / n;
        if (v % 23 == 0) q.spread.emplace_back(angle_deg(d, Vec3(0, 0, 1)), glm::length(d) - radius);
    }
    q.mean = sum / n;
    q.deviation = std::sqrt(std::max(0.0, squares / n - q.mean * q.mean));
    return q;
}

std::vector<Case> sphere(const Options& options) {
    constexpr double kRadius = 14.0;
    Quality worst;
    double mean_error = 0.0, volume_error = 0.0;
    int open = 0;
    for (const Vec3& shift : {Vec3(0.0), Vec3(0.19, -0.12, 0.43), Vec3(0.31, 0.26, -0.38)}) {
        const Quality q = of_ball(options, kRadius, shift);
        if (q.deviation > worst.deviation) worst.spread = q.spread;
        worst.deviation = std::max(worst.deviation, q.deviation);
        worst.normal_deg = std::max(worst.normal_deg, q.normal_deg);
        mean_error = std::max(mean_error, std::abs(q.mean / kRadius - 1.0));
        volume_error = std::max(volume_error, std::abs(q.volume_share - 1.0));
        open += !q.closed;
    }
    const char* source = "sphere of radius 14 L, three places on the lattice; docs/physics.md, section 7";
    Case noise = below(kSuite, "sphere: deviation of the radius", worst.deviation, "L", 0.09, source);
    noise.figures.push_back({"Radius of the surface's vertices, less 14 L",
                             "angle from the pole, degrees",
                             "L",
                             {{"sphere", {{0.0, 0.0}, {180.0, 0.0}}, false}, {"vertices", worst.spread, true}}});
    Case radius = below(kSuite, "sphere: mean radius", mean_error, "1", 0.01, source);
    Case normals = below(kSuite, "sphere: mean error of normals", worst.normal_deg, "degrees", 5.3, source);
    Case volume = below(kSuite, "sphere: volume against that of its hexels", volume_error, "1", 0.02, source);
    Case closed = below(kSuite, "sphere: meshes that are not closed and manifold", open, "1", 0.0, source);
    return {noise, radius, normals, volume, closed};
}

std::vector<Case> refined_sphere(const Options& options) {
    Points errors;
    for (const double radius : {7.0, 14.0, 28.0})
        errors.emplace_back(2.0 * radius, of_ball(options, radius, Vec3(0.19, -0.12, 0.43)).deviation / radius);
    Case result = below(kSuite, "sphere: roundness", errors[1].second, "1", 0.01,
                        "deviation of the radius over the radius; a staircase has order 1");
    converge(result, errors, 0.9, "cells across the diameter");
    return {result};
}

/// Bodies that burning leaves: single hexels, sheets, cells that touch along edges, random burns.
std::vector<Case> wild_bodies(const Options&) {
    int meshes = 0, open = 0;
    const auto look = [&](const surface::Body& body, const surface::Surface& surface) {
        ++meshes;
        if (body.state.hexel_present.count() > 0) open += !surface::check(surface.rest_mesh()).closed;
    };
    Random random(11);
    for (surface::Body body : {surface::ball(16, 6.5), surface::sheet(Int3(12)), surface::checkerboard(9),
                               surface::noise(Int3(12, 11, 10), 0.4, 3)}) {
        surface::Surface surface(body.model);
        surface.rebuild(body.model, body.state);
        look(body, surface);
        auto left = body.hexels();
        surface::shuffle(left, random);
        for (std::size_t first = 0; first < left.size(); first += 40) {
            const auto last = std::min(left.size(), first + 40);
            body.remove(
                {left.begin() + static_cast<std::ptrdiff_t>(first), left.begin() + static_cast<std::ptrdiff_t>(last)},
                surface);
            look(body, surface);
        }
    }
    Case result = below(kSuite, "burnt bodies: meshes that are not closed and manifold", open, "1", 0.0,
                        "topology: every edge has two triangles, every vertex one fan");
    result.note = fmt::format("of {} meshes while a ball, a sheet, a checkerboard and noise burn away", meshes);
    return {result};
}

}  // namespace

std::vector<Check> surface_checks() {
    return {{kSuite, "sphere", true, sphere},
            {kSuite, "refined sphere", true, refined_sphere},
            {kSuite, "burnt bodies", true, wild_bodies}};
}

}  // namespace calot::validation
