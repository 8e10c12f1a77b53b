// Words of occupancy, the links that an anatomy carries at the start, cuts and crumbs.
#include "calot/deformation/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "calot/validation/elastic_rig.h"
#include "calot/anatomy/shapes.h"
#include "calot/deformation/occupancy.h"

namespace calot::deformation {

namespace {

using rig::Body;
using rig::kSpacing_m;

constexpr double kHexel_m = kSpacing_m / 4;
constexpr int kAcross = 3;                         ///< width and height of the bars, phyxels
constexpr int kLayer = 4 * kAcross * 4 * kAcross;  ///< hexels of one layer across

/// Components of a word by plain breadth-first search, largest first, of equals the one with the lowest bit.
std::uint64_t largest_component_reference(int m, std::uint64_t word) {
    std::uint64_t best = 0, seen = 0;
    for (int seed = 0; seed < m * m * m; ++seed) {
        if (!((word >> seed) & 1u) || ((seen >> seed) & 1u)) continue;
        std::vector<int> queue{seed};
        std::uint64_t component = 0;
        for (std::size_t k = 0; k < queue.size(); ++k) {
            const Int3 c = hexel_of_bit(m, queue[k]);
            component |= std::uint64_t{1} << queue[k];
            for (int other = 0; other < m * m * m; ++other) {
                const Int3 d = glm::abs(hexel_of_bit(m, other) - c);
                if (d.x + d.y + d.z != 1 || !((word >> other) & 1u)) continue;
                if (std::find(queue.begin(), queue.end(), other) == queue.end()) queue.push_back(other);
            }
        }
        seen |= component;
        if (__builtin_popcountll(component) > __builtin_popcountll(best)) best = component;
    }
    return best;
}

/// A bar of tissue along x between two organs that hold it; ends are whole phyxel cells. A slab of air from
/// `gap_from` to `gap_to` [hexels from the left end] may split it.
anatomy::Anatomy make_bar(int phyxels_long, int gap_from = 0, int gap_to = 0, bool held_right = true) {
    const double length = phyxels_long * kSpacing_m, half = 0.5 * kAcross * kSpacing_m;
    anatomy::Anatomy anatomy;
    const auto whole = anatomy::make_box(Vec3(0.0, -half, -half), Vec3(length, half, half));
    anatomy.tissues.push_back({"bar", "fat",
                               anatomy::make_shape(
                                   [=](const Vec3& p) {
                                       const double gap = std::max(gap_from * kHexel_m - p.x, p.x - gap_to * kHexel_m);
                                       return std::max(whole->distance_m(p), gap_to > gap_from ? -gap : -1.0);
                                   },
                                   whole->bounds_m())});
    const double far = 0.1;
    anatomy.organs.push_back({"left", "liver", true, anatomy::make_box(Vec3(-far, -far, -far), Vec3(0.0, far, far))});
    if (held_right)
        anatomy.organs.push_back(
            {"right", "liver", true, anatomy::make_box(Vec3(length, -far, -far), Vec3(length + far, far, far))});
    anatomy.field = whole->bounds_m();
    return anatomy;
}

struct Bar : Body {
    explicit Bar(const anatomy::Anatomy& anatomy) : Body(tissue::sample(anatomy, {.hexel_spacing_m = kHexel_m})) {
        dropped = sever_initial_links(model, state);
        work = make_work(model, state);
        tissue::reserve_exchange(model, exchange);
    }
    std::int64_t dropped = 0;

    /// Burns the hexels whose coordinates from the bar's left, front, bottom corner satisfy `where`.
    template <class Where>
    void burn(const Where& where) {
        exchange.removed_hexels.clear();
        for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h) {
            if (!state.hexel_present.test(h) || !where(model.hexels.coordinates(h) - 4)) continue;
            state.hexel_present.clear(h);
            exchange.removed_hexels.push_back(h);
        }
        sever_burnt_links(model, state, exchange, work);
    }
    /// Live links between cells left of `x` [phyxels from the left end] and the others.
    int links_across(int x) const {
        int count = 0;
        for (std::size_t d = 0; d < tissue::kLinkDirections.size(); ++d)
            for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
                if (!state.links[d].test(p)) continue;
                const Int3 a = model.phyxels.coordinates(p), b = a + tissue::kLinkDirections[d];
                count += (a.x - 1 < x) != (b.x - 1 < x);
            }
        return count;
    }
};

}  // namespace

