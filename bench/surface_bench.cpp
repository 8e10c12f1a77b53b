// The surface: whole rebuild, local update, gathering, smoothing, at the standard 147k hexels. The field's kernel is
// compared with its scalar reference.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

#include "calot/anatomy/shapes.h"
#include "calot/base/parallel.h"
#include "calot/surface/field.h"
#include "calot/surface/shape_mesh.h"
#include "calot/surface/surface.h"
#include "calot/tissue/sampling.h"

namespace calot::surface {

namespace {

/// A ball of 147k hexels, as large as the standard scene's tissue.
struct Scene {
    tissue::Model model;
    tissue::State state;

    Scene() {
        anatomy::Anatomy anatomy;
        const double radius_m = 32.76 * 0.6e-3;
        anatomy.field = {Vec3(-0.03), Vec3(0.03)};
        anatomy.tissues.push_back({"fat", "fat", anatomy::make_sphere(Vec3(0.0), radius_m)});
        model = tissue::sample(anatomy, {});
        state.hexel_present = model.hexel_initial;
    }
    /// Hexels nearest to a point of the surface, `count` of them at a time.
    std::vector<std::int64_t> crater(std::size_t count) const {
        std::vector<std::int64_t> hexels;
        for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
            if (model.hexel_initial.test(h)) hexels.push_back(h);
        const Vec3 top(0.0032, 0.0021, 32.76 * 0.6e-3);
        std::sort(hexels.begin(), hexels.end(), [&](std::int64_t a, std::int64_t b) {
            const double da = glm::length(model.hexels.centre_m(a) - top),
                         db = glm::length(model.hexels.centre_m(b) - top);
            return da < db || (da == db && a < b);
        });
        hexels.resize(count);
        return hexels;
    }
};

const Scene& scene() {
    static const Scene scene;
    return scene;
}

void surface_rebuild(benchmark::State& run) {
    const ThreadLimit limit(static_cast<int>(run.range(0)));
    Surface surface(scene().model);
    for (auto _ : run) surface.rebuild(scene().model, scene().state);
    run.counters["triangles"] = static_cast<double>(surface.rest_mesh().triangles());
    run.counters["hexels"] = static_cast<double>(scene().state.hexel_present.count());
}
BENCHMARK(surface_rebuild)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

/// 38 hexels a round, deeper and deeper; what is gone comes back between rounds of 20, untimed.
void surface_update_38(benchmark::State& run) {
    const ThreadLimit limit(1);
    const std::vector<std::int64_t> crater = scene().crater(38 * 20);
    Surface surface(scene().model);
    tissue::Exchange exchange;
    tissue::State state = scene().state;
    std::size_t round = 20;
    for (auto _ : run) {
        if (round == 20) {
            run.PauseTiming();
            state.hexel_present = scene().model.hexel_initial;
            surface.rebuild(scene().model, state);
            round = 0;
            run.ResumeTiming();
        }
        const auto begin = crater.begin() + static_cast<std::ptrdiff_t>(38 * round++);
        exchange.removed_hexels.assign(begin, begin + 38);
        for (std::int64_t h : exchange.removed_hexels) state.hexel_present.clear(h);
        surface.remove(exchange);
        surface.redo_dirty_blocks();
    }
}
BENCHMARK(surface_update_38)->Unit(benchmark::kMicrosecond);

/// One hexel, then the compact mesh (or the smoothed one) is asked for.
void surface_gather(benchmark::State& run, bool smooth) {
    const ThreadLimit limit(1);
    const std::vector<std::int64_t> crater = scene().crater(2000);
    Surface surface(scene().model);
    tissue::State state = scene().state;
    surface.rebuild(scene().model, state);
    tissue::Exchange exchange;
    std::size_t next = 0;
    for (auto _ : run) {
        run.PauseTiming();
        if (next == crater.size()) {
            state.hexel_present = scene().model.hexel_initial;
            surface.rebuild(scene().model, state);
            next = 0;
        }
        exchange.removed_hexels.assign(1, crater[next++]);
        state.hexel_present.clear(exchange.removed_hexels.front());
        surface.remove(exchange);
        surface.redo_dirty_blocks();
        run.ResumeTiming();
        benchmark::DoNotOptimize((smooth ? surface.smooth_mesh() : surface.rest_mesh()).index.data());
    }
}
BENCHMARK_CAPTURE(surface_gather, rest, false)->Unit(benchmark::kMicrosecond)->Iterations(2000);
BENCHMARK_CAPTURE(surface_gather, smooth, true)->Unit(benchmark::kMicrosecond)->Iterations(1000);

/// Nanoseconds a point of the field, by tables and neighbour by neighbour.
template <Moments (*moments)(const Window&, int, int, int)>
void surface_field_point(benchmark::State& run) {
    Window window{};
    for (std::size_t k = 0; k < window.rows.size(); ++k)
        window.rows[k] = static_cast<std::uint32_t>(0x9e3779b9u * (k + 1)) >> 17;
    int k = 0;
    for (auto _ : run) {
        benchmark::DoNotOptimize(moments(window, k % 9, k / 9 % 9, k / 81));
        k = (k + 1) % 729;
    }
}
BENCHMARK(surface_field_point<moments_at>);
BENCHMARK(surface_field_point<moments_at_reference>);

void surface_mesh_of_shape(benchmark::State& run) {
    const auto sphere = anatomy::make_sphere(Vec3(0.0), 0.05);
    for (auto _ : run) benchmark::DoNotOptimize(mesh_of_shape(*sphere, {Vec3(-0.06), Vec3(0.06)}, 1e-3));
}
BENCHMARK(surface_mesh_of_shape)->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace calot::surface
