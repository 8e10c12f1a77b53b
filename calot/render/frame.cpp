#include "calot/render/frame.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "calot/base/random.h"
#include "calot/effects/bleeding.h"

namespace calot::render {

namespace {

constexpr double kFramesPerSecond = 30.0;  ///< of flicker and grain

double distance_to(const tissue::Capsule& capsule, const Vec3& p) {
    const Vec3 e = capsule.b_m - capsule.a_m;
    const double t = std::clamp(glm::dot(p - capsule.a_m, e) / std::max(1e-18, glm::dot(e, e)), 0.0, 1.0);
    return glm::length(p - capsule.a_m - t * e) - capsule.radius_m;
}

/// Where the spark is: the hottest tissue that touches bare metal (within 0.8 mm). Strength 0 when there is none.
glm::vec4 find_spark(const View& view, std::int64_t frame) {
    if (!view.energised) return glm::vec4(0.0f);
    constexpr double kReach_m = 0.8e-3;
    Vec3f best(0.0f);
    float best_score = -1.0f;
    for (const tissue::Capsule& capsule : view.instrument) {
        if (!capsule.bare) continue;
        const Vec3 low = glm::min(capsule.a_m, capsule.b_m) - (capsule.radius_m + kReach_m);
        const Vec3 high = glm::max(capsule.a_m, capsule.b_m) + (capsule.radius_m + kReach_m);
        for (const TissueVertex& vertex : view.tissue) {
            const Vec3 p(vertex.world_m);
            if (glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high))) continue;
            if (distance_to(capsule, p) > kReach_m) continue;
            // The arc jumps about: hotter spots are likelier, chance decides among them.
            Random random(static_cast<std::uint64_t>(frame), static_cast<std::uint64_t>(&vertex - view.tissue.data()));
            const float score =
                std::max(1.0f, vertex.temperature_K - 300.0f) * static_cast<float>(0.4 + 0.6 * random.uniform());
            if (score > best_score) {
                best_score = score;
                best = vertex.world_m + 0.0002f * vertex.normal;
            }
        }
    }
    if (best_score < 0.0f) return glm::vec4(0.0f);
    Random flicker(static_cast<std::uint64_t>(frame), 7);
    return glm::vec4(best, static_cast<float>(0.35 + 0.65 * flicker.uniform()));
}

}  // namespace

FrameUniforms make_frame(const View& view, int width, int height) {
    const Camera& camera = view.camera;
    FrameUniforms frame{};
    // The round image's diameter in pixels; the field of view is measured across it.
    const double diameter = std::min<double>(kRoundOverHeight * height, width);
    const double tangent = std::tan(0.5 * glm::radians(camera.field_of_view_deg));
    const double tan_x = tangent * width / diameter, tan_y = tangent * height / diameter;
    const double top = kNear_m * tan_y, right = kNear_m * tan_x;
    const glm::dmat4 look = glm::lookAt(camera.eye_m, camera.target_m, camera.up);
    const glm::dmat4 projection = glm::frustum(-right, right, -top, top, kNear_m, kFar_m);
    frame.view = glm::mat4(look);
    frame.view_projection = glm::mat4(projection * look);

    const Vec3 axis = glm::normalize(camera.target_m - camera.eye_m);
    const Vec3 side = glm::normalize(glm::cross(axis, camera.up)), above = glm::cross(side, axis);
    const double distance_m = glm::length(camera.target_m - camera.eye_m);
    const auto frame_number = static_cast<std::int64_t>(std::floor(view.time_s * kFramesPerSecond + 1e-6));
    frame.eye = glm::vec4(Vec3f(camera.eye_m), static_cast<float>(view.time_s));
    frame.axis = glm::vec4(Vec3f(axis), static_cast<float>(distance_m));
    // Fibres end in two crescents beside the lens; the upper left one is brighter.
    frame.light[0] = glm::vec4(Vec3f(camera.eye_m - 0.0045 * side + 0.0045 * above), 0.68f);
    frame.light[1] = glm::vec4(Vec3f(camera.eye_m + 0.0045 * side - 0.0030 * above), 0.36f);
    frame.spark = find_spark(view, frame_number);
    frame.projection = glm::vec4(static_cast<float>(tan_x), static_cast<float>(tan_y), static_cast<float>(kNear_m),
                                 static_cast<float>(kFar_m));
    frame.round = glm::vec4(static_cast<float>(diameter / width), static_cast<float>(diameter / height),
                            static_cast<float>(kBarrel), effects::pulse_at(view.time_s));
    frame.pixels = glm::vec4(static_cast<float>(width), static_cast<float>(height), 1.0f / static_cast<float>(width),
                             1.0f / static_cast<float>(height));
    for (std::size_t k = 0; k < kMaxCapsules; ++k) {
        frame.capsule_a[k] = glm::vec4(0.0f, 0.0f, 1e3f, 1e-6f);  // far away: casts none
        frame.capsule_b[k] = glm::vec4(0.0f, 1.0f, 1e3f, 0.0f);
        if (k >= view.instrument.size()) continue;
        const tissue::Capsule& capsule = view.instrument[k];
        frame.capsule_a[k] = glm::vec4(Vec3f(capsule.a_m), static_cast<float>(capsule.radius_m));
        frame.capsule_b[k] = glm::vec4(Vec3f(capsule.b_m), capsule.bare ? 1.0f : 0.0f);
    }
    frame.lens = glm::vec4(view.lens.fog, view.lens.smear, view.lens.seed, 0.0f);
    frame.counts = glm::ivec4(static_cast<int>(view.paint), static_cast<int>(frame_number % 64), 0, 0);
    return frame;
}

}  // namespace calot::render
