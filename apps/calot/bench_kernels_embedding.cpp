// Kernels about the surface's vertices and the hook: embedding, contact, links.

#include "bench_bodies.h"
#include "bench_suites.h"
#include "calot/deformation/embedded_points.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/topology.h"
#include "calot/instruments/contact.h"
#include "calot/instruments/hook.h"
#include "calot/surface/surface.h"

namespace calot::app {

namespace {

/// 147,456 hexels, sagging a little, with a surface of some 21 thousand vertices.
struct SurfaceBody {
    tissue::Model model;
    tissue::State state;
    deformation::Work work;
    tissue::Exchange exchange;
    std::vector<Vec3f> rest_m, world_m;
    std::vector<Mat3f> gradient;
    std::vector<std::int64_t> owner;
    deformation::EmbeddedPoints points;

    SurfaceBody() : model(hexel_block(147'456)), state(tissue::State::make(model)) {
        model.deformation.gravity_m_per_s2 = Vec3(1.0, 2.0, -9.81);
        deformation::sever_initial_links(model, state);
        work = deformation::make_work(model, state);
        tissue::reserve_exchange(model, exchange);
        for (int tick = 0; tick < 20; ++tick) deformation::integrate(model, state, exchange, work);
        surface::Surface surface(model);
        surface.rebuild(model, state);
        rest_m.assign(surface.rest_mesh().position_m.begin(), surface.rest_mesh().position_m.end());
        owner.assign(surface.owner().begin(), surface.owner().end());
        world_m.resize(rest_m.size());
        gradient.resize(rest_m.size());
        points.rebuild(model, state, rest_m, owner);
    }
    /// The highest hexel in the middle of the top.
    Int3 top() const {
        Int3 cell = model.hexels.size / 2;
        for (cell.z = model.hexels.size.z - 1; !state.hexel_present.test(model.hexels.index(cell)); --cell.z) {
        }
        return cell;
    }
    /// The foot of the hook dips into the middle of the top.
    void place_hook() {
        const Vec3 tip = model.hexels.centre_m(top()) + Vec3(0.0, 0.0, 5e-4);
        const tissue::Pose pose = instruments::pose_through_trocar(tip + Vec3(0.0, -0.08, 0.14), tip, 0.0);
        instruments::place_hook({}, pose, pose, 1e-3, exchange.capsules);
    }
};

/// A vertex: weights of 8 phyxels with u and G of each (12 floats), at 2 operations a float and 9 for G (X - X_j); the
/// gradient is interpolated, too.
constexpr double kEmbeddingOperations = 8.0 * (24.0 + 18.0);
/// Rest position in, 8 weights and cells in, world position and gradient out; u and G of the phyxels are few.
constexpr double kEmbeddingBytes = 12.0 + 8.0 * 8.0 + 12.0 + 36.0;

KernelCase embedding() {
    auto body = std::make_shared<SurfaceBody>();
    KernelCase kernel;
    kernel.name = "embedding of the surface";
    kernel.size = static_cast<std::int64_t>(body->rest_m.size());
    kernel.unit = "vertices";
    kernel.target_us = 50.0;
    const auto size = static_cast<double>(kernel.size);
    kernel.floor = {size * kEmbeddingOperations, size * kEmbeddingBytes};
    kernel.run = [body] { body->points.move(body->model, body->state, body->work, body->world_m, body->gradient); };
    kernel.reference = [body] {
        deformation::embed_points_reference(body->model, body->state, body->work, body->rest_m, body->owner,
                                            body->world_m, body->gradient);
    };
    return kernel;
}

KernelCase contact_search() {
    auto body = std::make_shared<SurfaceBody>();
    body->place_hook();
    KernelCase kernel;
    kernel.name = "contact: hexels near the hook";
    kernel.run = [body] {
        deformation::find_near(body->model, body->state, body->exchange, body->work, 2e-3);
        instruments::find_contacts(body->model, body->state, body->exchange);
    };
    kernel.run();
    kernel.size = static_cast<std::int64_t>(body->exchange.near.size());
    kernel.unit = "near hexels";
    return kernel;
}

/// A trench one hexel wide and four deep, 40 hexels of it; all is mended before the next.
KernelCase severing() {
    auto body = std::make_shared<SurfaceBody>();
    const auto fresh = std::make_shared<tissue::State>(body->state);
    const auto fresh_work = std::make_shared<deformation::Work>(body->work);
    const Int3 top = body->top();
    for (int y = 0; y < 10; ++y)
        for (int z = 0; z < 4; ++z)
            body->exchange.removed_hexels.push_back(body->model.hexels.index(Int3(top.x, top.y + y, top.z - z)));
    KernelCase kernel;
    kernel.name = "topology: links of 40 gone hexels";
    kernel.size = 40;
    kernel.unit = "hexels";
    kernel.most_calls = 1;
    kernel.reset = [body, fresh, fresh_work] {
        body->state = *fresh;
        body->work = *fresh_work;
        body->exchange.removed_hexels.resize(40);
        body->exchange.changed_phyxels.clear();
        for (const std::int64_t hexel : body->exchange.removed_hexels) body->state.hexel_present.clear(hexel);
    };
    kernel.run = [body] { deformation::sever_burnt_links(body->model, body->state, body->exchange, body->work); };
    return kernel;
}

}  // namespace

void add_embedding_kernels(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    add_kernel(plan, jobs, results, "embedding of the surface", embedding);
    add_kernel(plan, jobs, results, "hexels near the hook", contact_search);
    add_kernel(plan, jobs, results, "links of 40 gone hexels", severing);
}

}  // namespace calot::app
