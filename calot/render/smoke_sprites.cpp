#include "calot/render/smoke_sprites.h"

#include <algorithm>
#include <cmath>

namespace calot::render {

namespace {

/// Half a billboard's edge, in standard deviations of the puff: 95 % of a Gaussian seen from the front lies within.
constexpr float kReachInRadii = 2.45f;
/// Share of the puffs' optical depth that is drawn: all of it would hide the field as a wall. Droplets scatter forward,
/// so that much of what they take from the straight beam arrives all the same; and a scope sees through thin gaps that
/// puffs are too coarse to have. Chosen by eye.
constexpr float kDrawnShare = 0.35f;
constexpr float kLeastOpticalDepth = 0.004f;
constexpr float kMostOpticalDepth = 1.0f;

}  // namespace

void make_sprites(const View& view, std::vector<SmokeSprite>& sprites) {
    sprites.clear();
    const Vec3f axis(glm::normalize(view.camera.target_m - view.camera.eye_m));
    const Vec3f side = glm::normalize(glm::cross(axis, Vec3f(view.camera.up)));
    const Vec3f above = glm::cross(side, axis);
    for (const effects::SmokeParticle& particle : view.smoke) {
        if (particle.radius_m <= 0.0f) continue;
        SmokeSprite sprite{};
        sprite.world_m = particle.position_m;
        sprite.radius_m = kReachInRadii * particle.radius_m;
        const effects::OpticalDepth depth = effects::optical_depth(particle);
        const float sum = depth.steam + depth.smoke;
        if (sum < kLeastOpticalDepth) continue;
        sprite.optical_depth = std::min(kMostOpticalDepth, kDrawnShare * sum);
        sprite.steam_share = depth.steam / sum;
        sprite.age_s = particle.age_s;
        sprite.seed = static_cast<float>(particle.seed % 65521u) / 65521.0f;
        const float x = glm::dot(particle.velocity_m_per_s, side), y = glm::dot(particle.velocity_m_per_s, above);
        const float speed = std::sqrt(x * x + y * y);
        sprite.along_x = speed > 1e-4f ? x / speed : 0.0f;
        sprite.along_y = speed > 1e-4f ? y / speed : 1.0f;
        sprite.stretch = std::min(1.2f, 12.0f * speed);
        sprites.push_back(sprite);
    }
    auto depth = [&](const SmokeSprite& s) { return glm::dot(s.world_m, axis); };
    std::stable_sort(sprites.begin(), sprites.end(),
                     [&](const SmokeSprite& a, const SmokeSprite& b) { return depth(a) > depth(b); });
}

}  // namespace calot::render
