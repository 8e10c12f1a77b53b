#include "progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace calot::app {

Progress::Progress(ProgressKind kind, double duration_s)
    : duration_s_(duration_s), start_(Clock::now()), last_draw_(start_ - std::chrono::seconds(1)) {
    bar_ = kind == ProgressKind::automatic && ::isatty(STDERR_FILENO);
    lines_ = kind != ProgressKind::none && !bar_;
}

void Progress::update(double time_s) {
    if (!bar_ && !lines_) return;
    const auto now = Clock::now();
    const double share = std::min(1.0, time_s / duration_s_);
    const double spent_s = std::chrono::duration<double>(now - start_).count();
    const double left_s = share > 0.0 ? spent_s * (1.0 - share) / share : 0.0;
    if (bar_) {
        if (now - last_draw_ < std::chrono::milliseconds(100)) return;
        last_draw_ = now;
        draw_bar(time_s, left_s);
        return;
    }
    const int percent = static_cast<int>(100.0 * share);
    if (percent < next_percent_) return;
    next_percent_ = percent - percent % 10 + 10;
    fmt::print(stderr, "calot: {:3d} %  {:.2f} of {:g} s simulated, about {} left\n", percent, time_s, duration_s_,
               duration_text(left_s));
    std::fflush(stderr);
}

void Progress::draw_bar(double time_s, double left_s) {
    constexpr int kWidth = 32;
    const double share = std::min(1.0, time_s / duration_s_);
    const int filled = static_cast<int>(std::floor(share * kWidth));
    std::string bar;
    for (int k = 0; k < kWidth; ++k) bar += k < filled ? "█" : "░";
    fmt::print(stderr, "\r  {} {:3.0f} %  {:6.2f} / {:g} s  {} left   ", bar, 100.0 * share, time_s, duration_s_,
               duration_text(left_s));
    std::fflush(stderr);
    bar_drawn_ = true;
}

void Progress::finish() {
    if (bar_drawn_) fmt::print(stderr, "\r\033[K");
    bar_drawn_ = false;
    std::fflush(stderr);
}

void Progress::note(const std::string& line) {
    finish();
    if (bar_ || lines_) fmt::print(stderr, "calot: {}\n", line);
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{}:{:02d} min", whole / 60, whole % 60);
    return fmt::format("{}:{:02d} h", whole / 3600, whole % 3600 / 60);
}

}  // namespace calot::app
