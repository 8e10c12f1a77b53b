#include "bench_jobs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "interrupt.h"
#include "progress.h"

namespace calot::app {

BenchProgress::BenchProgress(ProgressKind kind) : start_(Clock::now()), last_(start_ - std::chrono::seconds(1)) {
    bar_ = kind == ProgressKind::automatic && ::isatty(STDERR_FILENO);
    lines_ = kind != ProgressKind::none && !bar_;
}

void BenchProgress::update(double share, const std::string& label) {
    const auto now = Clock::now();
    if (lines_ && label != last_label_) {
        fmt::print(stderr, "calot: {:3.0f} %  {}\n", 100.0 * share, label);
        std::fflush(stderr);
    }
    const bool due = now - last_ >= std::chrono::milliseconds(100) || label != last_label_;
    last_label_ = label;
    if (!bar_ || !due) return;
    last_ = now;
    constexpr int kWidth = 32;
    std::string bar;
    for (int k = 0; k < kWidth; ++k) bar += k < static_cast<int>(std::floor(share * kWidth)) ? "█" : "░";
    const double spent_s = std::chrono::duration<double>(now - start_).count();
    const std::string left =
        share > 0.02 ? duration_text(spent_s * (1.0 - share) / share) + " left" : std::string("starting");
    fmt::print(stderr, "\r\033[K  {} {:3.0f} %  {:<12} {}", bar, 100.0 * share, left, label);
    std::fflush(stderr);
    drawn_ = true;
}

void BenchProgress::finish() {
    if (drawn_) fmt::print(stderr, "\r\033[K");
    drawn_ = false;
    std::fflush(stderr);
}

bool Jobs::run(BenchProgress& progress) const {
    double total = 0.0, done = 0.0;
    for (const Job& job : jobs_) total += job.weight;
    for (const Job& job : jobs_) {
        progress.update(done / total, job.label);
        job.work([&](double share) {
            progress.update((done + job.weight * std::clamp(share, 0.0, 1.0)) / total, job.label);
            return !interrupted();
        });
        if (interrupted()) break;
        done += job.weight;
    }
    progress.finish();
    return !interrupted();
}

}  // namespace calot::app
