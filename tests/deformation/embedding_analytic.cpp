// Embedding of points: exact on linear displacements, continuous between cells, never across severed links.
#include "calot/deformation/embedding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include "calot/anatomy/block.h"
#include "calot/base/parallel.h"
#include "calot/base/random.h"
#include "calot/deformation/embedded_points.h"
#include "calot/deformation/topology.h"
#include "calot/tissue/sampling.h"

namespace calot::deformation {

namespace {

// Displacements are a few millimetres in single precision: 1e-6 of a centimetre is their rounding.
constexpr double kTolerance_m = 1e-8;

struct Body {
    tissue::Model model;
    tissue::State state;
    Work work;
    std::vector<Vec3f> rest_m;
    std::vector<std::int64_t> owner;

    explicit Body(bool held)
        : model(tissue::sample(anatomy::make_block({.size_m = Vec3(0.0192, 0.0144, 0.0096), .held_below = held}), {})) {
        state = tissue::State::make(model);
        sever_initial_links(model, state);
        work = make_work(model, state);
        Random random(7);
        const double s = model.hexels.spacing_m;
        for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
            if (state.hexel_present.test(h)) {
                owner.push_back(h);
                rest_m.push_back(Vec3f(model.hexels.centre_m(h) +
                                       s * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))));
            }
    }
    template <class Displacement>
    void displace(const Displacement& u, const Mat3& gradient) {
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
            if (!state.phyxel_present.test(p)) continue;
            const Vec3 value = u(model.phyxels.centre_m(p));
            for (int r = 0; r < 3; ++r) {
                state.displacement_m[static_cast<std::size_t>(r)][static_cast<std::size_t>(p)] =
                    static_cast<float>(value[r]);
                for (int c = 0; c < 3; ++c)
                    work.gradient[static_cast<std::size_t>(3 * r + c)][static_cast<std::size_t>(p)] =
                        static_cast<float>(gradient[c][r]);
            }
        }
    }
    void displace_at_random() {
        Random random(11);
        for (auto& u : state.displacement_m)
            for (float& value : u) value = static_cast<float>(random.uniform(-1e-3, 1e-3));
        for (auto& g : work.gradient)
            for (float& value : g) value = static_cast<float>(random.uniform(-0.3, 0.3));
    }
    void sever_at_random(double share) {
        Random random(13);
        for (auto& links : state.links)
            for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
                if (random.uniform() < share) links.clear(p);
        refresh();
    }
    /// After links were changed by hand; gradients stay as they were given.
    void refresh() {
        const auto gradient = work.gradient;
        work = make_work(model, state);
        work.gradient = gradient;
    }
};

const Mat3 kGradient(Vec3(0.11, -0.07, 0.05), Vec3(0.21, -0.13, 0.02), Vec3(-0.04, 0.09, 0.17));

void expect_linear(const Body& body) {
    std::vector<Vec3f> world(body.rest_m.size());
    std::vector<Mat3f> F(body.rest_m.size());
    embed_points(body.model, body.state, body.work, body.rest_m, body.owner, world, F);
    double worst_m = 0.0, worst_F = 0.0;
    for (std::size_t k = 0; k < world.size(); ++k) {
        const Vec3 X(body.rest_m[k]);
        worst_m = std::max(worst_m, glm::length(Vec3(world[k]) - (X + kGradient * X + Vec3(1e-3, 2e-3, -1e-3))));
        for (int c = 0; c < 3; ++c)
            worst_F = std::max(worst_F, glm::length(Vec3(F[k][c]) - (Mat3(1.0) + kGradient)[c]));
    }
    EXPECT_LT(worst_m, kTolerance_m);
    EXPECT_LT(worst_F, 1e-6);
}

}  // namespace

TEST(Embedding, ReproducesLinearDisplacements) {
    Body body(false);
    body.displace([](const Vec3& X) { return kGradient * X + Vec3(1e-3, 2e-3, -1e-3); }, kGradient);
    expect_linear(body);
    body.sever_at_random(0.4);
    expect_linear(body);
}

TEST(Embedding, FastFormAgreesWithItsReference) {
    for (const double severed : {0.0, 0.3}) {
        Body body(true);
        body.displace_at_random();
        body.sever_at_random(severed);
        std::vector<Vec3f> world(body.rest_m.size()), reference(body.rest_m.size());
        std::vector<Mat3f> F(world.size()), reference_F(world.size());
        embed_points(body.model, body.state, body.work, body.rest_m, body.owner, world, F);
        embed_points_reference(body.model, body.state, body.work, body.rest_m, body.owner, reference, reference_F);
        for (std::size_t k = 0; k < world.size(); ++k) {
            ASSERT_LT(glm::length(world[k] - reference[k]), kTolerance_m);
            for (int c = 0; c < 3; ++c) ASSERT_LT(glm::length(F[k][c] - reference_F[k][c]), 2e-6f);
        }
    }
}

