#include "calot/effects/bleeding.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calot/base/random.h"
#include "calot/tissue/phase.h"

namespace calot::effects {

namespace {

// Tuned by eye against laparoscopic video unless a source is named.
constexpr double kPulse_per_s = 1.2;
constexpr double kFlow_m3_per_s = 0.6e-6;  ///< of a cystic artery cut through; 30 to 40 ml/min is brisk
constexpr double kDrop_m3 = 1.2e-9;        ///< about 1.3 mm across
constexpr float kSpurt_m_per_s = 0.55f;
constexpr float kGravity_m_per_s2 = 9.81f;
constexpr float kOldest_s = 1.5f;
constexpr float kOpeningPerHexel = 0.22f;  ///< a few hexels of wall are a hole as wide as the artery
constexpr double kSameBreach_m = 2.5e-3;
constexpr float kSealing_K = 343.0f;    ///< collagen shrinks and blood clots from 60 to 70 C on
constexpr float kSealingTime_s = 0.5f;  ///< of heat, until a hole is closed
constexpr int kSealEvery = 8;           ///< ticks
constexpr int kRunEvery = 8;            ///< ticks; an eighth of the wet hexels in each tick
constexpr float kThickest_m = 0.6e-3f;
constexpr float kThinnest_m = 4e-6f;  ///< less cannot be seen
constexpr float kStays_m = 25e-6f;    ///< clings and does not run
constexpr float kRunShare = 0.10f;    ///< of what is thicker, each time
constexpr float kFlattest = 0.15f;    ///< share of a step that goes down: less holds the film
constexpr float kFuller = 0.4f;       ///< as if ways to where the film is thicker fell by this much less
constexpr double kSuctionReach_m = 7e-3, kRinseReach_m = 6e-3;
constexpr float kSuctionTime_s = 0.12f, kRinseTime_s = 0.25f;
constexpr int kWaterDropsEvery = 3;  ///< ticks

/// Whether a face of a hexel lies open: only there can a film be seen, and run.
bool open_to_gas(const tissue::Model& model, const tissue::State& state, std::int64_t hexel) {
    if (!state.hexel_present.test(hexel)) return false;
    const Lattice& lattice = model.hexels;
    for (const int step : {lattice.stride.x, lattice.stride.y, lattice.stride.z})
        if (!state.hexel_present.test(hexel - step) || !state.hexel_present.test(hexel + step)) return true;
    return false;
}

/// A step to a neighbour, and how much of it goes down.
struct Way {
    Int3 step{0};
    float fall = 0.0f;
};

/// Those that go down at all, the steepest first.
class WaysDown {
  public:
    explicit WaysDown(const Vec3f& down) {
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    if (x == 0 && y == 0 && z == 0) continue;
                    const float fall = glm::dot(glm::normalize(Vec3f(x, y, z)), down);
                    if (fall > kFlattest) ways_[count_++] = {Int3(x, y, z), fall};
                }
        std::sort(ways_.begin(), ways_.begin() + static_cast<std::ptrdiff_t>(count_),
                  [](const Way& a, const Way& b) { return a.fall > b.fall; });
    }
    const Way* begin() const { return ways_.data(); }
    const Way* end() const { return ways_.data() + count_; }

  private:
    std::array<Way, 26> ways_;
    std::size_t count_ = 0;
};

}  // namespace

float pulse_at(double time_s) {
    const double phase = time_s * kPulse_per_s - std::floor(time_s * kPulse_per_s);
    auto wave = [&](double at, double width) { return std::exp(-(phase - at) * (phase - at) / (width * width)); };
    return static_cast<float>(std::min(1.0, wave(0.16, 0.10) + 0.40 * wave(0.42, 0.13)));
}

Bleeding::Bleeding(const tissue::Model& model) : artery_(model.materials.size(), false) {
    bool any = false;
    for (std::size_t k = 1; k < model.materials.size(); ++k) {
        artery_[k] = model.materials[k].name.find("artery") != std::string::npos;
        any = any || artery_[k];
    }
    breaches_.reserve(kMostBreaches);
    drops_.reserve(kMostDrops);
    if (!any) return;
    film_m_.assign(static_cast<std::size_t>(model.hexels.cells), 0.0f);
    wet_.reserve(kMostWet);
}

void Bleeding::step(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                    const tissue::Input& input) {
    if (film_m_.empty()) return;
    for (const std::int64_t hexel : exchange.removed_hexels) {
        film_m_[static_cast<std::size_t>(hexel)] = 0.0f;
        if (artery_[model.hexel_material[static_cast<std::size_t>(hexel)]]) open(model, hexel);
    }
    if (!breaches_.empty()) {
        if (state.tick % kSealEvery == 0) seal(model, state);
        spurt(model, state.tick);
    }
    if (input.irrigation) irrigate(input.hook, state.tick);
    if (!drops_.empty()) move_drops(model, state);
    if (!wet_.empty()) {
        run_down(model, state, state.tick);
        if (input.suction || input.irrigation) clean(model, input);
    }
}

