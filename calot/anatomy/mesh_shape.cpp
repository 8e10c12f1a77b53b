#include "calot/anatomy/mesh_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calot/anatomy/mesh_check.h"
#include "calot/anatomy/mesh_tree.h"
#include "calot/base/error.h"
#include "calot/base/parallel.h"
#include "calot/base/random.h"

namespace calot::anatomy {

namespace {

/// Winding numbers nearer to 1/2 than this do not tell inside from outside. Closed meshes have whole numbers, to the
/// 0.06 of the far field.
constexpr double kUnclear = 0.3;
/// Refused beyond this share of unclear points. A sphere that lost a cap of 5 % of its surface has 0.10, 8 % 0.17, half
/// of it 0.75; 10 % of its triangles at random 0.02, 20 % 0.67.
constexpr double kMostUnclear = 0.15;
/// Refused beyond this share of the solid that is inside out.
constexpr double kMostInsideOut = 0.05;
/// Refused beyond so many open edges for each triangle. A closed mesh that lost 5 % of its triangles at random has
/// 0.15.
constexpr double kMostOpenEdges = 1.5;
/// Cells of the survey along the longest side of the mesh.
constexpr double kSurveyCells = 36.0;
/// Refused below this volume over (area times size): a sheet.
constexpr double kLeastThickness = 1e-6;

class MeshShape final : public Shape {
  public:
    MeshShape(std::shared_ptr<const MeshTree> tree, const Box& bounds_m) : tree_(std::move(tree)), bounds_(bounds_m) {}
    double distance_m(const Vec3& position_m) const override {
        const double distance = tree_->nearest(position_m).distance_m;
        const bool inside = box_holds(position_m) && tree_->winding(position_m) > 0.5;
        return inside ? -distance : distance;
    }
    Box bounds_m() const override { return bounds_; }

