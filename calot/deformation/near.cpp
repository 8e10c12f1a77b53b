// The surface hexels near the instrument, in the world.
//
// Phyxels first: those whose moved centre lies near a capsule, looked for among those that the frame's list holds. Then
// their surface hexels, by words: a hexel is inside where all six shifted neighbours are filled. The centres of hexels
// sit at the same m^3 places in every cell, so their kernel values are a table (NearWork), and only which carriers live
// differs.
//
// Blending is what costs, so most is ruled out before: a blend lies within the carriers' fields, and these differ from
// the owner's own by no more than a bound that is the same for the whole cell.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

#include "calot/deformation/carriers.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/near_kernel.h"
#include "calot/deformation/occupancy.h"

namespace calot::deformation {

namespace {

/// How far instruments and tissue may move towards each other before a frame's phyxels are listed anew: instruments are
/// asked; tissue moves by 7 mm within a frame unless Work::fast says that it is faster, and by some more where impulses
/// of contacts and ghosts push it after that was looked at.
constexpr float kInstrumentMargin_m = 2e-3f, kTissueMargin_m = 8e-3f;

}  // namespace

Capsules::Capsules(const std::vector<tissue::Capsule>& capsules, const NearReach& reach) {
    for (const tissue::Capsule& c : capsules) {
        if (count == item.size()) break;
        const Vec3f a(c.a_m), ab = Vec3f(c.b_m) - a;
        const float length2 = glm::dot(ab, ab);
        item[count++] = {a,
                         ab,
                         length2 > 0.0f ? 1.0f / length2 : 0.0f,
                         static_cast<float>(c.radius_m),
                         static_cast<float>(reach.of(c)),
                         c.bare,
                         c.instrument};
    }
}

namespace {

/// The hexels of a phyxel with an absent face neighbour.
std::uint64_t surface_hexels(const tissue::Model& model, const Work& work, const OccupancyShifts& shifts,
                             std::int64_t phyxel) {
    auto filled = [&](std::int64_t p) {
        return work.occupancy[static_cast<std::size_t>(p)] | work.held[static_cast<std::size_t>(p)];
    };
    const std::uint64_t here = filled(phyxel);
    std::uint64_t inside = work.occupancy[static_cast<std::size_t>(phyxel)];
    const std::uint64_t own = inside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t step = model.phyxels.stride[static_cast<int>(axis)];
        inside &= shifts.down(here, axis) | shifts.low_as_high(filled(phyxel + step), axis);
        inside &= shifts.up(here, axis) | shifts.high_as_low(filled(phyxel - step), axis);
    }
    return own & ~inside;
}

/// kRowOutward with a 0 behind.
constexpr auto kPaddedOutward = [] {
    std::array<std::array<std::array<float, 4>, 8>, 9> outward{};
    for (std::size_t row = 0; row < 9; ++row)
        for (std::size_t bits = 0; bits < 8; ++bits)
            for (std::size_t axis = 0; axis < 3; ++axis) outward[row][bits][axis] = kRowOutward[row][bits][axis];
    return outward;
}();

/// Away from the tissue at rest: against the sum of the directions to the 26 neighbours that are filled. 0 where they
/// balance, as in a sheet one hexel thick.
Vec3f rest_outward(const tissue::Model& model, const tissue::State& state, const NeighbourRows& rows,
                   std::int64_t hexel) {
    // Four numbers at a time; the fourth is not used.
    Four sum{};
    for (std::size_t row = 0; row < rows.offset.size(); ++row) {
        const std::int64_t cell = hexel + rows.offset[row];
        Four towards;
        std::memcpy(&towards,
                    kPaddedOutward[row][(state.hexel_present.bits32(cell) | model.hexel_held.bits32(cell)) & 7u].data(),
                    sizeof(towards));
        sum += towards;
    }
    Vec3f outward;
    for (int k = 0; k < 3; ++k) outward[rows.axis[k]] = sum[k];
    return outward;
}

/// A rest normal turned into the world by cof F = J F^-T, normalised.
Vec3f turn_normal(const Mat3f& F, const Vec3f& n) {
    const Vec3f turned = glm::cross(F[1], F[2]) * n.x + glm::cross(F[2], F[0]) * n.y + glm::cross(F[0], F[1]) * n.z;
    const float length = glm::length(turned);
    constexpr float kBalanced = 1e-3f;  // rounding of sums that cancel
    return length > kBalanced ? turned / length : Vec3f(0.0f);
}

/// Order of the heap that keeps the nearest: furthest on top, of equals the later cell.
bool nearer(const tissue::NearHexel& a, const tissue::NearHexel& b) {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.hexel < b.hexel;
}

void keep(std::vector<tissue::NearHexel>& near, const tissue::NearHexel& item) {
    constexpr auto kCapacity = static_cast<std::size_t>(tissue::kNearCapacity);
    if (near.size() < kCapacity) {
        near.push_back(item);
        if (near.size() == kCapacity) std::make_heap(near.begin(), near.end(), nearer);
        return;
    }
    if (!nearer(item, near.front())) return;
    std::pop_heap(near.begin(), near.end(), nearer);
    near.back() = item;
    std::push_heap(near.begin(), near.end(), nearer);
}

/// What a tick's search goes by.
struct Search {
    const tissue::Model& model;
    const tissue::State& state;
    tissue::Exchange& exchange;
    const Work& work;
    const Capsules capsules;
    const CapsuleLanes lanes;
    const OccupancyShifts shifts;
    const NeighbourRows phyxel_rows, hexel_rows;
    CellView view;
    NearPlaces places;
    // Of each place
    std::array<PaddedField, NearPlaces::kCapacity> field;
    std::array<Vec3f, NearPlaces::kCapacity> rest_m;
    std::array<std::int64_t, NearPlaces::kCapacity> hexel;