TEST(EmbeddedPoints, AgreeWithTheReference) {
    for (const double severed : {0.0, 0.3}) {
        Body body(true);
        body.displace_at_random();
        body.sever_at_random(severed);
        std::vector<Vec3f> world(body.rest_m.size()), reference(body.rest_m.size());
        std::vector<Mat3f> F(world.size()), reference_F(world.size());
        EmbeddedPoints points;
        points.rebuild(body.model, body.state, body.rest_m, body.owner);
        points.move(body.model, body.state, body.work, world, F);
        embed_points_reference(body.model, body.state, body.work, body.rest_m, body.owner, reference, reference_F);
        for (std::size_t k = 0; k < world.size(); ++k) {
            ASSERT_LT(glm::length(world[k] - reference[k]), kTolerance_m);
            for (int c = 0; c < 3; ++c) ASSERT_LT(glm::length(F[k][c] - reference_F[k][c]), 2e-6f);
        }
    }
}

TEST(EmbeddedPoints, AreTheSameForAnyNumberOfThreads) {
    Body body(true);
    body.displace_at_random();
    EmbeddedPoints points;
    points.rebuild(body.model, body.state, body.rest_m, body.owner);
    std::vector<Vec3f> one(body.rest_m.size()), many(body.rest_m.size());
    {
        const ThreadLimit limit(1);
        points.move(body.model, body.state, body.work, one);
    }
    const ThreadLimit limit(3);
    points.move(body.model, body.state, body.work, many);
    EXPECT_EQ(0, std::memcmp(one.data(), many.data(), one.size() * sizeof(Vec3f)));
}

TEST(Embedding, IsTheSameForAnyNumberOfThreads) {
    Body body(true);
    body.displace_at_random();
    std::vector<Vec3f> one(body.rest_m.size()), many(body.rest_m.size());
    {
        const ThreadLimit limit(1);
        embed_points(body.model, body.state, body.work, body.rest_m, body.owner, one);
    }
    const ThreadLimit limit(3);
    embed_points(body.model, body.state, body.work, body.rest_m, body.owner, many);
    EXPECT_EQ(0, std::memcmp(one.data(), many.data(), one.size() * sizeof(Vec3f)));
}

// A point on the face between two cells is the same from either side: all carriers within R are in both neighbourhoods.
TEST(Embedding, IsContinuousBetweenCells) {
    Body body(false);
    body.displace_at_random();
    const Lattice& hexels = body.model.hexels;
    Random random(3);
    for (int k = 0; k < 200; ++k) {
        const Int3 cell(15, 8 + static_cast<int>(random.uniform(0, 12)), 8 + static_cast<int>(random.uniform(0, 6)));
        ASSERT_NE(body.model.phyxel_of(cell), body.model.phyxel_of(cell + Int3(1, 0, 0)));
        const std::vector<Vec3f> rest(
            2, Vec3f(hexels.centre_m(cell) +
                     Vec3(0.5, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)) * hexels.spacing_m));
        const std::vector<std::int64_t> owner{hexels.index(cell), hexels.index(cell + Int3(1, 0, 0))};
        std::vector<Vec3f> world(2);
        embed_points(body.model, body.state, body.work, rest, owner, world);
        // Cells two away lie at 1.5 s > R, except for the rounding of the face's place.
        EXPECT_LT(glm::length(world[0] - world[1]), 2 * kTolerance_m);
    }
}

TEST(Embedding, StencilStaysOnItsSideOfACut) {
    Body body(false);
    const Lattice& phyxels = body.model.phyxels;
    const int cut = phyxels.size.x / 2;  // links from x < cut to x >= cut are gone
    for (std::size_t d = 0; d < tissue::kLinkDirections.size(); ++d)
        for (std::int64_t p = phyxels.first; p < phyxels.last; ++p)
            if (tissue::kLinkDirections[d].x == 1 && phyxels.coordinates(p).x == cut - 1) body.state.links[d].clear(p);
    body.refresh();
    for (std::size_t k = 0; k < body.rest_m.size(); ++k) {
        const Stencil stencil = embedding_stencil(body.model, body.state, body.work, body.owner[k], body.rest_m[k]);
        const bool left = body.model.hexels.coordinates(body.owner[k]).x / 4 < cut;
        float sum = 0.0f;
        ASSERT_GT(stencil.count, 0);
        for (std::size_t n = 0; n < static_cast<std::size_t>(stencil.count); ++n) {
            ASSERT_EQ(phyxels.coordinates(stencil.phyxel[n]).x < cut, left);
            sum += stencil.weight[n];
        }
        ASSERT_NEAR(sum, 1.0f, 1e-6);
    }
}

