#include "calot/anatomy/mesh_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace calot::anatomy {

namespace {

constexpr int kLeaf = 4;
constexpr double kFar = 2.2;  // groups farther than this many radii are dipoles (Barill et al. take 2)
constexpr double kInverse4Pi = 0.0795774715459476679;

/// Squared distance from p to a triangle (Ericson, Real-Time Collision Detection, section 5.1.5).
double square_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    auto square = [](const Vec3& v) { return glm::dot(v, v); };
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return square(ap);
    const Vec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return square(bp);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return square(ap - (d1 - d3 > 0.0 ? d1 / (d1 - d3) : 0.0) * ab);
    const Vec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return square(cp);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return square(ap - (d2 - d6 > 0.0 ? d2 / (d2 - d6) : 0.0) * ac);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double sum = (d4 - d3) + (d5 - d6);
        return square(bp - (sum > 0.0 ? (d4 - d3) / sum : 0.0) * (c - b));
    }
    const double inverse = 1.0 / (va + vb + vc);
    return square(ap - vb * inverse * ab - vc * inverse * ac);
}

double square_distance(const Vec3& p, const Box& box) {
    const Vec3 off = glm::max(glm::max(box.low - p, p - box.high), Vec3(0.0));
    return glm::dot(off, off);
}

/// Solid angle of a triangle seen from p, over 4 pi (Van Oosterom & Strackee 1983).
double solid_angle(const Vec3& p, const Vec3& vertex_a, const Vec3& vertex_b, const Vec3& vertex_c) {
    const Vec3 a = vertex_a - p, b = vertex_b - p, c = vertex_c - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double numerator = glm::dot(a, glm::cross(b, c));
    const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return numerator == 0.0 && denominator == 0.0 ? 0.0 : 2.0 * std::atan2(numerator, denominator) * kInverse4Pi;
}

}  // namespace

MeshTree::MeshTree(std::shared_ptr<const TriangleMesh> mesh) : mesh_(std::move(mesh)), order_(mesh_->triangles.size()) {
    assert(!order_.empty());
    std::iota(order_.begin(), order_.end(), 0);
    std::vector<Vec3> centroids;
    centroids.reserve(order_.size());
    for (const auto& t : mesh_->triangles)
        centroids.push_back((mesh_->vertices_m[t[0]] + mesh_->vertices_m[t[1]] + mesh_->vertices_m[t[2]]) / 3.0);
    nodes_.reserve(order_.size());
    build(0, static_cast<std::int32_t>(order_.size()), centroids);
}

std::int32_t MeshTree::build(std::int32_t first, std::int32_t count, const std::vector<Vec3>& centroids) {
    const auto index = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    Node node;
    if (count <= kLeaf) {
        node.first = first;
        node.count = count;
        sum_triangles(node);
    } else {
        Box box{Vec3(1e300), Vec3(-1e300)};
        for (std::int32_t k = first; k < first + count; ++k) {
            box.low = glm::min(box.low, centroids[order_[k]]);
            box.high = glm::max(box.high, centroids[order_[k]]);
        }
        // Halves by number along the longest side: the depth is log2 of the count whatever the triangles are like.
        const Vec3 extent = box.high - box.low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::int32_t half = count / 2;
        std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                         [&](std::int32_t a, std::int32_t b) {
                             const double ca = centroids[a][axis], cb = centroids[b][axis];
                             return ca < cb || (ca == cb && a < b);
                         });
        const std::int32_t left = build(first, half, centroids);
        node.right = build(first + half, count - half, centroids);
        sum_children(node, nodes_[static_cast<std::size_t>(left)], nodes_[static_cast<std::size_t>(node.right)]);
    }
    node.radius = glm::length(glm::max(node.box.high - node.centre, node.centre - node.box.low));
    nodes_[static_cast<std::size_t>(index)] = node;
    return index;
}

