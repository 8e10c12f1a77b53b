#include "calot/render/drop_sprites.h"

#include <algorithm>
#include <cmath>

namespace calot::render {

void make_drops(const View& view, std::vector<DropSprite>& sprites) {
    sprites.clear();
    if (view.drops.empty()) return;
    const Vec3f axis(glm::normalize(view.camera.target_m - view.camera.eye_m));
    const Vec3f side = glm::normalize(glm::cross(axis, Vec3f(view.camera.up)));
    const Vec3f above = glm::cross(side, axis);
    for (const effects::BloodDrop& drop : view.drops) {
        const float x = glm::dot(drop.velocity_m_per_s, side), y = glm::dot(drop.velocity_m_per_s, above);
        const float speed = std::sqrt(x * x + y * y);
        DropSprite sprite{};
        sprite.world_m = drop.position_m;
        sprite.radius_m = drop.radius_m;
        sprite.along_x = speed > 1e-4f ? x / speed : 1.0f;
        sprite.along_y = speed > 1e-4f ? y / speed : 0.0f;
        sprite.stretch = std::min(2.5f, 3.0f * speed);  // what a video frame blurs
        sprite.water = drop.water ? 1.0f : 0.0f;
        sprites.push_back(sprite);
    }
}

}  // namespace calot::render
