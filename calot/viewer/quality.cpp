#include "calot/viewer/quality.h"

#include <cstring>

namespace calot::viewer {

namespace {

constexpr int kLeastPictures = 8;    ///< before a tier is judged: the first ones compile shaders
constexpr double kQuickFor_s = 2.0;  ///< so long before a finer tier is tried
constexpr double kTryAgain_s = 60.0;

}  // namespace

const std::vector<Tier>& tiers() {
    using render::Quality;
    static const std::vector<Tier> list{{Quality::low, 0.35}, {Quality::low, 0.5},     {Quality::low, 0.7},
                                        {Quality::low, 1.0},  {Quality::medium, 0.75}, {Quality::medium, 1.0},
                                        {Quality::high, 1.0}};
    return list;
}

bool QualityGovernor::add(double draw_s, double now_s) {
    ++counted_;
    if (counted_ <= 2) return false;
    mean_s_ = counted_ == 3 ? draw_s : mean_s_ + 0.15 * (draw_s - mean_s_);
    if (!automatic_ || counted_ < kLeastPictures) return false;
    if (mean_s_ > kTooSlow_s && tier_ > 0) {
        too_fine_ = tier_--;
        too_fine_until_s_ = now_s + kTryAgain_s;
        counted_ = 0;
        return true;
    }
    if (mean_s_ > kQuick_s) {
        quick_since_s_ = -1.0;
        return false;
    }
    if (quick_since_s_ < 0.0) quick_since_s_ = now_s;
    const bool tried = tier_ + 1 >= too_fine_ && now_s < too_fine_until_s_;
    if (now_s - quick_since_s_ < kQuickFor_s || tier_ + 1 >= static_cast<int>(tiers().size()) || tried) return false;
    ++tier_;
    counted_ = 0;
    quick_since_s_ = -1.0;
    return true;
}

int start_tier(const char* renderer) {
    const bool software = std::strstr(renderer, "llvmpipe") != nullptr ||
                          std::strstr(renderer, "softpipe") != nullptr ||
                          std::strstr(renderer, "SwiftShader") != nullptr;
    return software ? 1 : 5;
}

}  // namespace calot::viewer
