// The surface: all of it, and near what burnt.

#include <algorithm>

#include <fmt/format.h>

#include "bench_bodies.h"
#include "bench_suites.h"
#include "calot/surface/field.h"
#include "calot/surface/surface.h"

namespace calot::app {

namespace {

constexpr std::size_t kGone = 40;
constexpr std::size_t kRounds = 20;

struct SurfaceScene {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    surface::Surface surface;
    std::vector<std::int64_t> crater;  ///< hexels, in the order in which they go
    std::size_t round = 0;

    explicit SurfaceScene(std::int64_t hexels)
        : model(hexel_block(hexels)), state(tissue::State::make(model)), surface(model) {
        surface.rebuild(model, state);
        static_cast<void>(surface.rest_mesh());
        tissue::reserve_exchange(model, exchange);
        find_crater();
    }
    /// The hexels nearest to a point of the top, the nearest first.
    void find_crater() {
        Int3 top = model.hexels.size / 2;
        for (top.z = model.hexels.size.z - 1; !state.hexel_present.test(model.hexels.index(top)); --top.z) {
        }
        std::vector<std::pair<int, std::int64_t>> near;
        constexpr int kAway = 12;
        for (int z = -kAway; z <= 0; ++z)
            for (int y = -kAway; y <= kAway; ++y)
                for (int x = -kAway; x <= kAway; ++x) {
                    const Int3 cell = top + Int3(x, y, z);
                    if (!model.hexels.contains(cell)) continue;
                    const std::int64_t hexel = model.hexels.index(cell);
                    if (state.hexel_present.test(hexel)) near.emplace_back(x * x + y * y + z * z, hexel);
                }
        std::sort(near.begin(), near.end());
        for (std::size_t k = 0; k < std::min(near.size(), kGone * kRounds); ++k) crater.push_back(near[k].second);
    }
    void burn_forty() {
        const auto begin = crater.begin() + static_cast<std::ptrdiff_t>(kGone * round++);
        exchange.removed_hexels.assign(begin, begin + static_cast<std::ptrdiff_t>(kGone));
        for (const std::int64_t hexel : exchange.removed_hexels) state.hexel_present.clear(hexel);
        surface.remove(exchange);
        surface.redo_dirty_blocks();
    }
    void mend() {
        state.hexel_present = model.hexel_initial;
        surface.rebuild(model, state);
        static_cast<void>(surface.rest_mesh());
        round = 0;
    }
};

volatile float kept_sum = 0.0f;  ///< so that nothing is optimised away

/// Field and triangles by the plain rules: every point that a cut edge ends at, neighbour by neighbour. (The triangles
/// themselves have no second implementation; the field is most of the work.)
void field_by_neighbours(const SurfaceScene& scene) {
    const Lattice& lattice = scene.model.hexels;
    float sum = 0.0f;
    for (int z = 0; z < lattice.size.z; ++z)
        for (int y = 0; y < lattice.size.y; ++y)
            for (int x = 0; x < lattice.size.x; ++x) {
                const std::int64_t cell = lattice.index(x, y, z);
                const bool here = scene.state.hexel_present.test(cell);
                bool cut = false;
                for (const int stride : {lattice.stride.x, lattice.stride.y, lattice.stride.z})
                    cut |= scene.state.hexel_present.test(cell + stride) != here ||
                           scene.state.hexel_present.test(cell - stride) != here;
                if (!cut) continue;
                surface::Moments m;
                for (int dz = -surface::kReach; dz <= surface::kReach; ++dz)
                    for (int dy = -surface::kReach; dy <= surface::kReach; ++dy)
                        for (int dx = -surface::kReach; dx <= surface::kReach; ++dx) {
                            const Int3 other(x + dx, y + dy, z + dz);
                            if (!lattice.contains(other) || !scene.state.hexel_present.test(lattice.index(other)))
                                continue;
                            const int d2 = dx * dx + dy * dy + dz * dz;
                            m.weight += surface::field_weight(d2);
                            m.mean += surface::field_weight(d2) * Int3(dx, dy, dz);
                            m.slope += surface::slope_weight(d2) * Int3(dx, dy, dz);
                        }
                sum += surface::field_value(m, here);
            }
    kept_sum = sum;
}

KernelCase whole(std::int64_t hexels, int threads, double target_us) {
    auto scene = std::make_shared<SurfaceScene>(hexels);
    KernelCase kernel;
    kernel.name = "surface, whole";
    kernel.size = scene->state.hexel_present.count();
    kernel.unit = "hexels";
    kernel.threads = threads;
    kernel.target_us = target_us;
    kernel.run = [scene] { scene->surface.rebuild(scene->model, scene->state); };
    kernel.reference = [scene] { field_by_neighbours(*scene); };
    return kernel;
}

/// Vertices and triangles are spliced into the pools of the blocks: what a tick does. `with_mesh`: then the compact
/// mesh is gathered from them, as for a picture.
KernelCase local(std::int64_t hexels, bool with_mesh, double target_us) {
    auto scene = std::make_shared<SurfaceScene>(hexels);
    KernelCase kernel;
    kernel.name = with_mesh ? "surface, 40 gone hexels, and the mesh" : "surface, 40 gone hexels";
    kernel.size = scene->state.hexel_present.count();
    kernel.unit = "hexels";
    kernel.target_us = target_us;
    kernel.most_calls = static_cast<int>(scene->crater.size() / kGone);
    kernel.reset = [scene] { scene->mend(); };
    kernel.run = [scene, with_mesh] {
        scene->burn_forty();
        if (with_mesh) static_cast<void>(scene->surface.rest_mesh());
    };
    return kernel;
}

}  // namespace

void add_surface(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    const auto add = [&](const std::string& label, std::function<KernelCase()> make) {
        add_kernel(plan, jobs, results, label, std::move(make));
    };
    add("whole surface, 147,233 hexels", [] { return whole(147'233, 1, 1000.0); });
    add("local surface, 147,233 hexels", [] { return local(147'233, false, 50.0); });
    add("local surface and compact mesh, 147,233 hexels", [] { return local(147'233, true, 0.0); });
    if (plan.quick) return;
    add("local surface, 20,291 hexels", [] { return local(20'291, false, 50.0); });
    add("whole surface, 1,178,091 hexels", [] { return whole(1'178'091, 1, 0.0); });
    add("local surface, 1,178,091 hexels", [] { return local(1'178'091, false, 50.0); });
    add("local surface and compact mesh, 1,178,091 hexels", [] { return local(1'178'091, true, 0.0); });
    const int all = plan.threads;
    if (all == 1) return;
    add("whole surface, 147,233 hexels, all threads", [all] { return whole(147'233, all, 0.0); });
    add("whole surface, 1,178,091 hexels, all threads", [all] { return whole(1'178'091, all, 0.0); });
}

}  // namespace calot::app
