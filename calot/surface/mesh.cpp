#include <algorithm>

#include "calot/surface/surface.h"

namespace calot::surface {

MeshCheck check(const Mesh& mesh) {
    MeshCheck result;
    std::vector<std::uint64_t> lines;  // directed: from << 32 | to
    lines.reserve(mesh.index.size());
    for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
        const std::uint64_t a = mesh.index[t], b = mesh.index[t + 1], c = mesh.index[t + 2];
        if (a == b || b == c || c == a) ++result.degenerate_triangles;
        for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
            lines.push_back(from << 32 | to);
    }
    std::sort(lines.begin(), lines.end());
    for (std::size_t k = 0; k < lines.size();) {
        std::size_t same = k + 1;
        while (same < lines.size() && lines[same] == lines[k]) ++same;
        if (same - k > 1) result.nonmanifold_edges += static_cast<std::int64_t>(same - k - 1);
        const std::uint64_t opposite = lines[k] << 32 | lines[k] >> 32;
        if (!std::binary_search(lines.begin(), lines.end(), opposite)) ++result.open_edges;
        k = same;
    }
    result.closed = result.open_edges == 0 && result.nonmanifold_edges == 0 && result.degenerate_triangles == 0;
    return result;
}

double volume_m3(const Mesh& mesh) {
    if (mesh.position_m.empty()) return 0.0;
    const Vec3 origin(mesh.position_m.front());  // close by, so that little cancels
    double six_volumes = 0.0;
    for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
        const Vec3 a = Vec3(mesh.position_m[mesh.index[t]]) - origin;
        const Vec3 b = Vec3(mesh.position_m[mesh.index[t + 1]]) - origin;
        const Vec3 c = Vec3(mesh.position_m[mesh.index[t + 2]]) - origin;
        six_volumes += glm::dot(a, glm::cross(b, c));
    }
    return six_volumes / 6.0;
}

}  // namespace calot::surface
