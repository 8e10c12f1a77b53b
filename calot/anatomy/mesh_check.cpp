#include "calot/anatomy/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

#include "calot/base/error.h"
#include "calot/base/parallel.h"
#include "calot/base/random.h"

namespace calot::anatomy {

namespace {

struct Edge {
    std::int32_t low, high;  ///< vertices, low < high
    std::int32_t triangle;
    bool forward;  ///< the triangle runs from low to high
};

/// All edges, equal ones beside each other.
std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b});
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
    });
    return edges;
}

/// Calls body(first, last) for each run of equal edges.
template <class Body>
void each_edge(const std::vector<Edge>& edges, const Body& body) {
    for (std::size_t i = 0, j; i < edges.size(); i = j) {
        for (j = i + 1; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j) {
        }
        body(i, j);
    }
}

/// Renames vertices: to[v] is the vertex that v becomes.
void rename_vertices(TriangleMesh& mesh, const std::vector<std::int32_t>& to) {
    for (auto& t : mesh.triangles)
        for (std::int32_t& v : t) v = to[static_cast<std::size_t>(v)];
}

void weld_equal(TriangleMesh& mesh) {
    struct Hash {
        std::size_t operator()(const std::array<std::uint64_t, 3>& k) const {
            return static_cast<std::size_t>(mix64(k[0] ^ mix64(k[1] ^ mix64(k[2]))));
        }
    };
    std::unordered_map<std::array<std::uint64_t, 3>, std::int32_t, Hash> found;
    found.reserve(mesh.vertices_m.size() / 2);
    std::vector<std::int32_t> to(mesh.vertices_m.size());
    std::vector<Vec3> kept;
    for (std::size_t v = 0; v < mesh.vertices_m.size(); ++v) {
        const Vec3 p = mesh.vertices_m[v] + 0.0;  // -0 becomes 0
        std::array<std::uint64_t, 3> key;
        std::memcpy(key.data(), &p, sizeof(key));
        const auto [place, fresh] = found.try_emplace(key, static_cast<std::int32_t>(kept.size()));
        if (fresh) kept.push_back(p);
        to[v] = place->second;
    }
    rename_vertices(mesh, to);
    mesh.vertices_m = std::move(kept);
}

/// Merges vertices of open edges that are nearer than `reach`: cracks between patches.
void weld_cracks(TriangleMesh& mesh, double reach, MeshReport& report) {
    std::vector<bool> open(mesh.vertices_m.size(), false);
    const std::vector<Edge> edges = sorted_edges(mesh);
    each_edge(edges, [&](std::size_t i, std::size_t j) {
        if (j - i == 1)
            open[static_cast<std::size_t>(edges[i].low)] = open[static_cast<std::size_t>(edges[i].high)] = true;
    });
    std::unordered_map<std::uint64_t, std::vector<std::int32_t>> grid;
    auto key_of = [&](const Vec3& cell) {
        std::uint64_t key = 0;
        for (int k = 0; k < 3; ++k) key = mix64(key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[k])));
        return key;
    };
    std::vector<std::int32_t> to(mesh.vertices_m.size());
    std::iota(to.begin(), to.end(), 0);
    for (std::size_t v = 0; v < to.size(); ++v) {
        if (!open[v]) continue;
        const Vec3 p = mesh.vertices_m[v], cell = glm::floor(p / reach);
        std::int32_t nearest = -1;
        double best = reach * reach;
        for (int k = 0; k < 27; ++k) {
            const auto bucket = grid.find(key_of(cell + Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
            if (bucket == grid.end()) continue;
            for (std::int32_t other : bucket->second) {
                const Vec3 off = mesh.vertices_m[static_cast<std::size_t>(other)] - p;
                if (glm::dot(off, off) < best) best = glm::dot(off, off), nearest = other;
            }
        }
        if (nearest >= 0) {
            to[v] = nearest;
            ++report.welded_vertices;
        } else {
            grid[key_of(cell)].push_back(static_cast<std::int32_t>(v));
        }
    }
    if (report.welded_vertices > 0) rename_vertices(mesh, to);
}

void drop_degenerate_and_duplicate(TriangleMesh& mesh, MeshReport& report) {
    auto& triangles = mesh.triangles;
    auto flat = [](const std::array<std::int32_t, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
    const auto kept = std::remove_if(triangles.begin(), triangles.end(), flat);
    report.degenerate_triangles += triangles.end() - kept;
    triangles.erase(kept, triangles.end());
    // Equal sets of corners, whichever way round: of several the first stays.
    std::vector<std::pair<std::array<std::int32_t, 3>, std::int32_t>> keys;
    keys.reserve(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        std::array<std::int32_t, 3> key = triangles[t];
        std::sort(key.begin(), key.end());
        keys.emplace_back(key, static_cast<std::int32_t>(t));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<bool> drop(triangles.size(), false);
    for (std::size_t k = 1; k < keys.size(); ++k)
        if (keys[k].first == keys[k - 1].first) {
            drop[static_cast<std::size_t>(keys[k].second)] = true;
            ++report.duplicate_triangles;
        }
    std::size_t out = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (!drop[t]) triangles[out++] = triangles[t];
    triangles.resize(out);
}

std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t a) {
    while (parent[static_cast<std::size_t>(a)] != a) {
        parent[static_cast<std::size_t>(a)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(a)])];
        a = parent[static_cast<std::size_t>(a)];
    }
    return a;
}

