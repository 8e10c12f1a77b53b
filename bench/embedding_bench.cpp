// Embedding: surface vertices, once a frame, in the kept form, from scratch and by the scalar reference; the search for
// hexels near the hook, once a tick; the local update of links, whenever something burnt.

#include <benchmark/benchmark.h>

#include "calot/anatomy/block.h"
#include "calot/base/parallel.h"
#include "calot/deformation/embedded_points.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/topology.h"
#include "calot/instruments/contact.h"
#include "calot/instruments/hook.h"
#include "calot/surface/surface.h"
#include "calot/tissue/sampling.h"

namespace {

using namespace calot;

/// A held block of fat of 147k hexels, sagging a little, and its surface of some 21k vertices.
struct Body {
    tissue::Model model = tissue::sample(anatomy::make_block({.size_m = 2.4e-3 * Vec3(16, 16, 9)}), {});
    tissue::State state = tissue::State::make(model);
    deformation::Work work;
    tissue::Exchange exchange;
    std::vector<Vec3f> rest_m, world_m;
    std::vector<Mat3f> gradient;
    std::vector<std::int64_t> owner;

    Body() {
        model.deformation.gravity_m_per_s2 = Vec3(1.0, 2.0, -9.81);
        deformation::sever_initial_links(model, state);
        work = deformation::make_work(model, state);
        tissue::reserve_exchange(model, exchange);
        for (int tick = 0; tick < 20; ++tick) deformation::integrate(model, state, exchange, work);
        surface::Surface surface(model);
        surface.rebuild(model, state);
        rest_m.assign(surface.rest_mesh().position_m.begin(), surface.rest_mesh().position_m.end());
        owner = surface.owner();
        world_m.resize(rest_m.size());
        gradient.resize(rest_m.size());
    }
    void report(benchmark::State& run) const { run.counters["points"] = static_cast<double>(rest_m.size()); }
};

void embedding_kept(benchmark::State& run) {
    Body body;
    const ThreadLimit limit(static_cast<int>(run.range(0)));
    deformation::EmbeddedPoints points;
    points.rebuild(body.model, body.state, body.rest_m, body.owner);
    for (auto _ : run) points.move(body.model, body.state, body.work, body.world_m, body.gradient);
    body.report(run);
}
BENCHMARK(embedding_kept)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond)->UseRealTime();

void embedding_rebuild(benchmark::State& run) {
    Body body;
    deformation::EmbeddedPoints points;
    for (auto _ : run) points.rebuild(body.model, body.state, body.rest_m, body.owner);
    body.report(run);
}
BENCHMARK(embedding_rebuild)->Unit(benchmark::kMicrosecond);

void embedding_from_scratch(benchmark::State& run) {
    Body body;
    const ThreadLimit limit(static_cast<int>(run.range(0)));
    for (auto _ : run)
        deformation::embed_points(body.model, body.state, body.work, body.rest_m, body.owner, body.world_m,
                                  body.gradient);
    body.report(run);
}
BENCHMARK(embedding_from_scratch)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond)->UseRealTime();

void embedding_scalar(benchmark::State& run) {
    Body body;
    for (auto _ : run)
        deformation::embed_points_reference(body.model, body.state, body.work, body.rest_m, body.owner, body.world_m,
                                            body.gradient);
    body.report(run);
}
BENCHMARK(embedding_scalar)->Unit(benchmark::kMicrosecond);

/// The foot lies on the top of the block.
void place_hook_on_top(Body& body) {
    const instruments::HookShape shape;
    const tissue::Pose pose = instruments::pose_through_trocar(Vec3(0.0, -0.08, 0.14), Vec3(0.0, 0.0, 5e-4), 0.0);
    instruments::place_hook(shape, pose, pose, 1e-3, body.exchange.capsules);
}

void find_near_hook(benchmark::State& run) {
    Body body;
    place_hook_on_top(body);
    for (auto _ : run) deformation::find_near(body.model, body.state, body.exchange, body.work, 2e-3);
    run.counters["near"] = static_cast<double>(body.exchange.near.size());
}
BENCHMARK(find_near_hook)->Unit(benchmark::kMicrosecond);

void find_contacts_of_hook(benchmark::State& run) {
    Body body;
    place_hook_on_top(body);
    deformation::find_near(body.model, body.state, body.exchange, body.work, 2e-3);
    for (auto _ : run) instruments::find_contacts(body.model, body.state, body.exchange);
    run.counters["contacts"] = static_cast<double>(body.exchange.contacts.size());
}
BENCHMARK(find_contacts_of_hook)->Unit(benchmark::kMicrosecond);

/// A trench one hexel wide and four deep across the top, 40 hexels a time; the state is restored in between, untimed.
void topology_forty_hexels(benchmark::State& run) {
    Body body;
    const tissue::State fresh = body.state;
    const deformation::Work fresh_work = body.work;
    const Int3 top = body.model.hexels.size - 5;
    std::int64_t severed = 0;
    for (auto _ : run) {
        run.PauseTiming();
        body.state = fresh;
        body.work = fresh_work;
        body.exchange.removed_hexels.clear();
        for (int y = 0; y < 10; ++y)
            for (int z = 0; z < 4; ++z) {
                const std::int64_t hexel = body.model.hexels.index(Int3(top.x / 2, top.y / 2 + y, top.z - z));
                body.state.hexel_present.clear(hexel);
                body.exchange.removed_hexels.push_back(hexel);
            }
        run.ResumeTiming();
        deformation::sever_burnt_links(body.model, body.state, body.exchange, body.work);
        severed = body.state.links_severed;
    }
    run.counters["severed"] = static_cast<double>(severed);
}
BENCHMARK(topology_forty_hexels)->Unit(benchmark::kMicrosecond);

}  // namespace