void Bleeding::open(const tissue::Model& model, std::int64_t hexel) {
    const Vec3f place_m(model.hexels.centre_m(hexel));
    for (Breach& breach : breaches_) {
        if (glm::distance(breach.place_m, place_m) > static_cast<float>(kSameBreach_m)) continue;
        breach.opening = std::min(1.0f, breach.opening + kOpeningPerHexel);
        return;
    }
    if (breaches_.size() == kMostBreaches) return;
    breaches_.push_back({hexel, place_m, kOpeningPerHexel, 0.0});
}

/// Heat closes holes: what is coagulated about one seals it.
void Bleeding::seal(const tissue::Model& model, const tissue::State& state) {
    const Lattice& lattice = model.hexels;
    const float closed = static_cast<float>(kSealEvery * model.tick_s) / kSealingTime_s;
    for (Breach& breach : breaches_) {
        if (breach.opening <= 0.0f) continue;
        const Int3 cell = lattice.coordinates(breach.hexel);
        int hot = 0, present = 0;
        for (int z = -kSealReach; z <= kSealReach; ++z)
            for (int y = -kSealReach; y <= kSealReach; ++y)
                for (int x = -kSealReach; x <= kSealReach; ++x) {
                    const Int3 at = cell + Int3(x, y, z);
                    if (!lattice.contains(at)) continue;
                    const std::int64_t hexel = lattice.index(at);
                    if (!state.hexel_present.test(hexel)) continue;
                    ++present;
                    hot += tissue::temperature_K(model, state, hexel) > kSealing_K;
                }
        if (present > 0)
            breach.opening =
                std::max(0.0f, breach.opening - closed * static_cast<float>(hot) / static_cast<float>(present));
    }
}

void Bleeding::spurt(const tissue::Model& model, std::int64_t tick) {
    const double time_s = static_cast<double>(tick) * model.tick_s;
    const double pressure = 0.25 + 0.75 * static_cast<double>(pulse_at(time_s));
    flow_m3_per_s_ = 0.0;
    for (Breach& breach : breaches_) {
        const double flow = kFlow_m3_per_s * static_cast<double>(breach.opening) * pressure;
        flow_m3_per_s_ += flow;
        breach.waiting_m3 += flow * model.tick_s;
        if (breach.waiting_m3 < kDrop_m3) continue;
        breach.waiting_m3 -= kDrop_m3;
        Random random(emitted_, 0xb100d);
        auto jitter = [&](double size) { return static_cast<float>(random.uniform(-size, size)); };
        BloodDrop drop;
        drop.position_m = breach.place_m - 0.4e-3f * down_;
        const float speed = kSpurt_m_per_s * static_cast<float>(pressure) * (0.6f + 0.4f * breach.opening);
        drop.velocity_m_per_s = speed * glm::normalize(-down_ + Vec3f(jitter(0.35), jitter(0.35), jitter(0.35)));
        drop.radius_m = 0.65e-3f * static_cast<float>(random.uniform(0.6, 1.1));
        emit(drop);
    }
    lost_m3_ += flow_m3_per_s_ * model.tick_s;
}

/// Water from the hook's channel: a thin stream along the shaft.
void Bleeding::irrigate(const tissue::Pose& hook, std::int64_t tick) {
    if (tick % kWaterDropsEvery != 0) return;
    Random random(emitted_, 0x3a7e2);
    auto jitter = [&](double size) { return static_cast<float>(random.uniform(-size, size)); };
    const Vec3f along(hook.orientation * Vec3(0.0, 0.0, 1.0));
    BloodDrop drop;
    drop.water = true;
    drop.position_m = Vec3f(hook.position_m) - 9e-3f * along;
    drop.velocity_m_per_s = 0.9f * glm::normalize(along + Vec3f(jitter(0.06), jitter(0.06), jitter(0.06)));
    drop.radius_m = 0.5e-3f * static_cast<float>(random.uniform(0.7, 1.3));
    emit(drop);
}

void Bleeding::emit(const BloodDrop& drop) {
    ++emitted_;
    if (drops_.size() < kMostDrops) drops_.push_back(drop);
}

