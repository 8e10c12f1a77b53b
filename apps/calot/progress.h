#pragma once
// How far a run is, and how long it will take.

#include <chrono>
#include <string>

#include "commands.h"

namespace calot::app {

class Progress {
  public:
    /// A bar on a terminal, lines otherwise, or nothing; on the standard error.
    Progress(ProgressKind kind, double duration_s);
    void update(double time_s);
    /// Ends the bar's line.
    void finish();
    /// A line of its own for people.
    void note(const std::string& line);

  private:
    using Clock = std::chrono::steady_clock;
    void draw_bar(double time_s, double seconds_left);
    bool bar_ = false, lines_ = false, bar_drawn_ = false;
    double duration_s_;
    Clock::time_point start_, last_draw_;
    int next_percent_ = 10;
};

/// "1:23 min", "4 s"
std::string duration_text(double seconds);

}  // namespace calot::app