double area_of(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& t) {
    const Vec3 &a = mesh.vertices_m[t[0]], &b = mesh.vertices_m[t[1]], &c = mesh.vertices_m[t[2]];
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

}  // namespace

void weld(TriangleMesh& mesh, MeshReport& report) {
    if (mesh.triangles.empty())
        throw InputError(report.path, 0, 0, "the mesh has no triangles",
                         "points and lines are no solid; export its faces");
    std::int64_t broken = 0;
    for (const Vec3& p : mesh.vertices_m) {
        // 10 km: beyond that squares of areas lose their digits, and it is no operating field.
        const bool sound = std::abs(p.x) < 1e4 && std::abs(p.y) < 1e4 && std::abs(p.z) < 1e4;
        if (!sound && ++broken == 1)
            report.notes.push_back(
                fmt::format("vertex {} is ({}, {}, {})", &p - mesh.vertices_m.data(), p.x, p.y, p.z));
    }
    if (broken > 0)
        throw InputError(report.path, 0, 0,
                         fmt::format("{} of {} vertices are not finite numbers or lie beyond 10 km; the first: {}",
                                     broken, mesh.vertices_m.size(), report.notes.back()),
                         "export the mesh again; check the unit");
    Box& box = report.bounds_m;
    box = Box{mesh.vertices_m[mesh.triangles[0][0]], mesh.vertices_m[mesh.triangles[0][0]]};
    for (const auto& t : mesh.triangles)
        for (std::int32_t v : t) {
            box.low = glm::min(box.low, mesh.vertices_m[v]);
            box.high = glm::max(box.high, mesh.vertices_m[v]);
        }
    weld_equal(mesh);
    drop_degenerate_and_duplicate(mesh, report);
    const double size = glm::length(box.high - box.low);
    if (size > 0.0) weld_cracks(mesh, 1e-5 * size, report);
    if (report.welded_vertices > 0) drop_degenerate_and_duplicate(mesh, report);
    if (mesh.triangles.empty())
        throw InputError(report.path, 0, 0, fmt::format("all {} triangles are degenerate", report.degenerate_triangles),
                         "export the mesh again");
    report.vertices = static_cast<std::int64_t>(mesh.vertices_m.size());
    report.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    if (report.degenerate_triangles > 0)
        report.notes.push_back(fmt::format("{} degenerate triangles: left out", report.degenerate_triangles));
    if (report.duplicate_triangles > 0)
        report.notes.push_back(fmt::format("{} triangles that repeat others: left out", report.duplicate_triangles));
    if (report.welded_vertices > 0)
        report.notes.push_back(
            fmt::format("{} vertices along cracks: merged with their neighbours", report.welded_vertices));
}

