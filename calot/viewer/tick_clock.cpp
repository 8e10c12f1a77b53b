#include "calot/viewer/tick_clock.h"

namespace calot::viewer {

void TickClock::begin_tick(double now_s) {
    const double lag_s = now_s - next_due_s_;
    if (lag_s > tick_s_) ++late_ticks_;
    if (lag_s > kMostLag_s) {
        lost_s_ += lag_s - kMostLag_s;
        next_due_s_ = now_s - kMostLag_s;
    }
    next_due_s_ += tick_s_;
    ++ticks_;
}

void RateMeter::add(double now_s, std::int64_t count) {
    if (since_s_ < 0.0) {
        since_s_ = now_s;
        return;  // rates count intervals
    }
    count_ += count;
    const double span_s = now_s - since_s_;
    if (span_s < kSpan_s) return;
    per_s_ = static_cast<double>(count_) / span_s;
    since_s_ = now_s;
    count_ = 0;
}

}  // namespace calot::viewer
