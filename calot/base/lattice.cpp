#include "calot/base/lattice.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace calot {

namespace {
std::int64_t round_up(std::int64_t n, std::int64_t multiple) { return (n + multiple - 1) / multiple * multiple; }
}  // namespace

Lattice Lattice::make(const Vec3& origin_m, double spacing_m, const Int3& size) {
    assert(size.x >= 1 && size.y >= 1 && size.z >= 1 && spacing_m > 0.0);
    // Axes from shortest to longest; ties keep x before y before z, so that the layout is a function of size alone.
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return size[a] < size[b]; });
    const int fast = axes[0], middle = axes[1], slow = axes[2];

    Lattice lattice;
    lattice.origin_m = origin_m;
    lattice.spacing_m = spacing_m;
    lattice.size = size;
    lattice.stride[fast] = 1;
    lattice.stride[middle] = size[fast] + 1;
    lattice.stride[slow] = (size[fast] + 1) * (size[middle] + 1);
    // Padding holds one slow step plus one step of each other axis, and a whole wide vector.
    const std::int64_t reach = std::int64_t{lattice.stride[slow]} + lattice.stride[middle] + 1;
    const std::int64_t padding = round_up(reach, 64);
    lattice.first = padding;
    lattice.last = padding + std::int64_t{lattice.stride[slow]} * size[slow];
    lattice.cells = round_up(lattice.last, 64) + round_up(reach, 64) + 64;
    return lattice;
}

Int3 Lattice::coordinates(std::int64_t index) const {
    // The fast axis has stride 1. No general sort: this is called inside steps.
    const int fast = stride.x == 1 ? 0 : stride.y == 1 ? 1 : 2;
    int middle = (fast + 1) % 3, slow = (fast + 2) % 3;
    if (stride[middle] > stride[slow]) std::swap(middle, slow);
    const std::int64_t rest = index - first;
    const std::int64_t in_plane = rest % stride[slow];
    Int3 c{0};
    c[slow] = static_cast<int>(rest / stride[slow]);
    c[middle] = static_cast<int>(in_plane / stride[middle]);
    c[fast] = static_cast<int>(in_plane % stride[middle]);
    return c;
}

}  // namespace calot