TEST(Occupancy, LargestComponentAgreesWithASearch) {
    Random random(5);
    for (const int m : {1, 2, 4}) {
        const OccupancyShifts shifts(m);
        for (int k = 0; k < 300; ++k) {
            const std::uint64_t word = random.next() & (k % 3 ? random.next() | random.next() : ~0ull) & shifts.all;
            EXPECT_EQ(shifts.largest_component(word), largest_component_reference(m, word));
        }
    }
}

TEST(Occupancy, TouchLooksAtTheSharedFace) {
    for (const int m : {1, 2, 4}) {
        const OccupancyShifts shifts(m);
        for (int a = 0; a < m * m * m; ++a)
            for (int b = 0; b < m * m * m; ++b)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    Int3 above = hexel_of_bit(m, b);
                    above[static_cast<int>(axis)] += m;
                    const Int3 d = above - hexel_of_bit(m, a);
                    Int3 unit(0);
                    unit[static_cast<int>(axis)] = 1;
                    EXPECT_EQ(shifts.touch(std::uint64_t{1} << a, std::uint64_t{1} << b, axis), d == unit);
                }
    }
}

TEST(InitialTopology, AWholeBlockKeepsAllItsLinks) {
    Body body(rig::block({3, 2, 4}, true));
    const auto links = body.state.links;
    EXPECT_EQ(sever_initial_links(body.model, body.state), 0);
    for (std::size_t d = 0; d < links.size(); ++d) EXPECT_EQ(links[d].words(), body.state.links[d].words());
}

// Two lobes, a gap of one hexel between them: the cells are neighbours, the tissue is not.
TEST(InitialTopology, LobesThatDoNotTouchAreNotLinked) {
    for (int gap = 6; gap < 10; ++gap) {
        const Bar bar(make_bar(4, gap, gap + 1));
        EXPECT_GT(bar.links_across(1), 0);
        // The face between cells 1 and 2 lies at hexel 8. A gap inside a cell costs the thinner side of that cell.
        EXPECT_EQ(bar.links_across(2), 0) << gap;
        EXPECT_EQ(bar.dropped, gap == 6 || gap == 9 ? kLayer : 0) << gap;
    }
}

// Organs need not end where cells do: held cells inside a phyxel's own cell join it to the ghosts behind.
TEST(InitialTopology, TissueIsHeldThroughItsOwnCell) {
    for (int hexels = 14; hexels <= 18; ++hexels) {
        const auto model = tissue::sample(
            anatomy::make_block({.size_m = Vec3(3 * kSpacing_m, 3 * kSpacing_m, hexels * kHexel_m)}), {});
        tissue::State state = tissue::State::make(model);
        EXPECT_EQ(sever_initial_links(model, state), 0) << hexels;
    }
}

TEST(InitialTopology, WhatNothingHoldsIsDropped) {
    const Bar bar(make_bar(4, 7, 9, false));
    EXPECT_EQ(bar.dropped, 7 * kLayer);
    EXPECT_EQ(bar.state.hexel_present.count(), 7 * kLayer);
    EXPECT_EQ(bar.state.hexels_fallen, 0);
}

TEST(Topology, AFullCutOneHexelWideSeversEverythingAcross) {
    for (int x = 6; x < 10; ++x) {
        Bar bar(make_bar(5));
        bar.burn([&](const Int3& h) { return h.x == x; });
        int across = 0;
        for (int face = 1; face < 5; ++face) across += bar.links_across(face) == 0;
        EXPECT_GE(across, 1) << x;
        EXPECT_GT(bar.links_across(0), 0);
        EXPECT_GT(bar.links_across(5), 0);
        EXPECT_GT(bar.state.links_severed, 0);
        // A cut beside a face takes one layer; inside a cell the thinner side of its cell goes too.
        EXPECT_EQ(bar.state.hexels_fallen, x == 6 || x == 9 ? kLayer : 0) << x;
    }
}

TEST(Topology, APartialCutKeepsTheRest) {
    Bar bar(make_bar(4));
    const int before = bar.links_across(2);
    bar.burn([](const Int3& h) { return h.x == 7 && h.y < 11; });  // all but the last row of hexels
    EXPECT_GT(bar.links_across(2), 0);
    EXPECT_LT(bar.links_across(2), before);
    EXPECT_EQ(bar.state.hexels_fallen, 0);
    bar.burn([](const Int3& h) { return h.x == 7; });
    EXPECT_EQ(bar.links_across(2), 0);
}