TEST(FindNear, AgreesWithASearchOverAllHexels) {
    Body body(true);
    body.displace_at_random();
    tissue::Exchange exchange;
    tissue::reserve_exchange(body.model, exchange);
    exchange.capsules.push_back(
        {.a_m = Vec3(-0.003, 0.0, 0.001), .b_m = Vec3(0.004, 0.001, -0.001), .radius_m = 5e-4, .bare = true});
    exchange.capsules.push_back({.a_m = Vec3(-0.003, 0.0, 0.001), .b_m = Vec3(-0.003, 0.0, 0.02), .radius_m = 2.5e-3});
    const double reach_m = 2e-3;
    find_near(body.model, body.state, exchange, body.work, reach_m);

    auto distance = [](const tissue::Capsule& c, const Vec3& p) {
        const double t =
            std::clamp(glm::dot(p - c.a_m, c.b_m - c.a_m) / glm::dot(c.b_m - c.a_m, c.b_m - c.a_m), 0.0, 1.0);
        return glm::length(p - c.a_m - t * (c.b_m - c.a_m)) - c.radius_m;
    };
    std::map<std::int64_t, std::array<double, 2>> expected;  // distance to any and to bare metal
    for (const std::int64_t h : body.owner) {
        bool surface = false;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = -1; side <= 1; side += 2) {
                const std::int64_t n = h + side * std::int64_t{body.model.hexels.stride[axis]};
                surface |= !body.state.hexel_present.test(n) && !body.model.hexel_held.test(n);
            }
        if (!surface) continue;
        const std::vector<Vec3f> rest{Vec3f(body.model.hexels.centre_m(h))};
        std::vector<Vec3f> world(1);
        embed_points_reference(body.model, body.state, body.work, rest, std::span(&h, 1), world);
        const double bare = distance(exchange.capsules[0], Vec3(world[0])),
                     any = std::min(bare, distance(exchange.capsules[1], Vec3(world[0])));
        if (any <= reach_m) expected[h] = {any, bare};
    }
    ASSERT_GT(expected.size(), 100u);
    ASSERT_EQ(exchange.near.size(), expected.size());
    auto it = expected.begin();
    for (const tissue::NearHexel& near : exchange.near) {
        EXPECT_EQ(near.hexel, it->first);
        EXPECT_NEAR(near.distance_m, it->second[0], 1e-8);
        EXPECT_NEAR(near.bare_gap_m, it->second[1] - 0.5 * body.model.hexels.spacing_m, 1e-8);
        ++it;
    }
}

// The top of a flat block looks up, its sides sideways; a sheared block turns its normals by F^-T.
TEST(FindNear, OutwardFollowsTheDeformation) {
    Body body(false);
    const Mat3 shear(Vec3(0.0), Vec3(0.0), Vec3(0.5, 0.0, 0.0));  // u_x = 0.5 z: the top stays level, the sides lean
    body.displace([&](const Vec3& X) { return shear * X; }, shear);
    tissue::Exchange exchange;
    tissue::reserve_exchange(body.model, exchange);
    exchange.capsules.push_back({.a_m = Vec3(-0.02, 0.0, -0.004), .b_m = Vec3(0.02, 0.0, -0.004), .radius_m = 5e-4});
    find_near(body.model, body.state, exchange, body.work, 6e-3);
    int tops = 0, sides = 0;
    const Int3 high = body.model.hexels.size - 5;  // the last filled layers (one ring of empty phyxels)
    for (const tissue::NearHexel& near : exchange.near) {
        const Int3 c = body.model.hexels.coordinates(near.hexel);
        const bool top = c.z == high.z, right = c.x == high.x,
                   other = c.y == high.y || c.y == 4 || c.z == 4 || c.x == 4;
        if (top && !right && !other) {
            ++tops;
            EXPECT_LT(glm::length(near.outward - Vec3f(0.0f, 0.0f, 1.0f)), 1e-5f);
        }
        if (right && !top && !other) {
            ++sides;
            EXPECT_LT(glm::length(near.outward - glm::normalize(Vec3f(1.0f, 0.0f, -0.5f))), 1e-5f);
        }
    }
    EXPECT_GT(tops, 10);
    EXPECT_GT(sides, 10);
}

// Beyond the capacity the nearest are kept, still in the order of their cells.
TEST(FindNear, KeepsTheNearestAtCapacity) {
    const tissue::Model model =
        tissue::sample(anatomy::make_block({.size_m = Vec3(0.06, 0.06, 0.0048), .held_below = false}), {});
    tissue::State state = tissue::State::make(model);
    Work work = make_work(model, state);
    tissue::Exchange exchange;
    tissue::reserve_exchange(model, exchange);
    exchange.capsules.push_back({.a_m = Vec3(0.0, 0.0, 0.0), .b_m = Vec3(0.001, 0.0, 0.0), .radius_m = 5e-4});
    find_near(model, state, exchange, work, 0.1);
    ASSERT_EQ(static_cast<std::int64_t>(exchange.near.size()), tissue::kNearCapacity);
    float furthest_kept = 0.0f;
    for (std::size_t k = 0; k < exchange.near.size(); ++k) {
        furthest_kept = std::max(furthest_kept, exchange.near[k].distance_m);
        if (k > 0) {
            EXPECT_LT(exchange.near[k - 1].hexel, exchange.near[k].hexel);
        }
    }
    find_near(model, state, exchange, work, furthest_kept);  // exactly those fit
    EXPECT_EQ(static_cast<std::int64_t>(exchange.near.size()), tissue::kNearCapacity);
}

}  // namespace calot::deformation
