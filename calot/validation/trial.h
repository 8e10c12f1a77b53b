#pragma once
// A scene run from start to end, and what an experimenter would measure of it.

#include <functional>
#include <string>
#include <vector>

#include "calot/simulation/simulation.h"
#include "calot/validation/case.h"

namespace calot::validation {

struct Trial {
    std::string scene;
    double removed_mm3 = 0.0;
    double depth_mm = 0.0;           ///< deepest removed hexel, below the block's top
    double damage_mm = 0.0;          ///< Omega >= 1, horizontally beyond what was removed and where the metal was
    double section_damage_mm = 0.0;  ///< the same of one section across a stroke along x, mean of all under the metal
    double damaged_mm3 = 0.0;        ///< present tissue with Omega >= 1
    double metal_mm = 0.0;           ///< half width that the metal has passed through, across
    double first_Ohm = 0.0, least_Ohm = 0.0, last_Ohm = 0.0;
    double rise_of_impedance = 1.0;  ///< largest ratio to the least before
    double imbalance = 0.0, delivered_J = 0.0;
    bool stopped = false;  ///< numerical trouble
    Points impedance;      ///< Ohm against s
    /// How far from the electrode's surface [mm] the top of present tissue is at least so hot, at the end.
    double spread_mm(double celsius) const;
    Points surface;  ///< C against mm from the electrode's surface, along the top, at the end, sorted
    Points peak;     ///< the same, hottest so far
};

struct TrialPlan {
    std::string scene;                                         ///< file in Options::scenes
    std::vector<std::string> assignments;                      ///< as `calot simulate --set`
    double until_s = 0.0;                                      ///< 0: the scene's end
    std::function<void(const simulation::Simulation&)> watch;  ///< after every tick, may be empty
    /// The hand that follows tissue as it recedes: from the first touch on it presses with this force, downwards, at
    /// most at 20 mm/s, and only while the pedal is down. 0: it goes where the script says.
    double rests_with_N = 0.0;
};

/// Throws InputError when the scene is missing or wrong.
Trial perform(const Options& options, const TrialPlan& plan);

/// Temperature [C] of the top of the tissue so far from the electrode's surface, now.
Points surface_temperature_C(const simulation::Simulation& run, bool peak);
/// The value of sorted points at x, the mean of those within 0.4.
double mean_at(const Points& points, double x);

}  // namespace calot::validation
