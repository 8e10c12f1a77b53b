// What was updated piece by piece equals what is built at once, byte by byte.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "calot/validation/surface_bodies.h"
#include "calot/base/parallel.h"
#include "support/allocations.h"

namespace calot::surface {

namespace {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_bytes(const Mesh& a, const Mesh& b) {
    return same_bytes(a.position_m, b.position_m) && same_bytes(a.normal, b.normal) && same_bytes(a.index, b.index);
}

void expect_equals_rebuilt(const Body& body, const Surface& surface) {
    Surface fresh(body.model);
    fresh.rebuild(body.model, body.state);
    ASSERT_TRUE(same_bytes(surface.rest_mesh(), fresh.rest_mesh()));
    ASSERT_TRUE(same_bytes(surface.owner(), fresh.owner()));
    ASSERT_TRUE(same_bytes(surface.smooth_mesh(), fresh.smooth_mesh()));
}

void burn_and_compare(Body body, std::uint64_t seed) {
    Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    Random random(seed);
    std::vector<std::int64_t> left = body.hexels();
    shuffle(left, random);
    while (!left.empty()) {
        const std::size_t count = std::min<std::size_t>(left.size(), 1 + random.next() % 40);
        const std::vector<std::int64_t> gone(left.end() - static_cast<std::ptrdiff_t>(count), left.end());
        left.resize(left.size() - count);
        body.remove(gone, surface);
        expect_equals_rebuilt(body, surface);
        if (testing::Test::HasFatalFailure()) return;
    }
}

/// Hexels of a crater, nearest to `centre` first.
std::vector<std::int64_t> crater(const Body& body, const Vec3& centre, std::size_t count) {
    std::vector<std::int64_t> hexels = body.hexels();
    std::stable_sort(hexels.begin(), hexels.end(), [&](std::int64_t a, std::int64_t b) {
        return glm::length(Vec3(body.model.hexels.coordinates(a)) - centre) <
               glm::length(Vec3(body.model.hexels.coordinates(b)) - centre);
    });
    hexels.resize(count);
    return hexels;
}

}  // namespace

TEST(Update, EqualsRebuild) {
    burn_and_compare(ball(20, 8.6), 1);
    burn_and_compare(checkerboard(13), 2);
    burn_and_compare(sheet({4, 30, 22}), 3);
}

TEST(Update, EqualsRebuildForEveryOrderOfAxes) {
    // The lattice's fastest axis is its shortest: rows of blocks run along x, y or z.
    for (const Int3& size :
         {Int3(9, 14, 20), Int3(14, 20, 9), Int3(20, 9, 14), Int3(9, 20, 14), Int3(14, 9, 20), Int3(20, 14, 9)})
        burn_and_compare(noise(size, 0.7, 9), 4);
}

TEST(Update, OrderOfRemovalsDoesNotShow) {
    Body at_once = ball(30, 13.2), one_by_one = ball(30, 13.2), backwards = ball(30, 13.2);
    std::vector<std::int64_t> gone = crater(at_once, Vec3(3.0, 15.0, 15.0), 300);
    Surface a(at_once.model), b(at_once.model), c(at_once.model);
    for (Surface* s : {&a, &b, &c}) s->rebuild(at_once.model, at_once.state);
    at_once.remove(gone, a);
    for (std::int64_t h : gone) one_by_one.remove({h}, b);
    std::reverse(gone.begin(), gone.end());
    for (std::int64_t h : gone) backwards.remove({h}, c);
    EXPECT_TRUE(same_bytes(a.rest_mesh(), b.rest_mesh()));
    EXPECT_TRUE(same_bytes(a.rest_mesh(), c.rest_mesh()));
    EXPECT_TRUE(same_bytes(a.owner(), c.owner()));
}

TEST(Update, SameBytesForAnyNumberOfThreads) {
    std::vector<Mesh> meshes;
    for (int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        Body body = ball(40, 18.4);
        Surface surface(body.model);
        surface.rebuild(body.model, body.state);
        body.remove(crater(body, Vec3(4.0, 20.0, 20.0), 500), surface);
        meshes.push_back(surface.rest_mesh());
    }
    EXPECT_TRUE(same_bytes(meshes[0], meshes[1]));
    EXPECT_TRUE(same_bytes(meshes[0], meshes[2]));
}

TEST(Update, DoesNotAllocate) {
    const ThreadLimit limit(1);  // TBB allocates its tasks itself
    Body body = ball(40, 18.4);
    Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    const std::vector<std::int64_t> gone = crater(body, Vec3(4.0, 20.0, 20.0), 4000);
    tissue::Exchange exchange;
    exchange.removed_hexels.reserve(40);
    const long before = calot::test::allocations();
    for (std::size_t k = 0; k < gone.size(); k += 40) {
        exchange.removed_hexels.assign(gone.begin() + static_cast<std::ptrdiff_t>(k),
                                       gone.begin() + static_cast<std::ptrdiff_t>(k + 40));
        for (std::int64_t h : exchange.removed_hexels) body.state.hexel_present.clear(h);
        surface.remove(exchange);
        surface.redo_dirty_blocks();
    }
    EXPECT_EQ(calot::test::allocations() - before, 0);
}

TEST(Update, VersionCountsChanges) {
    Body body = ball(12, 4.3);
    Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    const auto before = surface.version();
    body.remove({}, surface);
    EXPECT_EQ(surface.version(), before);
    body.remove({body.hexels().front()}, surface);
    EXPECT_GT(surface.version(), before);
}

}  // namespace calot::surface