    Search(const tissue::Model& model_, const tissue::State& state_, tissue::Exchange& exchange_, const Work& work_,
           const NearReach& reach)
        : model(model_),
          state(state_),
          exchange(exchange_),
          work(work_),
          capsules(exchange_.capsules, reach),
          lanes(capsules),
          shifts(model_.hexels_per_edge),
          phyxel_rows(model_.phyxels),
          hexel_rows(model_.hexels) {
        for (std::size_t r = 0; r < 3; ++r) view.field[r] = state.displacement_m[r].data();
        for (std::size_t e = 0; e < 9; ++e) view.field[3 + e] = work.gradient[e].data();
        view.row = phyxel_rows.offset;
        view.step_m = {};
        const auto spacing_m = static_cast<float>(model.phyxels.spacing_m);
        for (std::size_t slot = 0; slot < kNeighbourhood; ++slot) {
            const Int3 step = phyxel_rows.step(static_cast<int>(slot));
            for (std::size_t axis = 0; axis < 3; ++axis)
                view.step_m[axis][slot] = spacing_m * static_cast<float>(step[static_cast<int>(axis)]);
            view.place[slot] = kCarrierPlace[static_cast<std::size_t>(neighbour_index(step))];
        }
        view.place[kNeighbourhood] = kNeighbourhood;
        view.tables = &work.near;
        view.capsules = &capsules;
        view.lanes = &lanes;
        view.half_m = static_cast<float>(0.5 * model.hexels.spacing_m) * static_cast<float>(shifts.m - 1);
    }

    /// The surface hexels of one phyxel that may be within reach.
    void add_hexels(std::int64_t phyxel) {
        const auto p = static_cast<std::size_t>(phyxel);
        Cell cell;
        cell.hexels = surface_hexels(model, work, shifts, phyxel);
        if (cell.hexels == 0) return;
        if (places.count + 64 > NearPlaces::kCapacity) keep_near();
        cell.phyxel = phyxel;
        cell.centre_m = Vec3f(work.rest_m[0][p], work.rest_m[1][p], work.rest_m[2][p]);
        cell.carriers = carrier_bits(model, work, phyxel);
        const std::uint64_t found = blend_near(view, cell, field.data() + places.count);
        if (found == 0) return;
        const int m = shifts.m;
        const Int3 first = model.phyxels.coordinates(phyxel) * m;
        const std::int64_t first_hexel = model.hexels.index(first);
        std::array<std::array<float, 4>, 3> along_m;  // rest positions of hexels along the axes
        for (int c = 0; c < m; ++c) {
            const Vec3f centre_m(model.hexels.centre_m(first + c));
            for (std::size_t axis = 0; axis < 3; ++axis)
                along_m[axis][static_cast<std::size_t>(c)] = centre_m[static_cast<int>(axis)];
        }
        for (std::uint64_t rest = found; rest != 0; rest &= rest - 1) {
            const auto bit = static_cast<std::size_t>(__builtin_ctzll(rest));
            const std::array<std::uint8_t, 3>& at = work.near.local[bit];
            const std::size_t k = places.count++;
            hexel[k] = first_hexel + work.near.hexel_offset[bit];
            rest_m[k] = Vec3f(along_m[0][at[0]], along_m[1][at[1]], along_m[2][at[2]]);
            const Vec3f world_m = rest_m[k] + displacement_at(field[k], rest_m[k] - cell.centre_m);
            for (std::size_t axis = 0; axis < 3; ++axis) places.world_m[axis][k] = world_m[static_cast<int>(axis)];
        }
    }

