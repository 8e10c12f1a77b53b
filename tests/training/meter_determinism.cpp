// What the meter tells: plausible against what the state says, the same on replay and after a restart in the middle.

#include <algorithm>

#include <gtest/gtest.h>

#include "calot/base/parallel.h"
#include "calot/training/meter.h"
#include "calot/training/score.h"
#include "setups.h"

namespace calot::training {
namespace {

struct Measured {
    std::unique_ptr<simulation::Simulation> run;
    std::unique_ptr<Meter> meter;
    std::vector<tissue::Input> inputs;
};

Measured measure(double until_s, int threads = 2) {
    const ThreadLimit limit(threads);
    Measured m;
    m.run = std::make_unique<simulation::Simulation>(test::coarse_setup());
    m.meter = std::make_unique<Meter>(*m.run);
    while (m.run->time_s() < until_s - 0.5e-3) {
        m.inputs.push_back(m.run->setup().script.at(m.run->time_s()));
        m.run->tick(m.inputs.back());
        m.meter->after_tick(*m.run, m.inputs.back());
    }
    return m;
}

const Measured& whole() {
    static const Measured m = measure(1.2);
    return m;
}

TEST(Meter, AgreesWithTheState) {
    const Measured& m = whole();
    const Metrics metrics = m.meter->metrics();
    const tissue::State& state = m.run->state();
    EXPECT_NEAR(metrics.at("time_s"), 1.2, 1e-9);
    EXPECT_NEAR(metrics.at("activation_s"), 1.0, 2.5e-3);
    EXPECT_NEAR(metrics.at("activation_contact_s") + metrics.at("activation_open_s"), metrics.at("activation_s"), 1e-9);
    EXPECT_GT(metrics.at("activation_open_s"), 0.0);  // the pedal goes down above the fat
    EXPECT_EQ(metrics.at("activations"), 1.0);
    // All that is gone: fat, duct, artery.
    const double gone = metrics.at("fat_removed_m3") + metrics.at("duct_burnt_m3") + metrics.at("artery_burnt_m3");
    EXPECT_NEAR(gone, static_cast<double>(state.hexels_burnt + state.hexels_fallen) * m.run->model().hexel_volume_m3(),
                1e-15);
    EXPECT_GT(metrics.at("fat_removed_m3"), 0.0);
    EXPECT_GT(metrics.at("force_peak_N"), 0.0);
    EXPECT_GT(metrics.at("energy_J"), 1.0);
    EXPECT_LE(metrics.at("duct_energy_J"), metrics.at("energy_J"));
    EXPECT_GE(metrics.at("duct_peak_K"), 310.0);
    EXPECT_FALSE(m.meter->events().empty());
}

TEST(Meter, MeasuresBothHands) {
    simulation::Simulation run(test::coarse_setup());
    Meter one(run), both(run);
    std::vector<tissue::Input> inputs;
    for (int k = 0; k < 400; ++k) {  // 40 mm/s to the right, high above the tissue; it starts and stops
        tissue::Input input = run.setup().script.at(run.time_s());
        run.tick(input);
        one.after_tick(run, input);
        input.grasper.present = true;
        input.grasper.pose.position_m = Vec3(4e-5 * std::clamp(k - 20, 0, 360), 0.0, 0.06);
        both.after_tick(run, input);
        inputs.push_back(input);
    }
    const Metrics metrics = both.metrics();
    EXPECT_NEAR(metrics.at("grasper_path_m"), 4e-5 * 360, 1e-9);
    EXPECT_LT(metrics.at("grasper_smoothness"), -1.0);
    EXPECT_EQ(one.metrics().count("grasper_path_m"), 0u);
    Meter again(simulation::Simulation(test::coarse_setup()));
    again.restore(both.save(), inputs);
    EXPECT_EQ(again.metrics().at("grasper_path_m"), metrics.at("grasper_path_m"));
    EXPECT_EQ(again.metrics().at("grasper_smoothness"), metrics.at("grasper_smoothness"));
}

TEST(Meter, SeesWhatIsExposed) {
    // All fat gone at once: everything that no organ covers is exposed.
    const Measured& m = whole();
    const tissue::Model& model = m.run->model();
    const Structure duct(model, tissue::find_material(model.materials, "cystic_duct"), m.run->setup().camera.eye_m);
    ASSERT_TRUE(duct.exists());
    tissue::State state = tissue::State::make(model);
    EXPECT_LT(duct.look(state).freed, 0.2);
    const tissue::MaterialIndex fat = tissue::find_material(model.materials, "fat");
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
        if (model.hexel_material[static_cast<std::size_t>(h)] == fat) state.hexel_present.clear(h);
    StructureState bare = duct.look(state);
    EXPECT_GT(bare.exposed, 0.95);
    EXPECT_GT(bare.freed, 0.9);
    EXPECT_EQ(bare.burnt, 0);
    // A hexel of it killed on the surface is seen, one burnt away is burnt.
    state.damage[static_cast<std::size_t>(duct.hexels()[0])] = 2.0f;
    state.hexel_present.clear(duct.hexels()[1]);
    bare = duct.look(state);
    EXPECT_EQ(bare.injured, 2);
    EXPECT_EQ(bare.burnt, 1);
}

TEST(Meter, IsTheSameForAnyNumberOfThreads) {
    const Measured one = measure(0.5, 1), two = measure(0.5, 2);
    EXPECT_EQ(one.meter->metrics(), two.meter->metrics());
    EXPECT_EQ(one.meter->save(), two.meter->save());
}

TEST(Meter, GoesOnFromASavedMoment) {
    const Measured half = measure(0.6);
    ASSERT_EQ(half.run->state().tick % tissue::Model::frame_ticks, 0);
    simulation::Simulation run(test::coarse_setup(), half.run->state());
    Meter meter(run);
    meter.restore(half.meter->save(), half.inputs);
    while (run.time_s() < 1.2 - 0.5e-3) {
        const tissue::Input input = run.setup().script.at(run.time_s());
        run.tick(input);
        meter.after_tick(run, input);
    }
    EXPECT_EQ(tissue::hash(run.state()), tissue::hash(whole().run->state()));
    EXPECT_EQ(meter.metrics(), whole().meter->metrics());
    EXPECT_EQ(meter.events().size(), whole().meter->events().size());
    EXPECT_THROW(Meter(run, {Target{}}).restore(half.meter->save(), half.inputs), std::runtime_error);
    EXPECT_THROW(Meter(run).restore("nonsense", half.inputs), std::runtime_error);
}

TEST(TaskWatch, BreaksLimitsWhenTheyBreak) {
    const Task task = parse_task(test::kTaskText, "test.toml");
    simulation::Simulation run(test::coarse_setup());
    Meter meter(run, place_targets(task, run.setup()));
    TaskWatch watch(task);
    while (run.time_s() < 0.9) {
        const tissue::Input input = run.setup().script.at(run.time_s());
        run.tick(input);
        meter.after_tick(run, input);
        watch.after_tick(meter, run.state().tick, run.time_s());
    }
    int limits = 0, targets = 0;
    for (const Event& event : meter.events()) {
        limits += event.kind == EventKind::limit;
        targets += event.kind == EventKind::target;
        if (event.kind == EventKind::limit) {
            EXPECT_NEAR(event.time_s, 0.7, 0.051);  // half a second after 0.1 s, looked at every 0.1 s
        }
    }
    EXPECT_EQ(limits, 1);
    EXPECT_EQ(targets, 1);
    EXPECT_FALSE(watch.ended());
}

}  // namespace
}  // namespace calot::training
