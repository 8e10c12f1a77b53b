// Pictures that are made in parts while the simulation goes on.

#include "calot/viewer/picture.h"

#include <gtest/gtest.h>

#include "viewer/small_scene.h"

namespace calot::viewer {
namespace {

/// A hook that presses into a small block and burns.
struct Burning {
    std::shared_ptr<const simulation::Setup> setup =
        std::make_shared<const simulation::Setup>(scene::build(scene::parse(
            std::string(test::kSmallScene) +
                "[[script.key]]\nt = 0.05\noffset_mm = [0, 0, 0]\n[[script.key]]\nt = 0.6\noffset_mm = [1.5, 0, -1.5]\n"
                "[[script.burst]]\nfrom = 0.06\nto = 0.6\npower_W = 40\n",
            "small.toml", ".")));
    simulation::Simulation run{setup};

    void go_on(int ticks) {
        for (int k = 0; k < ticks; ++k) EXPECT_TRUE(run.tick(setup->script.at(run.time_s())));
    }
};

TEST(Picture, shows_tissue_where_it_was_when_it_was_begun) {
    Burning body;
    const simulation::Simulation& run = body.run;
    Picture picture(run.setup());
    Moment moment;
    render::View view;
    Placer placer;
    std::int64_t burnt = 0;
    float moved_m = 0.0f;
    for (int round = 0; round < 12; ++round) {
        body.go_on(40);
        burnt = run.state().hexels_burnt;
        // As it is now, by the simulation itself.
        simulation::WorldSurface expected;
        run.world_surface(expected);
        const std::vector<std::uint32_t> triangles = run.surface().smooth_mesh().index;
        const std::vector<Vec3f> rest_m = run.surface().smooth_mesh().position_m;

        picture.begin(run, {}, moment, view);
        do body.go_on(1);
        while (!picture.go_on(run, 200, moment, view));
        placer.place(moment, view);
        ASSERT_EQ(view.tissue.size(), expected.position_m.size());
        EXPECT_EQ(view.tissue_index, triangles);
        for (std::size_t v = 0; v < view.tissue.size(); ++v) {
            ASSERT_LT(glm::distance(view.tissue[v].world_m, expected.position_m[v]), 1e-7f) << "vertex " << v;
            ASSERT_EQ(view.tissue[v].rest_m, rest_m[v]);
            ASSERT_NEAR(glm::length(view.tissue[v].normal), 1.0f, 1e-5f);
            moved_m = std::max(moved_m, glm::distance(view.tissue[v].world_m, rest_m[v]));
        }
        // Placed once: a second time changes nothing.
        const std::vector<render::TissueVertex> placed = view.tissue;
        placer.place(moment, view);
        EXPECT_EQ(placed.front().world_m, view.tissue.front().world_m);
    }
    EXPECT_GT(burnt, 0);
    EXPECT_GT(moved_m, 1e-4f);
}

// A slot of a buffer of several is behind by some pictures: it takes the surface over when it has another one.
TEST(Picture, slots_that_are_used_in_turn_agree) {
    Burning body;
    const simulation::Simulation& run = body.run;
    Picture picture(run.setup());
    Moment moments[2];
    render::View views[2];
    Placer placer;
    for (int round = 0; round < 6; ++round) {
        body.go_on(80);
        for (std::size_t slot = 0; slot < 2; ++slot) {
            if (slot == 1 && round % 2 == 1) continue;
            picture.begin(run, {}, moments[slot], views[slot]);
            while (!picture.go_on(run, 1000, moments[slot], views[slot])) {
            }
            placer.place(moments[slot], views[slot]);
        }
        if (round % 2 == 1) continue;
        ASSERT_EQ(views[0].tissue_index, views[1].tissue_index);
        for (std::size_t v = 0; v < views[0].tissue.size(); ++v)  // by stencils or by kept weights: to rounding
            ASSERT_LT(glm::distance(views[0].tissue[v].world_m, views[1].tissue[v].world_m), 1e-7f);
    }
    EXPECT_GT(run.state().hexels_burnt, 0);
}

}  // namespace
}  // namespace calot::viewer