/// Drops fall until they meet tissue (at rest: it hardly moves compared with them) or an organ.
void Bleeding::move_drops(const tissue::Model& model, const tissue::State& state) {
    const auto dt_s = static_cast<float>(model.tick_s);
    const Lattice& lattice = model.hexels;
    std::size_t kept = 0;
    for (BloodDrop& drop : drops_) {
        drop.velocity_m_per_s += dt_s * kGravity_m_per_s2 * down_;
        drop.position_m += dt_s * drop.velocity_m_per_s;
        drop.age_s += dt_s;
        const Vec3 cell = (Vec3(drop.position_m) - lattice.origin_m) / lattice.spacing_m;
        const Int3 at(static_cast<int>(std::floor(cell.x)), static_cast<int>(std::floor(cell.y)),
                      static_cast<int>(std::floor(cell.z)));
        bool landed = drop.age_s > kOldest_s;
        if (lattice.contains(at) && state.hexel_present.test(lattice.index(at))) {
            landed = true;
            const double volume = 4.0 / 3.0 * 3.14159265 * std::pow(static_cast<double>(drop.radius_m), 3);
            // Splashed over the hexels about it.
            const auto thickness = static_cast<float>(volume / (9.0 * lattice.spacing_m * lattice.spacing_m));
            for (int z = -1; z <= 1; ++z)
                for (int y = -1; y <= 1; ++y)
                    for (int x = -1; x <= 1; ++x) {
                        const Int3 near = at + Int3(x, y, z);
                        if (!lattice.contains(near) || !open_to_gas(model, state, lattice.index(near))) continue;
                        if (drop.water)
                            film_m_[static_cast<std::size_t>(lattice.index(near))] *= 0.8f;
                        else
                            wet(lattice.index(near), thickness);
                    }
        }
        if (!landed) drops_[kept++] = drop;
    }
    drops_.resize(kept);
}

void Bleeding::wet(std::int64_t hexel, float thickness_m) {
    float& film = film_m_[static_cast<std::size_t>(hexel)];
    if (film == 0.0f && thickness_m > 0.0f) {
        if (wet_.size() == kMostWet) return;
        wet_.push_back(static_cast<std::int32_t>(hexel));
    }
    film = std::min(kThickest_m, film + thickness_m);
}

/// A film runs to the hexels that lie lower; what is thin clings.
void Bleeding::run_down(const tissue::Model& model, const tissue::State& state, std::int64_t tick) {
    const Lattice& lattice = model.hexels;
    const WaysDown ways(down_);
    const auto turn = static_cast<std::size_t>(tick % kRunEvery);
    const std::size_t count = wet_.size();
    for (std::size_t k = turn; k < count; k += kRunEvery) {
        const std::int64_t hexel = wet_[k];
        float& film = film_m_[static_cast<std::size_t>(hexel)];
        if (!state.hexel_present.test(hexel)) film = 0.0f;
        if (film <= kStays_m) continue;
        const Int3 cell = lattice.coordinates(hexel);
        std::int64_t best = -1;
        float steepest = kFlattest;
        for (const Way& way : ways) {
            if (way.fall <= steepest) break;
            const Int3 at = cell + way.step;
            if (!lattice.contains(at)) continue;
            const std::int64_t next = lattice.index(at);
            const float fall = film_m_[static_cast<std::size_t>(next)] < film ? way.fall : kFuller * way.fall;
            if (fall > steepest && open_to_gas(model, state, next)) steepest = fall, best = next;
        }
        if (best < 0) continue;
        const float moved = kRunShare * (film - kStays_m);
        film -= moved;
        wet(best, moved);
    }
    // Dry ones leave the list, a part of it each time.
    std::size_t kept = 0;
    if (turn == 0) {
        for (const std::int32_t hexel : wet_) {
            float& film = film_m_[static_cast<std::size_t>(hexel)];
            if (film < kThinnest_m)
                film = 0.0f;
            else
                wet_[kept++] = hexel;
        }
        wet_.resize(kept);
    }
}

/// Suction and irrigation about the hook's tip.
void Bleeding::clean(const tissue::Model& model, const tissue::Input& input) {
    const auto dt_s = static_cast<float>(model.tick_s);
    const float drawn = std::exp(-dt_s / kSuctionTime_s), rinsed = std::exp(-dt_s / kRinseTime_s);
    for (const std::int32_t hexel : wet_) {
        const double far = glm::distance(model.hexels.centre_m(hexel), input.hook.position_m);
        float& film = film_m_[static_cast<std::size_t>(hexel)];
        if (input.suction && far < kSuctionReach_m) film *= drawn;
        if (input.irrigation && far < kRinseReach_m) film *= rinsed;
    }
}

void Bleeding::archive(Archive& archive) {
    archive.value(breaches_);
    archive.value(drops_);
    archive.value(flow_m3_per_s_);
    archive.value(lost_m3_);
    archive.value(emitted_);
    if (archive.reading())
        for (const std::int32_t hexel : wet_) film_m_[static_cast<std::size_t>(hexel)] = 0.0f;
    archive.value(wet_);
    if (breaches_.size() > kMostBreaches || drops_.size() > kMostDrops || wet_.size() > kMostWet)
        throw std::runtime_error("damaged archive");
    for (const std::int32_t hexel : wet_) {
        if (hexel < 0 || static_cast<std::size_t>(hexel) >= film_m_.size()) throw std::runtime_error("damaged archive");
        archive.value(film_m_[static_cast<std::size_t>(hexel)]);
    }
}

}  // namespace calot::effects