  private:
    bool box_holds(const Vec3& p) const {
        return glm::all(glm::greaterThanEqual(p, bounds_.low)) && glm::all(glm::lessThanEqual(p, bounds_.high));
    }
    std::shared_ptr<const MeshTree> tree_;
    Box bounds_;
};

Vec3 area_normal(const TriangleMesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Vec3 &a = mesh.vertices_m[t[0]], &b = mesh.vertices_m[t[1]], &c = mesh.vertices_m[t[2]];
    return 0.5 * glm::cross(b - a, c - a);
}
Vec3 centroid(const TriangleMesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    return (mesh.vertices_m[t[0]] + mesh.vertices_m[t[1]] + mesh.vertices_m[t[2]]) / 3.0;
}

/// Mean of the winding numbers on both sides of a component's largest faces: 1/2 for a solid's surface and for the
/// shell of a cavity, -1/2 when it is inside out, 3/2 and more when it lies within another.
std::vector<double> component_windings(const TriangleMesh& mesh, const MeshTree& tree, double size,
                                       const std::vector<std::int32_t>& component, std::int64_t components) {
    constexpr std::size_t kMostLooked = 5000;  // more pieces are a soup, which the survey judges as a whole
    constexpr std::size_t kVotes = 9;          // of the largest faces of each
    std::vector<std::vector<std::pair<double, std::int32_t>>> faces(static_cast<std::size_t>(components));
    for (std::size_t t = 0; t < component.size(); ++t)
        faces[static_cast<std::size_t>(component[t])].emplace_back(-glm::length(area_normal(mesh, t)),
                                                                   static_cast<std::int32_t>(t));
    std::vector<double> mean(faces.size(), 0.5);
    for (std::size_t c = 0; c < std::min(faces.size(), kMostLooked); ++c) {
        auto& mine = faces[c];
        const std::size_t votes = std::min(kVotes, mine.size());
        std::partial_sort(mine.begin(), mine.begin() + static_cast<std::ptrdiff_t>(votes), mine.end());
        double sum = 0.0;
        int counted = 0;
        for (std::size_t k = 0; k < votes; ++k) {
            const Vec3 normal = area_normal(mesh, mine[k].second), at = centroid(mesh, mine[k].second);
            const double area = glm::length(normal);
            if (area == 0.0) continue;
            const Vec3 step = std::min(1e-4 * size, 0.1 * std::sqrt(area)) / area * normal;
            sum += 0.5 * (tree.winding(at - step) + tree.winding(at + step));
            ++counted;
        }
        if (counted > 0) mean[c] = sum / counted;
    }
    return mean;
}

/// Turns components that are inside out; returns whether any was. Sets the volume as a sum over the components that do
/// not lie within others: right when everything is closed and nothing crosses.
bool turn_components(TriangleMesh& mesh, const MeshTree& tree, double size, MeshReport& report) {
    const std::vector<std::int32_t> component = find_components(mesh, report);
    const std::vector<double> winding = component_windings(mesh, tree, size, component, report.components);
    std::int64_t nested = 0;
    for (double w : winding) {
        report.turned_components += w < -0.25;
        nested += w > 1.0;
    }
    const Vec3 origin = mesh.vertices_m[mesh.triangles[0][0]];
    for (std::size_t t = 0; t < component.size(); ++t) {
        const double w = winding[static_cast<std::size_t>(component[t])];
        if (w < -0.25) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        if (w <= 1.0) report.volume_m3 += signed_cone_m3(mesh, t, origin);
    }
    if (report.turned_components > 0)
        report.notes.push_back(
            fmt::format("{} of {} components are wound inwards: turned", report.turned_components, report.components));
    if (nested > 0)
        report.notes.push_back(
            fmt::format("{} of {} components lie within others: they bound nothing", nested, report.components));
    return report.turned_components > 0;
}

/// What winding numbers say at points all over the box and along the surface.
struct Survey {
    std::int64_t near_surface = 0, unclear = 0;  ///< unclear ones count wherever they are: they lie in the holes
    std::int64_t inside = 0, inside_out = 0, points = 0;
    double worst = -1.0;
    Vec3 worst_place{0.0};  ///< unclear and farthest from any triangle: in the middle of the largest hole
    std::vector<Vec3> places;