void check_edges(TriangleMesh& mesh, MeshReport& report) {
    const std::vector<Edge> edges = sorted_edges(mesh);
    auto middle = [&](const Edge& e) { return 0.5 * (mesh.vertices_m[e.low] + mesh.vertices_m[e.high]); };
    // Neighbours over an edge that two triangles share, and whether they run along it the same way (one is flipped).
    struct Neighbour {
        std::int32_t triangle = -1;
        bool against = false;
    };
    std::vector<std::array<Neighbour, 3>> neighbours(mesh.triangles.size());
    std::vector<std::uint8_t> degree(mesh.triangles.size(), 0);
    each_edge(edges, [&](std::size_t i, std::size_t j) {
        const Edge &a = edges[i], &b = edges[j - 1];
        if (j - i == 1) {
            add_place(report, MeshFault::open_edge, middle(a), ++report.open_edges);
        } else if (j - i > 2) {
            add_place(report, MeshFault::nonmanifold_edge, middle(a), ++report.nonmanifold_edges);
        } else {
            const bool against = a.forward == b.forward;
            if (against) add_place(report, MeshFault::flipped_edge, middle(a), ++report.flipped_edges);
            neighbours[a.triangle][degree[a.triangle]++] = {b.triangle, against};
            neighbours[b.triangle][degree[b.triangle]++] = {a.triangle, against};
        }
    });
    if (report.flipped_edges == 0) return;
    // Flood each patch; `turned` is relative to its first triangle.
    std::vector<std::int8_t> turned(mesh.triangles.size(), -1);
    std::vector<std::int32_t> patch;
    for (std::size_t start = 0; start < turned.size(); ++start) {
        if (turned[start] >= 0) continue;
        patch.assign(1, static_cast<std::int32_t>(start));
        turned[start] = 0;
        double area[2] = {0.0, 0.0};
        for (std::size_t k = 0; k < patch.size(); ++k) {
            const std::int32_t t = patch[k];
            area[turned[t]] += area_of(mesh, mesh.triangles[t]);
            for (const Neighbour& n : neighbours[t])
                if (n.triangle >= 0 && turned[n.triangle] < 0) {
                    turned[n.triangle] = static_cast<std::int8_t>(turned[t] ^ (n.against ? 1 : 0));
                    patch.push_back(n.triangle);
                }
        }
        const std::int8_t minority = area[1] <= area[0] ? 1 : 0;
        for (std::int32_t t : patch)
            if (turned[t] == minority && area[minority] > 0.0) {
                std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
                ++report.turned_triangles;
            }
    }
    report.notes.push_back(fmt::format("{} edges between triangles of opposite winding: {} triangles turned",
                                       report.flipped_edges, report.turned_triangles));
}

