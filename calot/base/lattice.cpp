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
    // Axes from shortest to longest; ties keep x before y before z, so that the layout is a function of size alone.
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return size[a] < size[b]; });
    return make(origin_m, spacing_m, size, axes, {});
}

Lattice Lattice::make(const Vec3& origin_m, double spacing_m, const Int3& size, const std::array<int, 3>& axes,
                      const Rows& rows) {
    assert(size.x >= 1 && size.y >= 1 && size.z >= 1 && spacing_m > 0.0);
    const int fast = axes[0], middle = axes[1], slow = axes[2];

    Lattice lattice;
    lattice.origin_m = origin_m;
    lattice.spacing_m = spacing_m;
    lattice.size = size;
    lattice.stride[fast] = 1;
    const int row = static_cast<int>(round_up(size[fast] + 1, rows.multiple));
    lattice.stride[middle] = row;
    lattice.stride[slow] = row * (size[middle] + 1);
    // Padding holds one slow step plus one step of each other axis, and a whole wide vector.
    const std::int64_t reach = std::int64_t{lattice.stride[slow]} + lattice.stride[middle] + 1;
    const std::int64_t padding = round_up(reach, 64);
    lattice.first = padding + rows.shift;
    lattice.last = lattice.first + std::int64_t{lattice.stride[slow]} * size[slow];
    lattice.cells = round_up(lattice.last, 64) + round_up(reach, 64) + 64;
    return lattice;
}

Int3 Lattice::coordinates(std::int64_t index) const {
    // From the slowest axis to the fastest; strides differ, and this is called often enough not to sort them.
    const int slow = stride.x > stride.y ? (stride.x > stride.z ? 0 : 2) : (stride.y > stride.z ? 1 : 2);
    const int fast = stride.x < stride.y ? (stride.x < stride.z ? 0 : 2) : (stride.y < stride.z ? 1 : 2);
    const int middle = 3 - slow - fast;
    const std::int64_t rest = index - first;
    Int3 c{0};
    c[slow] = static_cast<int>(rest / stride[slow]);
    const auto in_plane = static_cast<int>(rest % stride[slow]);
    c[middle] = in_plane / stride[middle];
    c[fast] = in_plane % stride[middle];
    return c;
}

}  // namespace calot
