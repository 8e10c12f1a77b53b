// Calot's triangle on the two lattices.

#include <gtest/gtest.h>

#include "calot/anatomy/calots_triangle.h"
#include "calot/base/hash.h"
#include "calot/base/parallel.h"
#include "calot/tissue/sampling.h"

namespace calot::tissue {

namespace {

/// The material that the definition of sampling gives a point, and whether an organ holds there.
struct Truth {
    MaterialIndex material = kNoMaterial;
    bool held = false;
};
Truth truth_at(const anatomy::Anatomy& anatomy, const Model& model, const Vec3& p) {
    Truth truth;
    const bool in_field =
        glm::all(glm::greaterThanEqual(p, anatomy.field.low)) && glm::all(glm::lessThanEqual(p, anatomy.field.high));
    for (const auto& tissue : anatomy.tissues)
        if (in_field && tissue.shape->distance_m(p) < 0.0)
            truth.material = find_material(model.materials, tissue.material);
    if (truth.material == kNoMaterial)
        for (const auto& organ : anatomy.organs) truth.held |= organ.holds_tissue && organ.shape->distance_m(p) < 0.0;
    return truth;
}

}  // namespace

TEST(SampleTriangle, SkippingBlocksChangesNothing) {
    const anatomy::Anatomy anatomy = anatomy::make_calots_triangle({.seed = 4, .double_artery = true});
    const Model model = sample(anatomy, {.hexel_spacing_m = 1.0e-3, .hexels_per_edge = 2});
    for (int z = 0; z < model.hexels.size.z; ++z)
        for (int y = 0; y < model.hexels.size.y; ++y)
            for (int x = 0; x < model.hexels.size.x; ++x) {
                const std::int64_t cell = model.hexels.index(x, y, z);
                const Truth truth = truth_at(anatomy, model, model.hexels.centre_m(Int3(x, y, z)));
                ASSERT_EQ(model.hexel_material[static_cast<std::size_t>(cell)], truth.material);
                ASSERT_EQ(model.hexel_held.test(cell), truth.held);
            }
}

TEST(SampleTriangle, StandardPatientHasTheStandardSize) {
    const anatomy::Anatomy anatomy = anatomy::make_calots_triangle({});
    const Model model = sample(anatomy, {});
    EXPECT_GT(model.hexel_initial.count(), 140'000);
    EXPECT_LT(model.hexel_initial.count(), 155'000);
    EXPECT_GT(model.phyxel_initial.count(), 2'900);
    EXPECT_LT(model.phyxel_initial.count(), 3'600);
    EXPECT_GT(model.phyxel_ghost.count(), 300);
    // All three tissues are there, in plausible volumes: a duct of 29 mm by 3.7 mm is 310 mm^3 or 1400 hexels, an
    // artery of 28 mm by 1.7 mm 64 mm^3 or 290 hexels.
    std::vector<int> hexels(model.materials.size(), 0);
    for (MaterialIndex material : model.hexel_material) ++hexels[material];
    EXPECT_NEAR(hexels[find_material(model.materials, "cystic_duct")], 1400, 300);
    EXPECT_NEAR(hexels[find_material(model.materials, "cystic_artery")], 290, 90);
}

TEST(SampleTriangle, IsTheSameForAnyNumberOfThreads) {
    const anatomy::Anatomy anatomy = anatomy::make_calots_triangle({.seed = 8});
    auto fingerprint = [&] {
        const Model model = sample(anatomy, {.hexel_spacing_m = 0.8e-3});
        return hash_bytes(model.hexel_material.data(), model.hexel_material.size());
    };
    const std::uint64_t many = fingerprint();
    const ThreadLimit one(1);
    EXPECT_EQ(fingerprint(), many);
}

/// The body is held at its back and sides, and free in front.
TEST(SampleTriangle, IsHeldBehindAndFreeInFront) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Model model =
            sample(anatomy::make_calots_triangle({.seed = seed}), {.hexel_spacing_m = 1.2e-3, .hexels_per_edge = 2});
        int behind = 0, beside = 0, front_held = 0, front_free = 0;
        for (int z = 0; z < model.hexels.size.z; ++z)
            for (int y = 0; y < model.hexels.size.y; ++y)
                for (int x = 0; x < model.hexels.size.x; ++x) {
                    const std::int64_t cell = model.hexels.index(x, y, z);
                    if (!model.hexel_initial.test(cell)) continue;
                    auto held = [&](const Int3& d) { return model.hexel_held.test(cell + model.hexels.offset(d)); };
                    behind += held({0, 0, -1});
                    beside += held({1, 0, 0}) || held({-1, 0, 0}) || held({0, 1, 0});
                    const std::int64_t front = cell + model.hexels.offset({0, 0, 1});
                    front_held += model.hexel_held.test(front);
                    front_free += !model.hexel_held.test(front) && !model.hexel_initial.test(front);
                }
        EXPECT_GT(behind, 300) << seed;
        EXPECT_GT(beside, 150) << seed;
        // Only the wedge of fat under the slope of the liver has something in front of it.
        EXPECT_GT(front_free, 2 * front_held) << seed;
    }
}

}  // namespace calot::tissue
