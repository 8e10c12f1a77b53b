// Elasticity: a clamped block of fat sags under gravity. Bullet's deformable body with as many nodes, five tetrahedra
// to a cube, neo-Hookean, explicit at the longest step at which it stays whole (tried out here), and implicit at 1 ms.

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "apps/calot/bench_bodies.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/topology.h"
#include "rivals.h"

namespace calot::rivals {

namespace {

constexpr double kYoung_Pa = 5000.0, kPoisson = 0.45, kDensity = 911.0, kSpacing_m = 2.4e-3;
constexpr int kX = 13, kY = 13, kZ = 18;  ///< nodes: 3042

/// The standard output goes nowhere while this lives.
class Silence {
  public:
    Silence() {
        std::fflush(stdout);
        kept_ = ::dup(STDOUT_FILENO);
        const int nowhere = ::open("/dev/null", O_WRONLY);
        ::dup2(nowhere, STDOUT_FILENO);
        ::close(nowhere);
    }
    ~Silence() {
        std::fflush(stdout);
        ::dup2(kept_, STDOUT_FILENO);
        ::close(kept_);
    }

  private:
    int kept_ = -1;
};

/// A block of tetrahedra, its lowest layer fixed. Bullet likes bodies of about a metre: lengths are in millimetres,
/// masses in grams, times in seconds, so that forces are in micronewtons and pressures in pascals.
class BulletBlock {
  public:
    explicit BulletBlock(bool implicit)
        : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_, &body_solver_) {
        solver_.setDeformableSolver(&body_solver_);
        const btVector3 gravity(0, 0, -9810);
        world_.setGravity(gravity);
        world_.getWorldInfo().m_gravity = gravity;
        world_.setImplicit(implicit);
        world_.setLineSearch(false);
        body_ = make_body();
        const double mu = kYoung_Pa / (2.0 * (1.0 + kPoisson)),
                     lambda = kYoung_Pa * kPoisson / ((1.0 + kPoisson) * (1.0 - 2.0 * kPoisson));
        elasticity_ = std::make_unique<btDeformableNeoHookeanForce>(btScalar(mu), btScalar(lambda), btScalar(0.0));
        weight_ = std::make_unique<btDeformableGravityForce>(gravity);
        world_.addSoftBody(body_);
        world_.addForce(body_, elasticity_.get());
        world_.addForce(body_, weight_.get());
    }
    ~BulletBlock() {
        world_.removeForce(body_, weight_.get());
        world_.removeForce(body_, elasticity_.get());
        world_.removeSoftBody(body_);
        delete body_;
    }
    void step(double dt_s) { world_.stepSimulation(btScalar(dt_s), 0); }
    int nodes() const { return body_->m_nodes.size(); }
    /// How far the middle of the top is from where it began [mm]; not a number when it blew up.
    double sag_mm() const {
        const btSoftBody::Node& node = body_->m_nodes[(kZ - 1) * kX * kY + kY / 2 * kX + kX / 2];
        return static_cast<double>(1e3 * kSpacing_m * (kZ - 1) - node.m_x.z());
    }