void MeshTree::sum_triangles(Node& leaf) const {
    leaf.box = Box{Vec3(1e300), Vec3(-1e300)};
    Vec3 sum(0.0);
    auto each = [&](auto&& body) {
        for (std::int32_t k = leaf.first; k < leaf.first + leaf.count; ++k) {
            const auto& t = mesh_->triangles[static_cast<std::size_t>(order_[k])];
            body(mesh_->vertices_m[t[0]], mesh_->vertices_m[t[1]], mesh_->vertices_m[t[2]]);
        }
    };
    each([&](const Vec3& a, const Vec3& b, const Vec3& c) {
        leaf.box.low = glm::min(leaf.box.low, glm::min(a, glm::min(b, c)));
        leaf.box.high = glm::max(leaf.box.high, glm::max(a, glm::max(b, c)));
        const Vec3 normal = 0.5 * glm::cross(b - a, c - a);
        leaf.area += glm::length(normal);
        leaf.area_normal += normal;
        sum += glm::length(normal) * (a + b + c) / 3.0;
    });
    leaf.centre = leaf.area > 0.0 ? sum / leaf.area : 0.5 * (leaf.box.low + leaf.box.high);
    each([&](const Vec3& a, const Vec3& b, const Vec3& c) {
        leaf.moment += glm::outerProduct((a + b + c) / 3.0 - leaf.centre, 0.5 * glm::cross(b - a, c - a));
    });
}

void MeshTree::sum_children(Node& node, const Node& left, const Node& right) {
    node.box = Box{glm::min(left.box.low, right.box.low), glm::max(left.box.high, right.box.high)};
    node.area = left.area + right.area;
    node.area_normal = left.area_normal + right.area_normal;
    node.centre = node.area > 0.0 ? (left.area * left.centre + right.area * right.centre) / node.area
                                  : 0.5 * (node.box.low + node.box.high);
    for (const Node* child : {&left, &right})
        node.moment += child->moment + glm::outerProduct(child->centre - node.centre, child->area_normal);
}

MeshTree::Nearest MeshTree::nearest(const Vec3& p) const {
    struct Entry {
        double square;
        std::int32_t node;
    };
    Entry stack[128];
    int depth = 0;
    stack[depth++] = {square_distance(p, nodes_[0].box), 0};
    double best = 1e300;
    Nearest found;
    while (depth > 0) {
        const Entry entry = stack[--depth];
        if (entry.square >= best) continue;
        const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
        if (node.count == 0) {
            Entry near{square_distance(p, nodes_[static_cast<std::size_t>(entry.node + 1)].box), entry.node + 1};
            Entry far{square_distance(p, nodes_[static_cast<std::size_t>(node.right)].box), node.right};
            if (far.square < near.square) std::swap(near, far);
            stack[depth++] = far;
            stack[depth++] = near;
            continue;
        }
        for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
            const auto& t = mesh_->triangles[static_cast<std::size_t>(order_[k])];
            const double square =
                square_distance(p, mesh_->vertices_m[t[0]], mesh_->vertices_m[t[1]], mesh_->vertices_m[t[2]]);
            if (square < best) {
                best = square;
                found.triangle = order_[k];
            }
        }
    }
    found.distance_m = std::sqrt(best);
    return found;
}

double MeshTree::winding(const Vec3& p) const {
    std::int32_t stack[128];
    int depth = 0;
    stack[depth++] = 0;
    double sum = 0.0;
    while (depth > 0) {
        const std::int32_t index = stack[--depth];
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        const Vec3 r = node.centre - p;
        const double square = glm::dot(r, r);
        if (square > kFar * kFar * node.radius * node.radius) {
            // Dipole field r / (4 pi |r|^3) and its gradient, contracted with the first moments.
            const double inverse = 1.0 / std::sqrt(square), cube = inverse * inverse * inverse;
            const double trace = node.moment[0][0] + node.moment[1][1] + node.moment[2][2];
            const double stretch = glm::dot(r, node.moment * r);
            sum += kInverse4Pi * cube * (glm::dot(node.area_normal, r) + trace - 3.0 * stretch * inverse * inverse);
        } else if (node.count == 0) {
            stack[depth++] = node.right;
            stack[depth++] = index + 1;
        } else {
            for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
                const auto& t = mesh_->triangles[static_cast<std::size_t>(order_[k])];
                sum += solid_angle(p, mesh_->vertices_m[t[0]], mesh_->vertices_m[t[1]], mesh_->vertices_m[t[2]]);
            }
        }
    }
    return sum;
}

}  // namespace calot::anatomy
