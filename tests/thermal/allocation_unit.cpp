// A heat step allocates nothing.

#include "calot/base/parallel.h"
#include "support/allocations.h"
#include "thermal/burn_bodies.h"

namespace calot::thermal {

TEST(HeatAllocations, StepsDoNotAllocate) {
    const ThreadLimit limit(1);
    HeatRun run(burn_model());
    while (run.state.tick < 800) {
        if (run.state.tick % 8 == 0) heat_spot(run, run.state.tick);
        const long before = calot::test::allocations();
        run.tick();
        ASSERT_EQ(calot::test::allocations() - before, 0) << "tick " << run.state.tick;
    }
    EXPECT_GT(run.state.hexels_burnt, 0);
}

}  // namespace calot::thermal
