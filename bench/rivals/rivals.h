#pragma once
// Other libraries on the same data, in turn with Calot: each function prints its rows.

#include <functional>
#include <string>

namespace calot::rivals {

/// Runs both in turn, `rounds` times each, and prints medians and the ratio theirs / ours with its 95 % interval.
/// `per_second`: how often each must run for a second of simulated time at equal physics; 0 = does not apply.
struct Race {
    std::string what, theirs_name;
    std::function<void()> ours, theirs;
    double ours_per_second = 0.0, theirs_per_second = 0.0;
    std::string note;
    std::function<void()> prepare;  ///< before each of our runs, not timed; may be empty
};
void run(const Race& race, int rounds);

void race_heat();     ///< OpenVDB tools::laplacian
void race_surface();  ///< VTK Flying Edges, OpenVDB volumeToMesh
void race_elastic();  ///< Bullet's deformable bodies

}  // namespace calot::rivals
