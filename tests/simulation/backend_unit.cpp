// Backends other than the processor's: fetched when somebody asks, replaced when they fail, with nothing lost.

#include <gtest/gtest.h>

#include "calot/deformation/embedding.h"
#include "calot/simulation/simulation.h"
#include "simulation/test_setups.h"

namespace calot::simulation {

namespace {

/// What a test sees and sets of a backend that Simulation owns.
struct Record {
    std::int64_t steps = 0, state_fetches = 0, surface_fetches = 0, embeddings = 0;
    std::int64_t fail_at = -1;  ///< tick whose step fails
    bool fetch_fails = false;
};

/// A device of its own: all arrays are elsewhere until they are fetched.
class Elsewhere final : public Backend {
  public:
    Elsewhere(const Setup& setup, Record& record) : setup_(setup), record_(record) {}
    std::string name() const override { return "elsewhere"; }
    bool keeps_host_current() const override { return false; }
    void begin(const tissue::Model& model, tissue::State& state, Work&) override {
        state_ = state;
        work_.emplace(model, state_, setup_.hook, setup_.smoke, setup_.grasper);
    }
    void step(const tissue::Model& model, tissue::State& state, Work& work, const tissue::Input& input) override {
        if (state_.tick == record_.fail_at) {
            state.tick = 123456789;  // half-way through its work
            work.exchange.removed_hexels.push_back(1);
            throw BackendError("the cable was pulled");
        }
        ++record_.steps;
        simulation::step(model, state_, *work_, input);
        state.tick = state_.tick;
        state.status = state_.status;
        state.hook_force_N = state_.hook_force_N;
        state.hexel_present = state_.hexel_present;
        work.exchange = work_->exchange;
        work.smoke = work_->smoke;
        work.bleeding = work_->bleeding;
    }
    void fetch_state(const tissue::Model&, tissue::State& state, Work& work) override {
        if (record_.fetch_fails) throw BackendError("it does not answer");
        ++record_.state_fetches;
        state = state_;
        work.thermal.temperature_K = work_->thermal.temperature_K;
    }
    void fetch_surface(const tissue::Model& model, const tissue::State&, Work& work) override {
        ++record_.surface_fetches;
        work.surface.rebuild(model, state_);
    }

    void embed_surface(const Work& work, std::span<Vec3f> world_m, std::span<Mat3f> deformation_gradient) override {
        if (record_.fetch_fails) throw BackendError("it does not answer");
        ++record_.embeddings;
        deformation::embed_points(setup_.model, state_, work_->deformation, work.surface.smooth_mesh().position_m,
                                  work.surface.owner(), world_m, deformation_gradient);
    }

  private:
    const Setup& setup_;
    Record& record_;
    tissue::State state_;
    std::optional<Work> work_;
};

std::shared_ptr<Setup> setup_with(Record& record) {
    auto setup = burnt_block_setup();
    setup->backend = [&record](const Setup& of) { return std::make_unique<Elsewhere>(of, record); };
    return setup;
}

void run_to(Simulation& run, std::int64_t tick) {
    while (run.figures().tick < tick) ASSERT_TRUE(run.tick(run.setup().script.at(run.time_s())));
}

std::string effects_of(Simulation& run) {
    Archive effects;
    run.archive_effects(effects);
    return effects.bytes();
}

}  // namespace

TEST(Backend, FetchesOnlyWhenAsked) {
    Record record;
    const auto setup = setup_with(record);
    Simulation run(setup), on_cpu(burnt_block_setup());
    run_to(run, 451);
    run_to(on_cpu, 451);
    EXPECT_EQ(record.steps, 451);
    EXPECT_EQ(record.state_fetches, 0);
    EXPECT_EQ(run.figures().hook_force_N, on_cpu.state().hook_force_N);
    EXPECT_EQ(record.state_fetches, 0);
    EXPECT_EQ(tissue::hash_fields(run.state()), tissue::hash_fields(on_cpu.state()));
    EXPECT_EQ(tissue::hash(run.state()), tissue::hash(on_cpu.state()));
    EXPECT_EQ(record.state_fetches, 1) << "it had not moved on";
    EXPECT_EQ(record.surface_fetches, 0);
    EXPECT_EQ(run.surface().rest_mesh().position_m, on_cpu.surface().rest_mesh().position_m);
    EXPECT_EQ(record.surface_fetches, 1);
    WorldSurface seen, expected;
    run.world_surface(seen);
    on_cpu.world_surface(expected);
    EXPECT_EQ(record.embeddings, 1);
    EXPECT_EQ(seen.position_m, expected.position_m);
    EXPECT_EQ(record.state_fetches, 1) << "to look, only vertices move";
    run_to(run, 600);
    EXPECT_EQ(record.state_fetches, 2) << "once, to have a state to fall back to";
    EXPECT_TRUE(run.notices().empty());
}

// In its step, in the first ticks, right at a kept state, and while somebody looks.
TEST(Backend, NothingIsLostWhenItFails) {
    Simulation on_cpu(burnt_block_setup());
    run_to(on_cpu, 1100);
    const auto expected = tissue::hash_fields(on_cpu.state());
    const std::string effects = effects_of(on_cpu);
    for (const std::int64_t fail_at : {0, 5, 512, 1003}) {
        Record record;
        record.fail_at = fail_at;
        const auto setup = setup_with(record);
        Simulation run(setup);
        const std::uint64_t version = run.surface().version();
        run_to(run, 1100);
        EXPECT_EQ(record.steps, fail_at);
        EXPECT_EQ(tissue::hash_fields(run.state()), expected) << "failed at tick " << fail_at;
        EXPECT_EQ(effects_of(run), effects);
        EXPECT_GT(run.surface().version(), version) << "whoever keeps a mesh must see that it is another";
        EXPECT_EQ(run.backend().name(), "CPU");
        ASSERT_EQ(run.notices().size(), 1u);
        EXPECT_NE(run.notices()[0].find("the cable was pulled"), std::string::npos) << run.notices()[0];
    }
    Record record;
    const auto setup = setup_with(record);
    Simulation run(setup);
    run_to(run, 700);
    record.fetch_fails = true;
    WorldSurface seen;
    run.world_surface(seen);
    EXPECT_EQ(seen.position_m.size(), run.surface().smooth_mesh().position_m.size());
    EXPECT_EQ(run.state().tick, 700);
    run_to(run, 1100);
    EXPECT_EQ(tissue::hash_fields(run.state()), expected);
    EXPECT_EQ(run.notices().size(), 1u);
}

TEST(Backend, WithoutOneTheProcessorComputes) {
    auto setup = burnt_block_setup();
    std::string told;
    setup->tell = [&told](const std::string& notice) { told = notice; };
    setup->backend = [](const simulation::Setup&) -> std::unique_ptr<Backend> {
        throw BackendError("there is no such device");
    };
    Simulation run(setup), on_cpu(burnt_block_setup());
    run_to(run, 300);
    run_to(on_cpu, 300);
    EXPECT_EQ(tissue::hash(run.state()), tissue::hash(on_cpu.state()));
    ASSERT_EQ(run.notices().size(), 1u);
    EXPECT_NE(run.notices()[0].find("there is no such device"), std::string::npos);
    EXPECT_EQ(told, run.notices()[0]);
}

}  // namespace calot::simulation
