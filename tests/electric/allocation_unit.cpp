// Nothing is allocated inside a tick.

#include <gtest/gtest.h>

#include "calot/base/parallel.h"
#include "calot/validation/electric_rig.h"
#include "support/allocations.h"

namespace calot::electric {

TEST(Allocation, NoneInATick) {
    const ThreadLimit limit(1);
    Rig rig = held_rig(1e-2);
    const long before = calot::test::allocations();
    for (int k = 0; k < 16; ++k) {
        rig.state.hexel_present.clear(rig.model.hexels.index(10 + k, 22, 19));
        step_field(rig.model, rig.state, rig.exchange, rig.input, *rig.work);
        rig.solve();
        rig.input.pedal = k % 3 != 0;
        ++rig.state.tick;
    }
    EXPECT_EQ(calot::test::allocations(), before);
}

}  // namespace calot::electric
