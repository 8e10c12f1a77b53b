#include "calot/render/smoke_sprites.h"

#include <algorithm>
#include <cmath>

namespace calot::render {

namespace {

// Mass extinction coefficients. Smoke of sub-micrometre particles: 4 to 9 m^2/g (soot and tar, e.g. Mulholland &
// Croarkin 2000: 8.7 m^2/g for flames). Steam: droplets of radius 3 um scatter 3 / (2 rho r) = 0.5 m^2/g. Lowered,
// since most of what boils off is vapour that is never seen and much of the smoke condenses nearby.
constexpr float kSmoke_m2_per_kg = 900.0f;
constexpr float kSteam_m2_per_kg = 60.0f;
constexpr float kMostOpticalDepth = 1.6f;

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
        sprite.radius_m = 1.6f * particle.radius_m;  // noise eats its rim
        const float area_m2 = 3.1416f * particle.radius_m * particle.radius_m;
        const float steam = kSteam_m2_per_kg * particle.steam / area_m2,
                    smoke = kSmoke_m2_per_kg * particle.smoke / area_m2;
        if (steam + smoke < 0.004f) continue;
        sprite.optical_depth = std::min(kMostOpticalDepth, steam + smoke);
        sprite.steam_share = steam / (steam + smoke);
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
