#include "calot/effects/smoke.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "calot/base/random.h"
#include "calot/effects/turbulence.h"

namespace calot::effects {

namespace {

// How smoke looks is tuned by eye; numbers that follow from something say so.
constexpr int kMoveEvery = 10;                    ///< ticks
constexpr double kPuff_kg = 5e-8;                 ///< 20 to 30 mg/s at 40 W and 1.5 1/s of suction: about 300 puffs
constexpr int kPuffsPerTick = 4;                  ///< the rest waits
constexpr double kApart_m = 5e-3;                 ///< gas this far from what is pending starts a puff of its own
constexpr float kStartRadius_m = 1.2e-3f;         ///< about two hexels
constexpr float kStartSpeed_m_per_s = 0.12f;      ///< off the tissue
constexpr double kDrag_per_s = 4.0;               ///< towards the speed of the air about it
constexpr float kAirSpeed_m_per_s = 0.03f;        ///< of the swirls
constexpr float kSwirl_m = 12e-3f;                ///< their size
constexpr float kSwirlDrift_per_s = 0.7f;         ///< how fast they change, in sizes a second
constexpr double kCooling_per_s = 2.0;            ///< buoyancy fades as cool gas mixes in
constexpr float kDiffusivity_m2_per_s = 2.5e-5f;  ///< vapour in carbon dioxide has 1.6e-5, small eddies add to it
constexpr double kFogEvaporation_per_s = 1.5;     ///< insufflated gas is dry
constexpr double kSuction_per_s = 3.5;            ///< by the surgeon's own suction, at full
constexpr float kOldest_s = 8.0f;
constexpr double kThinnest_kg = 0.02 * kPuff_kg;  ///< less mass than this cannot be seen
constexpr double kGas_K = 306.0, kBoiling_K = 373.0;

double mass(const SmokeParticle& particle) {
    return static_cast<double>(particle.steam) + static_cast<double>(particle.smoke);
}

}  // namespace

struct Smoke::Stride {
    float dt_s;
    Vec3f up, drift;                      ///< drift: where the swirls have moved to
    float slowed, cooled, spared, dried;  ///< what drag, cooling, suction and evaporation leave