// A bar held at one end only: what lies beyond the cut falls, with the heat that it holds.
TEST(Topology, CrumbsFallWithTheirHeat) {
    Bar bar(make_bar(4, 0, 0, false));
    constexpr float kEnthalpy_J_per_m3 = 1e6f;
    for (float& value : bar.state.enthalpy_J_per_m3) value = kEnthalpy_J_per_m3;
    bar.burn([](const Int3& h) { return h.x == 7; });
    EXPECT_EQ(bar.state.hexels_fallen, 8 * kLayer);
    EXPECT_EQ(bar.exchange.removed_hexels.size(), 9u * kLayer);
    EXPECT_EQ(bar.state.hexel_present.count(), 7 * kLayer);
    EXPECT_EQ(bar.state.phyxel_present.count(), 2 * kAcross * kAcross);
    EXPECT_EQ(bar.links_across(3), 0);
    const double expected_J = 8 * kLayer * static_cast<double>(kEnthalpy_J_per_m3) * bar.model.hexel_volume_m3();
    EXPECT_NEAR(bar.state.energy_J.debris, expected_J, 1e-9 * expected_J);  // sums of equal doubles
}

TEST(Topology, AFreeBodyKeepsItsLargestPiece) {
    Body body(rig::block({5, 2, 2}, false));
    sever_initial_links(body.model, body.state);
    tissue::reserve_exchange(body.model, body.exchange);
    for (std::int64_t h = body.model.hexels.first; h < body.model.hexels.last; ++h)
        if (body.state.hexel_present.test(h) && body.model.hexels.coordinates(h).x == 4 + 8) {
            body.state.hexel_present.clear(h);
            body.exchange.removed_hexels.push_back(h);
        }
    sever_burnt_links(body.model, body.state, body.exchange, body.work);
    EXPECT_EQ(body.state.hexel_present.count(), 11 * 64);
    EXPECT_EQ(body.state.hexels_fallen, 8 * 64);
}

// The bar is pulled 2 mm long by its right end, at rest, then cut: both halves go back to where their own end is, and
// nothing is left of the force. Before links were severed, a cut one hexel wide transmitted all of it.
TEST(Topology, ACutBarTransmitsNoForce) {
    Bar bar(make_bar(5));
    constexpr double kPull_m = 2e-3;
    constexpr double kTolerance_m = 2e-6;  // what 40/s of decay leaves of 2 mm after 0.2 s, and of slow bending
    for (int k = 0; k < 400; ++k) {
        for (std::size_t n = 0; n < bar.work.mirrors.size(); ++n)
            if (k < 100 && bar.model.phyxels.coordinates(bar.work.mirrors[n].ghost).x > 3)
                bar.work.face_m[0][n] = static_cast<float>(kPull_m * (k + 1) / 100.0);
        bar.tick();
    }
    const double stretched_J = elastic_energy_J(bar.model, bar.state, bar.work);
    ASSERT_GT(stretched_J, 1e-5);

    bar.exchange.removed_hexels.clear();
    bar.burn([](const Int3& h) { return h.x == 9 && h.z < 6; });
    for (int k = 0; k < 300; ++k) bar.tick();
    const double half_cut_J = elastic_energy_J(bar.model, bar.state, bar.work);
    EXPECT_LT(half_cut_J, stretched_J);
    EXPECT_GT(half_cut_J, 0.3 * stretched_J);

    bar.burn([](const Int3& h) { return h.x == 9; });
    for (int k = 0; k < 400; ++k) bar.tick();
    EXPECT_LT(elastic_energy_J(bar.model, bar.state, bar.work), 1e-6 * stretched_J);
    bar.for_each_phyxel([&](std::int64_t p) {
        const double expected = bar.model.phyxels.coordinates(p).x - 1 < 2 ? 0.0 : kPull_m;
        EXPECT_LT(glm::length(bar.displacement_m(p) - Vec3(expected, 0, 0)), kTolerance_m)
            << bar.model.phyxels.coordinates(p).x;
    });
}

}  // namespace calot::deformation
