#include "calot/scene/scene.h"

#include "calot/scene/keys.h"

namespace calot::scene {

Scene::Scene() : materials(tissue::default_materials()), material_like(materials.size()) {
    camera_eye.offset_m = Vec3(0.0, -0.03, 0.08);
    trocar.offset_m = Vec3(0.0, -0.08, 0.14);
    grasper_trocar.offset_m = Vec3(-0.08, 0.02, 0.12);
    script.push_back({0.0, {"", Vec3(0.0, 0.0, 0.03), {}}, 0.0});
    // Every value becomes one that a file can say: written out and read again, it is the same to the last bit.
    for (const Group& group : groups(*this)) {
        const std::size_t records = group.records ? group.records->size(*this) : 1;
        for (std::size_t k = 0; k < records; ++k) {
            void* record = group.records ? group.records->at(*this, k) : this;
            for (const Key& key : group.keys)
                if (const auto value = key.get(record)) key.set(record, *value);
        }
    }
}

}  // namespace calot::scene
