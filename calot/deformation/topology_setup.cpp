// The rules of topology.h over the whole lattice, plainly: used once at set-up, and as the reference of the local
// update.

#include <algorithm>
#include <vector>

#include "calot/deformation/carriers.h"
#include "calot/deformation/holding.h"
#include "calot/deformation/topology.h"

namespace calot::deformation {

namespace {

struct Words {
    std::vector<std::uint64_t> main_word, held_word;
    std::uint64_t main(std::int64_t p) const { return main_word[static_cast<std::size_t>(p)]; }
    std::uint64_t held(std::int64_t p) const { return held_word[static_cast<std::size_t>(p)]; }
};

template <class Body>
void for_each_phyxel_cell(const Lattice& lattice, const Body& body) {
    for (int z = 0; z < lattice.size.z; ++z)
        for (int y = 0; y < lattice.size.y; ++y)
            for (int x = 0; x < lattice.size.x; ++x) body(lattice.index(x, y, z), Int3(x, y, z));
}

void drop_hexels(const tissue::Model& model, tissue::State& state, const Int3& c, std::uint64_t word) {
    for (; word != 0; word &= word - 1)
        state.hexel_present.clear(
            model.hexels.index(c * model.hexels_per_edge + hexel_of_bit(model.hexels_per_edge, __builtin_ctzll(word))));
}

/// Phyxels joined to `seed` by face links, ghosts left out, appended to `piece`; marks them with `label`.
void collect_piece(const tissue::Model& model, const tissue::State& state, std::int64_t seed, int label,
                   std::vector<int>& labels, std::vector<std::int64_t>& piece, bool& held) {
    piece.assign(1, seed);
    labels[static_cast<std::size_t>(seed)] = label;
    for (std::size_t next = 0; next < piece.size(); ++next)
        for (std::size_t d = 0; d < tissue::kFaceDirections; ++d)
            for (int side = 0; side < 2; ++side) {
                const std::int64_t stride = model.phyxels.stride[static_cast<int>(d)];
                const std::int64_t here = piece[next], there = side == 0 ? here + stride : here - stride;
                if (!state.links[d].test(side == 0 ? here : there)) continue;
                if (model.phyxel_ghost.test(there)) {
                    held = true;
                } else if (labels[static_cast<std::size_t>(there)] == 0) {
                    labels[static_cast<std::size_t>(there)] = label;
                    piece.push_back(there);
                }
            }
}

/// Labels of the phyxels that stay: those held, or the largest piece where nothing holds.
BitArray find_kept(const tissue::Model& model, const tissue::State& state, const Words& words) {
    BitArray kept(model.phyxels.cells);
    const bool has_ghosts = model.phyxel_ghost.count() > 0;
    std::vector<int> labels(static_cast<std::size_t>(model.phyxels.cells), 0);
    std::vector<std::int64_t> piece, best;
    std::int64_t best_hexels = 0;
    int label = 0;
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        if (!state.phyxel_present.test(p) || labels[static_cast<std::size_t>(p)] != 0) continue;
        bool held = false;
        collect_piece(model, state, p, ++label, labels, piece, held);
        if (has_ghosts && held)
            for (std::int64_t q : piece) kept.set(q);
        std::int64_t hexels = 0;
        for (std::int64_t q : piece) hexels += __builtin_popcountll(words.main(q));
        if (!has_ghosts && hexels > best_hexels) {
            best_hexels = hexels;
            best = piece;
        }
    }
    for (std::int64_t q : best) kept.set(q);
    return kept;
}

}  // namespace