    /// Keeps those places that are within reach.
    void keep_near() {
        measure(capsules, places);
        const auto half_hexel_m = static_cast<float>(0.5 * model.hexels.spacing_m);
        for (std::size_t k = 0; k < places.count; ++k) {
            if (places.beyond_m[k] > 0.0f) continue;
            tissue::NearHexel item;
            item.hexel = hexel[k];
            item.rest_m = rest_m[k];
            item.world_m = Vec3f(places.world_m[0][k], places.world_m[1][k], places.world_m[2][k]);
            item.distance_m = places.distance_m[k];
            item.bare_gap_m = places.bare_m[k] - half_hexel_m;
            item.outward =
                turn_normal(deformation_gradient_of(field[k]), rest_outward(model, state, hexel_rows, item.hexel));
            keep(exchange.near, item);
        }
        places.count = 0;
    }
};

/// By how much the ends of capsules and their reach differ from those listed, at most.
float moved_since(const Capsules& listed, const Capsules& now) {
    float most = 0.0f;
    for (std::size_t k = 0; k < now.count; ++k) {
        const CapsuleF &x = listed.item[k], &y = now.item[k];
        const Vec3f a = y.a - x.a, b = a + (y.ab - x.ab);
        const float wider = (y.radius + y.reach) - (x.radius + x.reach);
        most = std::max(most, std::sqrt(std::max(glm::dot(a, a), glm::dot(b, b))) + std::max(0.0f, wider));
    }
    return most;
}

/// Lists the phyxels that may be near in this frame, unless that was done.
void list_phyxels(const tissue::State& state, const Capsules& capsules, const PlaceView& places, float further_m,
                  Work& work) {
    NearWork& near = work.near;
    const bool same_frame =
        near.tick >= 0 && state.tick == near.tick + 1 && state.tick % tissue::Model::frame_ticks != 0;
    near.tick = state.tick;
    const bool fast = std::memchr(work.fast.data(), 1, work.fast.size()) != nullptr;
    if (same_frame && !fast && near.listed.count == capsules.count &&
        moved_since(near.listed, capsules) <= kInstrumentMargin_m)
        return;
    near.listed = capsules;
    std::fill(work.fast.begin(), work.fast.end(), std::uint8_t{0});
    list_near_phyxels(places, work.groups, capsules, further_m + kInstrumentMargin_m + kTissueMargin_m, near);
}

}  // namespace

NearWork make_near_work(const tissue::Model& model, const Work& work) {
    NearWork near;
    const int m = model.hexels_per_edge;
    near.weights.resize(static_cast<std::size_t>(model.hexels_per_phyxel()));
    for (auto& axis : near.offset_m) axis.assign(64, 0.0f);
    std::array<std::size_t, kNeighbourhood> cell{};  // of a carrier
    for (std::size_t k = 0; k < kNeighbourhood; ++k) cell[kCarrierPlace[k]] = k;
    for (std::size_t bit = 0; bit < near.weights.size(); ++bit) {
        std::size_t count = 0;
        for (std::size_t n = 0; n < kNeighbourhood; ++n) {
            const float weight = work.hexel_weight[kNeighbourhood * bit + cell[n]];
            if (weight == 0.0f) continue;
            assert(count < kMostWeighted);
            near.weights[bit].weight[count] = weight;
            near.weights[bit].carrier[count++] = static_cast<std::int32_t>(n);
        }
        const Int3 local = hexel_of_bit(m, static_cast<int>(bit));
        near.hexel_offset[bit] = model.hexels.offset(local);
        for (int axis = 0; axis < 3; ++axis)
            near.local[bit][static_cast<std::size_t>(axis)] = static_cast<std::uint8_t>(local[axis]);
        const Vec3 r = (Vec3(local) - 0.5 * (m - 1)) * model.hexels.spacing_m;
        for (std::size_t axis = 0; axis < 3; ++axis)
            near.offset_m[axis][bit] = static_cast<float>(r[static_cast<int>(axis)]);
    }
    near.blocks.reserve(static_cast<std::size_t>(model.phyxel_initial.count() / 16 + 1));
    return near;
}

void find_near(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, Work& work,
               const NearReach& reach) {
    exchange.near.clear();
    if (exchange.capsules.empty()) return;
    Search search(model, state, exchange, work, reach);
    PlaceView places;
    for (std::size_t r = 0; r < 3; ++r) {
        places.rest_m[r] = work.rest_m[r].data();
        places.displacement_m[r] = state.displacement_m[r].data();
    }
    const auto further_m = static_cast<float>(kPhyxelMargin * model.phyxels.spacing_m);
    list_phyxels(state, search.capsules, places, further_m, work);
    find_near_phyxels(places, search.capsules, further_m, work.near);
    for (const NearBlock& block : work.near.blocks)
        for (std::uint32_t rest = block.near; rest != 0; rest &= rest - 1) {
            const std::int64_t phyxel = block.cell[static_cast<std::size_t>(__builtin_ctz(rest))];
            if (state.phyxel_present.test(phyxel)) search.add_hexels(phyxel);
        }
    search.keep_near();
    std::sort(exchange.near.begin(), exchange.near.end(),
              [](const tissue::NearHexel& a, const tissue::NearHexel& b) { return a.hexel < b.hexel; });
}

}  // namespace calot::deformation
