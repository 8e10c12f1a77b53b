#include "bench_tick_watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "bench_statistics.h"

namespace calot::app {

namespace {

constexpr std::size_t kWorst = 10;
constexpr std::size_t kBlockTicks = 100;
// Histogram: 12 bins to a factor of ten.
constexpr double kLeast_us = 0.1, kBinsPerDecade = 12.0;
constexpr int kBins = 66;  // up to 31 ms

std::size_t bin_of(double us) {
    const double at = us > kLeast_us ? kBinsPerDecade * std::log10(us / kLeast_us) : 0.0;
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kBins - 1)));
}

std::vector<double> as_doubles(const std::vector<float>& values) {
    return {values.begin(), values.end()};
}

std::string stage_in_words(const TickEvent& event, const std::array<StageTimes, simulation::kStages>& usual) {
    std::size_t stage = 0;
    double most = -1e9;
    for (std::size_t k = 0; k < simulation::kStages; ++k) {
        const double excess = static_cast<double>(event.stages_us[k]) - usual[k].median;
        if (excess > most) most = excess, stage = k;
    }
    std::string text = fmt::format("{} took {:.0f} us, {:.0f} more than usual", simulation::kStageNames[stage],
                                   event.stages_us[stage], most);
    std::string what;
    auto add = [&](std::int64_t count, const char* name) {
        if (count > 0) what += fmt::format("{}{} {}", what.empty() ? "" : ", ", count, name);
    };
    add(event.removed, "hexels gone");
    add(event.severed, "links severed");
    add(event.contacts, "contacts");
    add(event.gas, "puffs of gas");
    return text + (what.empty() ? "; nothing happened in the tissue" : "; " + what) +
           (event.pedal ? "; pedal down" : "");
}

}  // namespace

TickWatch::TickWatch(std::int64_t ticks) {
    const auto n = static_cast<std::size_t>(ticks);
    us_.reserve(n);
    for (auto& stage : stages_us_) stage.reserve(n);
    pedal_.reserve(n);
    removed_.reserve(n);
    worst_.reserve(kWorst + 1);
}

bool TickWatch::tick(simulation::Simulation& run, const tissue::Input& input) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const bool ok = run.tick(input);
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    const tissue::State& state = run.figures();
    const std::int64_t removed_now = state.hexels_burnt + state.hexels_fallen;
    const std::int64_t removed = removed_now - removed_before_, severed = state.links_severed - severed_before_;
    removed_before_ = removed_now;
    severed_before_ = state.links_severed;
    tick_s_ = run.model().tick_s;
    us_.push_back(static_cast<float>(us));
    for (std::size_t k = 0; k < stages_us_.size(); ++k) stages_us_[k].push_back(run.stage_us()[k]);
    pedal_.push_back(input.pedal ? 1 : 0);
    removed_.push_back(static_cast<std::uint16_t>(std::min<std::int64_t>(removed, 65535)));
    if (worst_.size() < kWorst || us > worst_.back().us) note_event(run, input, us, removed, severed);
    return ok;
}

void TickWatch::note_event(const simulation::Simulation& run, const tissue::Input& input, double us,
                           std::int64_t removed, std::int64_t severed) {
    TickEvent event;
    event.tick = run.figures().tick - 1;
    event.us = us;
    event.stages_us = run.stage_us();
    event.pedal = input.pedal;
    event.removed = removed;
    event.severed = severed;
    event.contacts = static_cast<std::int64_t>(run.exchange().contacts.size());
    event.near = static_cast<std::int64_t>(run.exchange().near.size());
    event.gas = static_cast<std::int64_t>(run.exchange().gas.size());
    const auto place = std::upper_bound(worst_.begin(), worst_.end(), us,
                                        [](double value, const TickEvent& e) { return value > e.us; });
    worst_.insert(place, std::move(event));
    if (worst_.size() > kWorst) worst_.pop_back();
}

void TickWatch::finish(const simulation::Simulation& run, TickResult& result) const {
    const std::vector<double> us = as_doubles(us_);
    const std::size_t ticks = us.size();
    result.simulated_s = static_cast<double>(ticks) * tick_s_;
    result.median_us = quantile(us, 0.5);
    result.p99_us = quantile(us, 0.99);
    result.p999_us = quantile(us, 0.999);
    result.max_us = quantile(us, 1.0);
    const std::vector<double> least = as_doubles(least_us_.empty() ? us_ : least_us_);
    for (const double time : least) result.least.mean += time / static_cast<double>(std::max<std::size_t>(1, ticks));
    result.least.median = quantile(least, 0.5);
    result.least.p99 = quantile(least, 0.99);
    result.least.max = quantile(least, 1.0);
    result.removed = run.figures().hexels_burnt + run.figures().hexels_fallen;
    result.severed = run.figures().links_severed;
    std::vector<double> burning;
    double sum = 0.0;
    for (std::size_t k = 0; k < ticks; ++k) {
        sum += us[k];
        if (pedal_[k] != 0) burning.push_back(us[k]);
        if (us[k] > tick_s_ * 1e6) ++result.late;
    }
    result.mean_us = ticks > 0 ? sum / static_cast<double>(ticks) : 0.0;
    result.burning_ticks = static_cast<std::int64_t>(burning.size());
    result.burning_p99_us = quantile(burning, 0.99);

    for (int k = 0; k <= kBins; ++k) result.bin_edges_us.push_back(kLeast_us * std::pow(10.0, k / kBinsPerDecade));
    for (std::size_t s = 0; s <= simulation::kStages; ++s) {
        const std::vector<double> times = s < simulation::kStages ? as_doubles(stages_us_[s]) : us;
        result.histogram[s].assign(kBins, 0);
        double total = 0.0;
        for (const double time : times) {
            ++result.histogram[s][bin_of(time)];
            total += time;
        }
        if (s == simulation::kStages || times.empty()) continue;
        result.stages_us[s] = {total / static_cast<double>(ticks), quantile(times, 0.5), quantile(times, 0.99),
                               quantile(times, 1.0)};
    }
    for (std::size_t k = 0; k + kBlockTicks <= ticks; k += kBlockTicks) {
        const std::vector<double> block(us.begin() + static_cast<std::ptrdiff_t>(k),
                                        us.begin() + static_cast<std::ptrdiff_t>(k + kBlockTicks));
        result.block_median_us.push_back(quantile(block, 0.5));
        result.block_p99_us.push_back(quantile(block, 0.99));
    }
    const auto second = static_cast<std::size_t>(std::lround(1.0 / tick_s_));
    std::int64_t within = 0;
    for (std::size_t k = 0; k < ticks; ++k) {
        within += removed_[k];
        if (k >= second) within -= removed_[k - second];
        result.most_removed_in_a_second = std::max(result.most_removed_in_a_second, within);
    }
    result.worst = worst_;
    for (TickEvent& event : result.worst) event.cause = stage_in_words(event, result.stages_us);
}

}  // namespace calot::app
