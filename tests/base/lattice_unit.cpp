#include "calot/base/lattice.h"

#include <gtest/gtest.h>

#include "calot/base/array.h"

namespace calot {

TEST(Lattice, IndexAndCoordinatesAreInverse) {
    const Lattice lattice = Lattice::make(Vec3(1.0, 2.0, 3.0), 0.5, Int3(5, 3, 7));
    for (int z = 0; z < 7; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 5; ++x) EXPECT_EQ(lattice.coordinates(lattice.index(x, y, z)), Int3(x, y, z));
}

TEST(Lattice, ShortestAxisIsFastest) {
    const Lattice lattice = Lattice::make(Vec3(0.0), 1.0, Int3(5, 3, 7));
    EXPECT_EQ(lattice.stride.y, 1);
    EXPECT_EQ(lattice.stride.x, 4);
    EXPECT_EQ(lattice.stride.z, 24);
}

// Filled cells have distinct indices; every neighbour outside the box is a border cell, inside the array, never filled.
TEST(Lattice, BordersAreNeverFilledCells) {
    const Lattice lattice = Lattice::make(Vec3(0.0), 1.0, Int3(4, 2, 3));
    BitArray filled(lattice.cells);
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 4; ++x) {
                ASSERT_FALSE(filled.test(lattice.index(x, y, z)));
                filled.set(lattice.index(x, y, z));
            }
    for (int z = -1; z <= 3; ++z)
        for (int y = -1; y <= 2; ++y)
            for (int x = -1; x <= 4; ++x) {
                const auto index = lattice.index(x, y, z);
                ASSERT_GE(index, 0);
                ASSERT_LT(index + 64, lattice.cells);
                EXPECT_EQ(filled.test(index), lattice.contains({x, y, z}));
            }
}

TEST(BitArray, ReadsUnalignedRuns) {
    BitArray bits(200);
    bits.set(13);
    bits.set(70);
    bits.set(199);
    EXPECT_EQ(bits.bits32(13), 1u);
    EXPECT_EQ(bits.bits32(40), 1u << 30);
    EXPECT_EQ(bits.bits32(198), 2u);
    EXPECT_EQ(bits.count(), 3);
}

}  // namespace calot
