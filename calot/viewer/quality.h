#pragma once
// How finely pictures are drawn, so that they come quickly enough on any machine.

#include <vector>

#include "calot/render/view.h"

namespace calot::viewer {

struct Tier {
    render::Quality quality;
    double scale;  ///< pixels drawn per pixel shown, along each edge
};
/// From coarse to fine.
const std::vector<Tier>& tiers();

/// Chooses a tier by how long pictures take. Pure: told the times, it reads no clock.
class QualityGovernor {
  public:
    explicit QualityGovernor(int start_tier) : tier_(start_tier) {}
    /// A picture took `draw_s`, at `now_s`. True when the tier changed.
    bool add(double draw_s, double now_s);
    int tier() const { return tier_; }
    void fix(int tier) { tier_ = tier, automatic_ = false; }
    void release() { automatic_ = true; }
    bool automatic() const { return automatic_; }
    double mean_s() const { return mean_s_; }

    static constexpr double kTooSlow_s = 1.0 / 24.0;  ///< coarser above this
    static constexpr double kQuick_s = 1.0 / 100.0;   ///< finer below this
  private:
    int tier_;
    bool automatic_ = true;
    double mean_s_ = 0.0;
    int counted_ = 0;  ///< pictures since the last change
    double quick_since_s_ = -1.0;
    int too_fine_ = 1000;            ///< a tier that was too slow ...
    double too_fine_until_s_ = 0.0;  ///< ... and is not tried again before
};

/// Where to start: software renderers coarse, others fine.
int start_tier(const char* renderer);

}  // namespace calot::viewer