    void add(const Survey& other) {
        near_surface += other.near_surface, unclear += other.unclear;
        inside += other.inside, inside_out += other.inside_out, points += other.points;
        if (other.worst > worst) worst = other.worst, worst_place = other.worst_place;
        places.insert(places.end(), other.places.begin(), other.places.end());
    }
    double unclear_share() const {
        return unclear == 0 ? 0.0 : static_cast<double>(unclear) / static_cast<double>(near_surface + unclear);
    }
};

/// Asks at `count` points, in chunks of fixed size.
template <class PointOf>
Survey survey(const MeshTree& tree, std::int64_t count, double reach, const PointOf& point_of) {
    constexpr std::int64_t kChunk = 256;
    std::vector<Survey> parts(static_cast<std::size_t>((count + kChunk - 1) / kChunk));
    parallel_for("anatomy.survey", 0, count, kChunk, [&](std::int64_t begin, std::int64_t end) {
        Survey& mine = parts[static_cast<std::size_t>(begin / kChunk)];
        for (std::int64_t k = begin; k < end; ++k) {
            const Vec3 p = point_of(k);
            const double winding = tree.winding(p);
            const bool unclear = std::abs(winding - 0.5) < kUnclear;
            ++mine.points;
            mine.inside += winding > 0.5;
            mine.inside_out += winding < -0.5;
            mine.unclear += unclear;
            if (!unclear) {
                mine.near_surface += tree.any_in(Box{p - reach, p + reach});
                continue;
            }
            const double distance = tree.nearest(p).distance_m;
            mine.places.push_back(p);
            if (distance > mine.worst) mine.worst = distance, mine.worst_place = p;
        }
    });
    Survey all;
    for (const Survey& part : parts) all.add(part);
    return all;
}

/// One point at random in each cell of a grid over the box.
Survey survey_box(const MeshTree& tree, const Box& box) {
    const Vec3 extent = box.high - box.low;
    const double cell = std::max({extent.x, extent.y, extent.z}) / kSurveyCells;
    const Int3 size = glm::max(Int3(glm::ceil(extent / cell)), 1) + 2;
    return survey(tree, std::int64_t{size.x} * size.y * size.z, 0.6 * cell, [=](std::int64_t k) {
        Random random(17, static_cast<std::uint64_t>(k));
        const Vec3 place(static_cast<double>(k % size.x), static_cast<double>(k / size.x % size.y),
                         static_cast<double>(k / size.x / size.y));
        return box.low + cell * (place - 1.0 + Vec3(random.uniform(), random.uniform(), random.uniform()));
    });
}

/// Points on both sides of the surface, spread evenly over its area.
Survey survey_surface(const MeshTree& tree, double step) {
    const TriangleMesh& mesh = tree.mesh();
    std::vector<double> sum(mesh.triangles.size());
    double area = 0.0;
    for (std::size_t t = 0; t < sum.size(); ++t) sum[t] = area += glm::length(area_normal(mesh, t));
    constexpr std::int64_t kPlaces = 4096;
    return survey(tree, 2 * kPlaces, 2.0 * step, [&](std::int64_t k) {
        Random random(19, static_cast<std::uint64_t>(k / 2));
        const double at = (static_cast<double>(k / 2) + random.uniform()) / kPlaces * area;
        const auto t = static_cast<std::size_t>(std::min<std::ptrdiff_t>(
            std::upper_bound(sum.begin(), sum.end(), at) - sum.begin(), static_cast<std::ptrdiff_t>(sum.size()) - 1));
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const auto& corner = mesh.triangles[t];
        const Vec3 &a = mesh.vertices_m[corner[0]], &b = mesh.vertices_m[corner[1]], &c = mesh.vertices_m[corner[2]];
        const Vec3 normal = area_normal(mesh, t);
        const double length = glm::length(normal);
        return a + u * (b - a) + v * (c - a) + (length > 0.0 ? (k % 2 == 0 ? step : -step) / length : 0.0) * normal;
    });
}

std::string place_text(const Vec3& p) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", p.x * 1e3, p.y * 1e3, p.z * 1e3);
}

std::string counts_text(const MeshReport& r) {
    return fmt::format(
        "{} triangles, {} components, {} open edges, {} non-manifold edges, {} flipped edges, {}{} self-intersections",
        r.triangles, r.components, r.open_edges, r.nonmanifold_edges, r.flipped_edges,
        r.self_intersections_complete ? "" : "at least ", r.self_intersections);
}

[[noreturn]] void refuse(const MeshReport& report, const std::string& what, const std::string& hint) {
    throw InputError(report.path, 0, 0, what + " (" + counts_text(report) + ")", hint);
}

/// Refuses the mesh where the winding number does not tell inside from outside.
void judge_windings(const MeshTree& tree, double size, MeshReport& report) {
    const Survey box = survey_box(tree, report.bounds_m), surface = survey_surface(tree, 1e-3 * size);
    const Survey& worse = box.unclear_share() > surface.unclear_share() ? box : surface;
    report.unclear_share = worse.unclear_share();
    std::int64_t places = 0;
    for (const Survey* part : {&box, &surface})
        for (const Vec3& p : part->places) add_place(report, MeshFault::unclear, p, ++places);
    if (report.unclear_share > kMostUnclear)
        refuse(report,
               fmt::format(
                   "inside and outside cannot be told apart at {:.0f} % of the points along the surface, worst at {}",
                   100.0 * report.unclear_share, place_text(worse.worst_place)),
               "close the holes of the mesh, or turn its faces to one side, in a mesh editor");
    const std::int64_t inside = box.inside + surface.inside, inside_out = box.inside_out + surface.inside_out;
    if (static_cast<double>(inside_out) > kMostInsideOut * static_cast<double>(inside + inside_out))
        refuse(report, "part of the mesh is inside out and cannot be turned on its own",
               "recalculate the normals to point outwards in a mesh editor");
    if (inside == 0) refuse(report, "the mesh encloses no volume", "a solid is needed: give the sheet a thickness");
    // Parts that overlap or are open: the share of the survey's points that lie inside.
    const Vec3 extent = report.bounds_m.high - report.bounds_m.low;
    report.volume_m3 =
        static_cast<double>(box.inside) * std::pow(std::max({extent.x, extent.y, extent.z}) / kSurveyCells, 3);
}

/// Accepts the mesh, with notes on what its faults mean, or refuses it.
void judge(const MeshTree& tree, double size, MeshReport& report) {
    const TriangleMesh& mesh = tree.mesh();
    double area = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += glm::length(area_normal(mesh, t));
    const bool closed = report.open_edges == 0 && report.nonmanifold_edges == 0;
    if (!(area > 0.0) || (closed && std::abs(report.volume_m3) < kLeastThickness * area * size))
        refuse(report, fmt::format("the mesh encloses no volume ({:.3g} mm^3)", report.volume_m3 * 1e9),
               "a solid is needed: give the sheet a thickness");
    if (!report.self_intersections_complete)
        refuse(report, "the triangles are so tangled that checking was cut short", "remesh it in a mesh editor");
    // Few triangles are surveyed whatever they are; many loose ones would take too long.
    if (report.triangles > 2000 &&
        static_cast<double>(report.open_edges) > kMostOpenEdges * static_cast<double>(report.triangles))
        refuse(report, "the triangles do not hang together",
               "merge vertices that lie at the same place, in a mesh editor");
    // Closed surfaces that do not cross have whole winding numbers everywhere.
    if (!closed || report.self_intersections > 0 || !report.self_intersections_complete)
        judge_windings(tree, size, report);

    if (report.open_edges > 0)
        report.notes.push_back(
            fmt::format("{} open edges: the holes are closed by the winding number, unclear at {:.2g} % of the "
                        "points along the surface",
                        report.open_edges, 100.0 * report.unclear_share));
    if (report.nonmanifold_edges > 0)
        report.notes.push_back(
            fmt::format("{} edges shared by more than two triangles: the winding number tells inside from outside",
                        report.nonmanifold_edges));
    if (report.self_intersections > 0)
        report.notes.push_back(fmt::format("{} pairs of triangles cross: where parts overlap they count as one",
                                           report.self_intersections));
    if (size > 1.0 || size < 1e-3)
        report.notes.push_back(fmt::format("the mesh is {:.3g} mm across: is its unit right?", size * 1e3));
}

}  // namespace

ShapePtr make_mesh_shape(TriangleMesh mesh, MeshReport& report) {
    weld(mesh, report);
    check_edges(mesh, report);
    const double size = glm::length(report.bounds_m.high - report.bounds_m.low);
    auto tree = std::make_shared<const MeshTree>(std::make_shared<const TriangleMesh>(mesh));
    if (turn_components(mesh, *tree, size, report))
        tree = std::make_shared<const MeshTree>(std::make_shared<const TriangleMesh>(std::move(mesh)));
    report.mesh = std::shared_ptr<const TriangleMesh>(tree, &tree->mesh());
    count_self_intersections(*tree, report);
    judge(*tree, size, report);
    return std::make_shared<MeshShape>(tree, report.bounds_m);
}

ShapePtr load_mesh(const MeshImport& import, MeshReport* report) {
    MeshReport own;
    MeshReport& mine = report != nullptr ? *report : own;
    mine = MeshReport{};
    mine.path = import.path;
    return make_mesh_shape(read_mesh(import), mine);
}

}  // namespace calot::anatomy