std::int64_t sever_initial_links(const tissue::Model& model, tissue::State& state) {
    const OccupancyShifts shifts(model.hexels_per_edge);
    const std::int64_t before = state.hexel_present.count();
    Words words;
    words.main_word.assign(static_cast<std::size_t>(model.phyxels.cells), 0);
    words.held_word.assign(static_cast<std::size_t>(model.phyxels.cells), 0);
    for_each_phyxel_cell(model.phyxels, [&](std::int64_t p, const Int3& c) {
        const std::uint64_t present = occupancy_of(model.hexels, shifts.m, state.hexel_present, c);
        const std::uint64_t main = shifts.largest_component(present);
        words.main_word[static_cast<std::size_t>(p)] = main;
        words.held_word[static_cast<std::size_t>(p)] = occupancy_of(model.hexels, shifts.m, model.hexel_held, c);
        drop_hexels(model, state, c, present & ~main);
        state.phyxel_present.assign(p, main != 0);
    });
    for (std::size_t d = 0; d < tissue::kLinkDirections.size(); ++d)
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
            if (!state.links[d].test(p)) continue;
            const bool holds = d < tissue::kFaceDirections ? face_holds(model, shifts, words, p, d)
                                                           : edge_holds(model, state, p, tissue::kLinkDirections[d]);
            if (!holds) state.links[d].clear(p);
        }
    const BitArray kept = find_kept(model, state, words);
    for_each_phyxel_cell(model.phyxels, [&](std::int64_t p, const Int3& c) {
        if (!state.phyxel_present.test(p) || kept.test(p)) return;
        drop_hexels(model, state, c, words.main(p));
        state.phyxel_present.clear(p);
        for (const NeighbourLink& link : neighbour_links()) {
            if (link.direction < 0) continue;
            state.links[static_cast<std::size_t>(link.direction)].clear(
                link.forward ? p : p + model.phyxels.offset(link.step));
        }
    });
    return before - state.hexel_present.count();
}

void initialise_topology(const tissue::Model& model, const tissue::State& state, Work& work) {
    const OccupancyShifts shifts(model.hexels_per_edge);
    const auto cells = static_cast<std::size_t>(model.phyxels.cells);
    work.occupancy.assign(cells, 0);
    work.held.assign(cells, 0);
    work.changed = BitArray(model.phyxels.cells);
    work.search_mark.assign(cells, 0);
    work.search_stack.assign(cells, 0);
    work.search = 0;
    for_each_phyxel_cell(model.phyxels, [&](std::int64_t p, const Int3& c) {
        work.occupancy[static_cast<std::size_t>(p)] =
            shifts.largest_component(occupancy_of(model.hexels, shifts.m, state.hexel_present, c));
        work.held[static_cast<std::size_t>(p)] = occupancy_of(model.hexels, shifts.m, model.hexel_held, c);
    });

    // Steps over faces to the nearest ghost, breadth first: searches for what holds a phyxel go downhill.
    constexpr std::uint16_t kFar = 65535;
    work.hold_distance.assign(cells, kFar);
    std::size_t count = 0;
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (model.phyxel_ghost.test(p)) {
            work.hold_distance[static_cast<std::size_t>(p)] = 0;
            work.search_stack[count++] = p;
        }
    for (std::size_t next = 0; next < count; ++next)
        for (int axis = 0; axis < 3; ++axis)
            for (int side = -1; side <= 1; side += 2) {
                const std::int64_t here = work.search_stack[next],
                                   there = here + side * std::int64_t{model.phyxels.stride[axis]};
                std::uint16_t& distance = work.hold_distance[static_cast<std::size_t>(there)];
                if (!model.phyxel_initial.test(there) || distance != kFar) continue;
                distance = static_cast<std::uint16_t>(
                    std::min(kFar - 1, work.hold_distance[static_cast<std::size_t>(here)] + 1));
                work.search_stack[count++] = there;
            }

    const auto& links = neighbour_links();
    for (std::size_t k = 0; k < links.size(); ++k) work.neighbour_offset[k] = model.phyxels.offset(links[k].step);
    work.hexel_weight.assign(static_cast<std::size_t>(kNeighbourhood * model.hexels_per_phyxel()), 0.0f);
    for (int bit = 0; bit < model.hexels_per_phyxel(); ++bit)
        for (int k = 0; k < kNeighbourhood; ++k) {
            const Vec3 hexel = (Vec3(hexel_of_bit(shifts.m, bit)) + 0.5) / static_cast<double>(shifts.m) - 0.5;
            const Vec3 d = hexel - Vec3(links[static_cast<std::size_t>(k)].step);
            work.hexel_weight[static_cast<std::size_t>(kNeighbourhood * bit + k)] =
                embedding_kernel(static_cast<float>(glm::dot(d, d)));
        }
}

}  // namespace calot::deformation