std::vector<std::int32_t> find_components(const TriangleMesh& mesh, MeshReport& report) {
    std::vector<std::int32_t> parent(mesh.vertices_m.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 1; k < 3; ++k) {
            const std::int32_t a = root_of(parent, t[0]), b = root_of(parent, t[k]);
            parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
    std::vector<std::int32_t> number(mesh.vertices_m.size(), -1), component;
    for (const auto& t : mesh.triangles) {
        std::int32_t& n = number[static_cast<std::size_t>(root_of(parent, t[0]))];
        if (n < 0) n = static_cast<std::int32_t>(report.components++);
        component.push_back(n);
    }
    return component;
}

bool triangles_cross(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
    // Two triangles cross when an edge of one passes through the other.
    auto pierces = [](const std::array<Vec3, 3>& edges, const std::array<Vec3, 3>& face) {
        const Vec3 normal = glm::cross(face[1] - face[0], face[2] - face[0]);
        const double scale = glm::length(normal);
        if (scale == 0.0) return false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &p = edges[k], &q = edges[(k + 1) % 3];
            const double dp = glm::dot(normal, p - face[0]) / scale, dq = glm::dot(normal, q - face[0]) / scale;
            const double tiny = 1e-9 * (std::abs(dp) + std::abs(dq) + glm::length(q - p));
            if (dp * dq >= 0.0 || std::abs(dp) < tiny || std::abs(dq) < tiny) continue;
            const Vec3 x = p + dp / (dp - dq) * (q - p);
            bool inside = true;
            for (std::size_t e = 0; e < 3 && inside; ++e)
                inside = glm::dot(normal, glm::cross(face[(e + 1) % 3] - face[e], x - face[e])) > 1e-12 * scale * scale;
            if (inside) return true;
        }
        return false;
    };
    return pierces(a, b) || pierces(b, a);
}

void count_self_intersections(const MeshTree& tree, MeshReport& report) {
    const TriangleMesh& mesh = tree.mesh();
    constexpr std::int64_t kChunk = 2048;
    constexpr std::int64_t kMostTests = 400'000;  // pairs looked at per chunk: tangles must not take quadratic time
    const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
    struct Found {
        std::int64_t count = 0;
        bool complete = true;
        std::vector<Vec3> places;
    };
    std::vector<Found> found(static_cast<std::size_t>((triangles + kChunk - 1) / kChunk));
    auto corners = [&](const std::array<std::int32_t, 3>& t) {
        return std::array<Vec3, 3>{mesh.vertices_m[t[0]], mesh.vertices_m[t[1]], mesh.vertices_m[t[2]]};
    };
    auto share_corner = [](const std::array<std::int32_t, 3>& a, const std::array<std::int32_t, 3>& b) {
        for (std::int32_t v : a)
            if (v == b[0] || v == b[1] || v == b[2]) return true;
        return false;
    };
    parallel_for("anatomy.self_intersections", 0, triangles, kChunk, [&](std::int64_t begin, std::int64_t end) {
        Found& mine = found[static_cast<std::size_t>(begin / kChunk)];
        std::int64_t tests = 0;
        for (auto i = static_cast<std::int32_t>(begin); i < end && mine.complete; ++i) {
            const auto& t = mesh.triangles[static_cast<std::size_t>(i)];
            const std::array<Vec3, 3> a = corners(t);
            const Box box{glm::min(a[0], glm::min(a[1], a[2])), glm::max(a[0], glm::max(a[1], a[2]))};
            tree.overlapping(box, [&](std::int32_t j) {
                if (j <= i || share_corner(t, mesh.triangles[static_cast<std::size_t>(j)])) return true;
                const std::array<Vec3, 3> b = corners(mesh.triangles[static_cast<std::size_t>(j)]);
                mine.complete = ++tests <= kMostTests;
                if (triangles_cross(a, b) && ++mine.count <= 256) mine.places.push_back((a[0] + a[1] + a[2]) / 3.0);
                return mine.complete;
            });
        }
    });
    std::int64_t places = 0;
    for (const Found& f : found) {
        report.self_intersections += f.count;
        report.self_intersections_complete = report.self_intersections_complete && f.complete;
        for (const Vec3& p : f.places) add_place(report, MeshFault::self_intersection, p, ++places);
    }
}

double signed_cone_m3(const TriangleMesh& mesh, std::size_t triangle, const Vec3& origin) {
    const auto& t = mesh.triangles[triangle];
    const Vec3 &a = mesh.vertices_m[t[0]], &b = mesh.vertices_m[t[1]], &c = mesh.vertices_m[t[2]];
    return glm::dot(a - origin, glm::cross(b - origin, c - origin)) / 6.0;
}

}  // namespace calot::anatomy
