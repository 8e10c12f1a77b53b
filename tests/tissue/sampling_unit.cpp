#include "calot/tissue/sampling.h"

#include <gtest/gtest.h>

#include "calot/anatomy/block.h"
#include "calot/base/error.h"
#include "calot/tissue/state.h"

namespace calot::tissue {

TEST(Sampling, BlockHasTheHexelsOfItsVolume) {
    const Model model = sample(anatomy::make_block({.size_m = Vec3(0.024, 0.0192, 0.0096)}), {});
    EXPECT_EQ(model.hexel_initial.count(), 40 * 32 * 16);
    EXPECT_EQ(model.phyxel_initial.count(), 10 * 8 * 4);
    // Ghosts: the layer below, and its ring (edge neighbours) outside.
    EXPECT_EQ(model.phyxel_ghost.count(), 12 * 10 - 4);
    EXPECT_EQ(model.deformation.substeps, 3);
}

TEST(Sampling, RefusesWhatItCannotSample) {
    EXPECT_THROW(sample(anatomy::make_block({}), {.hexels_per_edge = 3}), InputError);
    EXPECT_THROW(sample(anatomy::make_block({.material = "cheese"}), {}), InputError);
}

TEST(State, HashSeesEveryField) {
    const Model model = sample(anatomy::make_block({.size_m = Vec3(0.0048)}), {});
    State state = State::make(model);
    const auto before = hash(state);
    for (const Field& field : fields(state)) {
        auto* byte = static_cast<unsigned char*>(field.data);
        byte[field.bytes / 2] ^= 1;
        EXPECT_NE(hash(state), before) << field.name;
        byte[field.bytes / 2] ^= 1;
    }
    EXPECT_EQ(hash(state), before);
}

}  // namespace calot::tissue