    Stride(const SmokeParameters& parameters, double dt, double time_s, bool suction)
        : dt_s(static_cast<float>(dt)),
          up(parameters.up),
          drift(kSwirlDrift_per_s * static_cast<float>(time_s) * up),
          slowed(static_cast<float>(std::exp(-kDrag_per_s * dt))),
          cooled(static_cast<float>(std::exp(-kCooling_per_s * dt))),
          spared(static_cast<float>(std::exp(-(parameters.suction_per_s + (suction ? kSuction_per_s : 0.0)) * dt))),
          dried(static_cast<float>(std::exp(-kFogEvaporation_per_s * dt))) {}
};

OpticalDepth optical_depth(const SmokeParticle& particle) {
    const float area = 2.0f * 3.14159265f * particle.radius_m * particle.radius_m;
    return {kSteamExtinction_m2_per_kg * particle.steam / area, kSmokeExtinction_m2_per_kg * particle.smoke / area};
}

Smoke::Smoke(const SmokeParameters& parameters) : parameters_(parameters) {
    particles_.reserve(parameters.max_particles);
}

double Smoke::particles_kg() const {
    double sum = 0.0;
    for (const SmokeParticle& particle : particles_) sum += mass(particle);
    return sum;
}

void Smoke::step(const tissue::Exchange& exchange, const std::vector<Vec3f>& world_m, std::int64_t tick, double tick_s,
                 bool suction) {
    assert(world_m.size() >= exchange.gas.size());
    collect(exchange, world_m);

    const Stride stride(parameters_, kMoveEvery * tick_s, static_cast<double>(tick) * tick_s, suction);
    const auto turn = static_cast<std::uint32_t>(tick % kMoveEvery);
    SwirlBatch swirls;
    std::array<SmokeParticle*, SwirlBatch::kPlaces> moving;
    const auto is_over = [](const SmokeParticle& particle) {
        return particle.age_s > kOldest_s || mass(particle) < kThinnest_kg;
    };
    bool any_over = false;
    const auto move_all = [&] {
        curl_noise(swirls);
        for (std::size_t k = 0; k < swirls.count; ++k) {
            const Vec3f swirl(swirls.velocity[0][k], swirls.velocity[1][k], swirls.velocity[2][k]);
            move(*moving[k], stride, kAirSpeed_m_per_s * swirl);
            any_over = any_over || is_over(*moving[k]);
        }
        swirls.count = 0;
    };
    for (SmokeParticle& particle : particles_) {
        if (particle.seed % kMoveEvery != turn) continue;
        const Vec3f place = particle.position_m / kSwirl_m + stride.drift;
        for (int axis = 0; axis < 3; ++axis) swirls.place[static_cast<std::size_t>(axis)][swirls.count] = place[axis];
        moving[swirls.count++] = &particle;
        if (swirls.count == moving.size()) move_all();
    }
    move_all();
    if (any_over)
        std::erase_if(particles_, [&](const SmokeParticle& particle) {
            const bool over = particle.seed % kMoveEvery == turn && is_over(particle);
            if (over) faded_kg_ += mass(particle);
            return over;
        });

    // The fuller the room and the more gas waits, the larger the puffs; at the limit gas waits for a place.
    for (int puff = 0; puff < kPuffsPerTick && particles_.size() < parameters_.max_particles; ++puff) {
        const double filled = static_cast<double>(particles_.size()) / static_cast<double>(parameters_.max_particles);
        const double enough = std::max(kPuff_kg / std::max(0.1, 1.0 - filled), pending_kg() / 16.0);
        if (pending_kg() < enough) break;
        emit(puff + 1 == kPuffsPerTick ? pending_kg() : enough);
    }
    if (parameters_.max_particles == 0) {
        faded_kg_ += pending_kg();
        pending_ = {};
    }
}

void Smoke::collect(const tissue::Exchange& exchange, const std::vector<Vec3f>& world_m) {
    for (std::size_t k = 0; k < exchange.gas.size(); ++k) {
        const tissue::GasEvent& event = exchange.gas[k];
        const double steam = static_cast<double>(event.steam_kg), smoke = static_cast<double>(event.smoke_kg);
        const Vec3 place_m(world_m[k]);
        const double waiting = pending_kg();
        if (waiting > kThinnest_kg && particles_.size() < parameters_.max_particles &&
            glm::distance(pending_.moment_kgm / waiting, place_m) > kApart_m)
            emit(waiting);
        pending_.steam_kg += steam;
        pending_.smoke_kg += smoke;
        pending_.moment_kgm += (steam + smoke) * place_m;
        pending_.heat_kgK += (steam + smoke) * static_cast<double>(event.temperature_K);
        emitted_kg_ += steam + smoke;
    }
}

/// Turns part of what is pending into a puff.
void Smoke::emit(double mass_kg) {
    const double share = mass_kg / pending_kg();
    Random random(next_seed_, 0x5b0ce);
    auto jitter = [&](double size) {
        const double x = random.uniform(-size, size), y = random.uniform(-size, size);
        return Vec3(x, y, random.uniform(-size, size));
    };
    const Vec3 place_m = pending_.moment_kgm / pending_kg();
    const double temperature_K = pending_.heat_kgK / pending_kg();

    SmokeParticle particle;
    particle.seed = next_seed_++;
    particle.position_m = Vec3f(place_m + jitter(0.4e-3));
    const double start = static_cast<double>(kStartSpeed_m_per_s) * random.uniform(0.5, 1.2);
    particle.velocity_m_per_s = Vec3f(start * parameters_.up + jitter(0.3 * start));
    particle.radius_m = kStartRadius_m;
    particle.steam = static_cast<float>(share * pending_.steam_kg);
    particle.smoke = static_cast<float>(share * pending_.smoke_kg);
    // Lift by what the gas is warmer than its surroundings.
    const double warmth = std::clamp((temperature_K - kGas_K) / (kBoiling_K - kGas_K), 0.0, 4.0);
    particle.lift_m_per_s2 = static_cast<float>(parameters_.buoyancy_m_per_s2 * warmth);
    particles_.push_back(particle);

    // The particle's rounded masses leave, so that none is lost or made.
    pending_.steam_kg = std::max(0.0, pending_.steam_kg - static_cast<double>(particle.steam));
    pending_.smoke_kg = std::max(0.0, pending_.smoke_kg - static_cast<double>(particle.smoke));
    pending_.moment_kgm = pending_kg() * place_m;
    pending_.heat_kgK = pending_kg() * temperature_K;
}

void Smoke::move(SmokeParticle& particle, const Stride& stride, const Vec3f& air) {
    particle.velocity_m_per_s = air + stride.slowed * (particle.velocity_m_per_s - air);
    particle.velocity_m_per_s += stride.dt_s * particle.lift_m_per_s2 * stride.up;
    particle.position_m += stride.dt_s * particle.velocity_m_per_s;
    particle.lift_m_per_s2 *= stride.cooled;
    particle.radius_m = std::sqrt(particle.radius_m * particle.radius_m + 2.0f * kDiffusivity_m2_per_s * stride.dt_s);
    particle.age_s += stride.dt_s;

    const double before = mass(particle);
    particle.steam *= stride.spared;
    particle.smoke *= stride.spared;
    const double left = mass(particle);
    drawn_off_kg_ += before - left;
    particle.steam *= stride.dried;
    faded_kg_ += left - mass(particle);
}

void Smoke::archive(Archive& archive) {
    archive.value(particles_);
    archive.value(pending_);
    archive.value(emitted_kg_);
    archive.value(drawn_off_kg_);
    archive.value(faded_kg_);
    archive.value(next_seed_);
    if (particles_.size() > parameters_.max_particles) throw std::runtime_error("damaged archive");
}

}  // namespace calot::effects
