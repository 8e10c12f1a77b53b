// calot_rivals: well-known libraries on the same data in the same run, one thread each.

#include <chrono>
#include <cstdio>

#include <fmt/format.h>

#include "apps/calot/bench_statistics.h"
#include "calot/base/parallel.h"
#include "rivals.h"

namespace calot::rivals {

namespace {
double time_us(const std::function<void()>& body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}
}  // namespace

void run(const Race& race, int rounds) {
    if (race.prepare) race.prepare();
    race.ours();
    race.theirs();
    std::vector<double> ours, theirs;
    for (int k = 0; k < rounds; ++k) {
        if (race.prepare) race.prepare();
        ours.push_back(time_us(race.ours));
        theirs.push_back(time_us(race.theirs));
    }
    const app::Change change = app::compare_paired(ours, theirs);
    fmt::print("{:<46} {:<34} {:>10.1f} {:>11.1f}   x {:>7.1f} ({:.1f} to {:.1f})\n", race.what, race.theirs_name,
               app::quantile(ours, 0.5), app::quantile(theirs, 0.5), change.ratio, change.low, change.high);
    if (race.ours_per_second > 0.0) {
        const double a = app::quantile(ours, 0.5) * race.ours_per_second * 1e-3,
                     b = app::quantile(theirs, 0.5) * race.theirs_per_second * 1e-3;
        fmt::print(
            "    a simulated second at equal physics: ours {:.1f} ms ({:g} runs), theirs {:.1f} ms ({:g} runs): x "
            "{:.1f}\n",
            a, race.ours_per_second, b, race.theirs_per_second, b / a);
    }
    if (!race.note.empty()) fmt::print("    {}\n", race.note);
    std::fflush(stdout);
}

}  // namespace calot::rivals

int main() {
    const calot::ThreadLimit limit(1);
    fmt::print("{:<46} {:<34} {:>10} {:>11}   theirs / ours, 95 % interval\n", "one thread each, us", "", "ours",
               "theirs");
    calot::rivals::race_heat();
    calot::rivals::race_surface();
    calot::rivals::race_elastic();
    return 0;
}