  private:
    btSoftBody* make_body() {
        std::string nodes = fmt::format("{} 3 0 0\n", kX * kY * kZ), tetrahedra;
        int count = 0;
        for (int z = 0; z < kZ; ++z)
            for (int y = 0; y < kY; ++y)
                for (int x = 0; x < kX; ++x)
                    nodes += fmt::format("{} {} {} {}\n", count++, 1e3 * kSpacing_m * x, 1e3 * kSpacing_m * y,
                                         1e3 * kSpacing_m * z);
        // Five tetrahedra to a cube, mirrored in every other one so that faces fit.
        constexpr std::array<std::array<int, 4>, 5> kEven{
            {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}}};
        int number = 0;
        for (int z = 0; z + 1 < kZ; ++z)
            for (int y = 0; y + 1 < kY; ++y)
                for (int x = 0; x + 1 < kX; ++x)
                    for (const auto& t : kEven) {
                        std::array<int, 4> at{};
                        for (std::size_t k = 0; k < 4; ++k) {
                            const int corner = (x + y + z) % 2 == 0 ? t[k] : t[k] ^ 1;
                            at[k] = ((z + (corner >> 2)) * kY + y + ((corner >> 1) & 1)) * kX + x + (corner & 1);
                        }
                        if ((x + y + z) % 2 != 0) std::swap(at[0], at[1]);  // the mirror turns them inside out
                        tetrahedra += fmt::format("{} {} {} {} {}\n", number++, at[0], at[1], at[2], at[3]);
                    }
        const std::string elements = fmt::format("{} 4 0\n", number) + tetrahedra;
        const Silence silence;  // Bullet tells counts
        btSoftBody* body = btSoftBodyHelpers::CreateFromTetGenData(world_.getWorldInfo(), elements.c_str(), nullptr,
                                                                   nodes.c_str(), false, false, false);
        const double volume_mm3 = 1e9 * std::pow(kSpacing_m, 3.0) * (kX - 1) * (kY - 1) * (kZ - 1);
        body->setTotalMass(btScalar(volume_mm3 * kDensity * 1e-6));  // grams
        for (int k = 0; k < kX * kY; ++k) body->setMass(k, 0);
        body->m_cfg.collisions = 0;
        body->m_cfg.kDF = 0;
        body->m_sleepingThreshold = 0;
        body->setActivationState(DISABLE_DEACTIVATION);
        return body;
    }

    btSoftBodyRigidBodyCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btDeformableBodySolver body_solver_;
    btDeformableMultiBodyConstraintSolver solver_;
    btDeformableMultiBodyDynamicsWorld world_;
    btSoftBody* body_ = nullptr;
    std::unique_ptr<btDeformableNeoHookeanForce> elasticity_;
    std::unique_ptr<btDeformableGravityForce> weight_;
};

/// Whether 0.15 s of sagging end with a block that is still one.
bool stays_whole(bool implicit, double dt_s) {
    BulletBlock block(implicit);
    for (double t = 0.0; t < 0.15; t += dt_s) {
        block.step(dt_s);
        if (!(std::abs(block.sag_mm()) < 30.0)) return false;
    }
    return block.sag_mm() > 0.0;
}

double longest_explicit_step_s() {
    for (const double dt_s :
         {1e-3, 0.7e-3, 0.5e-3, 1e-3 / 3.0, 0.25e-3, 0.2e-3, 0.14e-3, 0.1e-3, 0.07e-3, 0.05e-3, 0.03e-3})
        if (stays_whole(false, dt_s)) return dt_s;
    return 0.0;
}

}  // namespace

void race_elastic() {
    const tissue::Model base = app::phyxel_block(3042);
    tissue::Model model = base;
    model.deformation.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    tissue::State state = tissue::State::make(model);
    deformation::sever_initial_links(model, state);
    deformation::Work work = deformation::make_work(model, state);
    tissue::Exchange exchange;
    tissue::reserve_exchange(model, exchange);

    Race race;
    race.what = fmt::format("clamped block, {} nodes", state.phyxel_present.count());
    race.ours = [&] { deformation::integrate(model, state, exchange, work); };
    race.ours_per_second = 1.0 / model.tick_s;
    const double dt_s = longest_explicit_step_s();
    if (dt_s > 0.0) {
        BulletBlock bullet(false);
        race.theirs_name = fmt::format("Bullet, explicit, {:.2g} ms", dt_s * 1e3);
        race.theirs = [&] { bullet.step(dt_s); };
        race.theirs_per_second = 1.0 / dt_s;
        race.note =
            fmt::format("ours: a tick of {} substeps; theirs: one step, the longest that stays whole", work.substeps);
        run(race, 200);
    } else {
        fmt::print("Bullet, explicit: no step down to 0.03 ms stays whole\n");
    }
    if (stays_whole(true, 1e-3)) {
        BulletBlock bullet(true);
        race.theirs_name = "Bullet, implicit, 1 ms";
        race.theirs = [&] { bullet.step(1e-3); };
        race.theirs_per_second = 1000.0;
        race.note = "ours: a tick; theirs: one implicit step";
        run(race, 20);
    }
}

}  // namespace calot::rivals
