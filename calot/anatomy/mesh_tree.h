#pragma once
// A tree of boxes over triangles: nearest point, winding number, overlapping pairs.

#include <vector>

#include "calot/anatomy/mesh_shape.h"

namespace calot::anatomy {

class MeshTree {
  public:
    explicit MeshTree(std::shared_ptr<const TriangleMesh> mesh);

    /// Distance to the nearest triangle, and that triangle.
    struct Nearest {
        double distance_m = 0.0;
        std::int32_t triangle = -1;
    };
    Nearest nearest(const Vec3& p) const;

    /// Generalised winding number (Jacobson, Kavan & Sorkine-Hornung 2013): 1 inside a closed, outward mesh, 0 outside;
    /// a smooth compromise at holes. Far groups of triangles count as dipoles with their first moments (Barill et al.
    /// 2018), which is off by up to 0.06: enough to tell whole numbers apart.
    double winding(const Vec3& p) const;

    /// Calls visit(triangle) for triangles whose boxes overlap `box`; it returns false to stop.
    template <class Visit>
    void overlapping(const Box& box, const Visit& visit) const;

    /// Does a box of one triangle or more overlap `box`?
    bool any_in(const Box& box) const {
        bool any = false;
        overlapping(box, [&](std::int32_t) { return !(any = true); });
        return any;
    }

    const TriangleMesh& mesh() const { return *mesh_; }

  private:
    struct Node {
        Box box;
        std::int32_t first = 0, count = 0;  ///< leaf: triangles order_[first, first + count)
        std::int32_t right = 0;             ///< inner node: left child is the next node
        // Far field: sum of area * normal about the area's centre, and its first moments.
        Vec3 centre{0.0}, area_normal{0.0};
        Mat3 moment{0.0};  ///< moment[j][i] = sum area * normal_j * (centroid - centre)_i
        double radius = 0.0, area = 0.0;
    };
    std::int32_t build(std::int32_t first, std::int32_t count, const std::vector<Vec3>& centroids);
    void sum_triangles(Node& leaf) const;
    static void sum_children(Node& node, const Node& left, const Node& right);

    std::shared_ptr<const TriangleMesh> mesh_;
    std::vector<Node> nodes_;
    std::vector<std::int32_t> order_;
};

inline bool overlap(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

template <class Visit>
void MeshTree::overlapping(const Box& box, const Visit& visit) const {
    std::int32_t stack[128];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::int32_t index = stack[--depth];
        const Node& node = nodes_[static_cast<std::size_t>(index)];
        if (!overlap(node.box, box)) continue;
        if (node.count == 0) {
            stack[depth++] = node.right;
            stack[depth++] = index + 1;
            continue;
        }
        for (std::int32_t k = node.first; k < node.first + node.count; ++k)
            if (!visit(order_[static_cast<std::size_t>(k)])) return;
    }
}

}  // namespace calot::anatomy
