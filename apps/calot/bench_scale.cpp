// How the time of a tick grows with the number of hexels, all of them warm, up to ten million.

#include <cmath>

#include <fmt/format.h>

#include "bench_bodies.h"
#include "bench_statistics.h"
#include "bench_suites.h"
#include "calot/base/parallel.h"
#include "calot/base/random.h"
#include "calot/deformation/topology.h"
#include "calot/simulation/simulation.h"

namespace calot::app {

namespace {

/// Every hexel warm: those that are cold cost nothing, and would hide how the rest grows.
class WarmBlock {
  public:
    explicit WarmBlock(std::int64_t hexels) : model_(hexel_block(hexels)), state_(tissue::State::make(model_)) {
        Random random(1);
        for (std::int64_t i = model_.hexels.first; i < model_.hexels.last; ++i)
            if (state_.hexel_present.test(i))
                state_.enthalpy_J_per_m3[static_cast<std::size_t>(i)] = static_cast<float>(random.uniform(1e6, 1e7));
        deformation::sever_initial_links(model_, state_);
        work_ =
            std::make_unique<simulation::Work>(model_, state_, instruments::HookShape{}, effects::SmokeParameters{});
        Int3 top = model_.hexels.size / 2;
        for (top.z = model_.hexels.size.z - 1; !state_.hexel_present.test(model_.hexels.index(top)); --top.z) {
        }
        const Vec3 tip = model_.hexels.centre_m(top);
        input_.hook = instruments::pose_through_trocar(tip + Vec3(0.0, -0.08, 0.14), tip, 0.0);
        input_.pedal = true;
        input_.power_setting_W = 60.0;
    }
    std::int64_t hexels() const { return state_.hexel_present.count(); }
    void tick() { simulation::step(model_, state_, *work_, input_); }
    const simulation::Work& work() const { return *work_; }

  private:
    tissue::Model model_;
    tissue::State state_;
    std::unique_ptr<simulation::Work> work_;
    tissue::Input input_;
};

void measure_size(std::int64_t hexels, const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const ThreadLimit limit(plan.threads);
    WarmBlock block(hexels);
    const std::int64_t size = block.hexels();  // before any of them burns
    // Whole rounds of the schedule, so that every stage has its turn.
    constexpr int kRound = 8;
    const double wanted = plan.quick ? 2e6 : 3e7;
    const int rounds = std::max(plan.quick ? 2 : 4, static_cast<int>(wanted / static_cast<double>(hexels) / kRound));
    ScaleResult& scale = results.scale;
    scale.threads = plan.threads;
    for (int k = 0; k < 2 * kRound; ++k) block.tick();
    std::vector<double> us;
    std::array<std::vector<double>, simulation::kStages> stages;
    for (int round = 0; round < rounds; ++round) {
        double sum = 0.0;
        std::array<double, simulation::kStages> stage_sums{};
        for (int k = 0; k < kRound; ++k) {
            block.tick();
            for (std::size_t s = 0; s < stage_sums.size(); ++s) {
                stage_sums[s] += static_cast<double>(block.work().stage_us[s]);
                sum += static_cast<double>(block.work().stage_us[s]);
            }
        }
        us.push_back(sum / kRound);
        for (std::size_t s = 0; s < stages.size(); ++s) stages[s].push_back(stage_sums[s] / kRound);
        if (!report((round + 1.0) / rounds)) return;
    }
    scale.sizes.push_back(size);
    scale.us.push_back(least(us));
    for (std::size_t s = 0; s < stages.size(); ++s) scale.stages_us[s].push_back(least(stages[s]));
}

/// What does not grow (the field's window) rules small bodies: the exponent is that of the larger half.
void fit(ScaleResult& scale) {
    std::vector<double> x, y;
    for (std::size_t k = scale.sizes.size() / 2; k < scale.sizes.size(); ++k) {
        x.push_back(static_cast<double>(scale.sizes[k]));
        y.push_back(scale.us[k]);
    }
    scale.exponent = growth_exponent(x, y);
}

}  // namespace

void add_scale(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    std::vector<std::int64_t> sizes{3'041, 20'291, 147'233};
    if (!plan.quick) sizes = {3'041, 20'291, 50'000, 147'233, 400'000, 1'178'091, 3'000'000, 10'000'000};
    for (const std::int64_t size : sizes)
        jobs.add(fmt::format("scale, {} hexels", size), 1.0 + 1e-6 * static_cast<double>(size),
                 [size, plan, &results](const Jobs::Report& report) { measure_size(size, plan, results, report); });
    jobs.add("fit", 0.1, [&results](const Jobs::Report&) { fit(results.scale); });
}

}  // namespace calot::app
