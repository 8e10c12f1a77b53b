// The local update: only cells that lost hexels are looked at, and crumbs are searched for only from where a link went.
//
// A severed face link (c, n) can end edge links from c over n, and from n over c. So for a cell c that lost hexels
// these can change: its 6 face links, its 12 edge links, and the 12 edge links between pairs of its face neighbours.

#include "calot/deformation/topology.h"

#include <algorithm>
#include <array>

#include "calot/deformation/falling.h"
#include "calot/deformation/holding.h"
#include "calot/deformation/integrate.h"

namespace calot::deformation {

namespace {

struct WorkWords {
    const Work& work;
    std::uint64_t main(std::int64_t p) const { return work.occupancy[static_cast<std::size_t>(p)]; }
    std::uint64_t held(std::int64_t p) const { return work.held[static_cast<std::size_t>(p)]; }
};

/// What one call works on.
struct Severing {
    const tissue::Model& model;
    tissue::State& state;
    tissue::Exchange& exchange;
    Work& work;
    OccupancyShifts shifts;
    std::uint32_t first_search;  ///< searches of this call have this number or higher
    bool severed = false;        ///< a link went, so that crumbs may have come loose

    void mark_changed(std::int64_t phyxel) {
        if (work.changed.test(phyxel)) return;
        work.changed.set(phyxel);
        exchange.changed_phyxels.push_back(phyxel);
    }

    void sever(std::int64_t phyxel, std::int64_t offset, const NeighbourLink& link) {
        state.links[static_cast<std::size_t>(link.direction)].clear(link.forward ? phyxel : phyxel + offset);
        ++state.links_severed;
        severed = true;
        mark_changed(phyxel);
        mark_changed(phyxel + offset);
    }

    void remove_phyxel(std::int64_t phyxel) {
        const auto p = static_cast<std::size_t>(phyxel);
        work.occupancy[p] = 0;
        state.phyxel_present.clear(phyxel);
        for (std::size_t axis = 0; axis < 3; ++axis)
            state.displacement_m[axis][p] = state.velocity_m_per_s[axis][p] = 0.0f;
        mark_changed(phyxel);
    }

    /// Takes burnt hexels out of the words and keeps the largest components.
    void keep_main_components() {
        const std::size_t burnt = exchange.removed_hexels.size();  // drop_hexels appends behind
        const std::size_t first = exchange.changed_phyxels.size();
        for (std::size_t k = 0; k < burnt; ++k) {
            const Int3 hexel = model.hexels.coordinates(exchange.removed_hexels[k]), local = hexel % shifts.m;
            const std::int64_t phyxel = model.phyxel_of(hexel);
            work.occupancy[static_cast<std::size_t>(phyxel)] &=
                ~(std::uint64_t{1} << (local.x + shifts.m * (local.y + shifts.m * local.z)));
            mark_changed(phyxel);
        }
        for (std::size_t k = first; k < exchange.changed_phyxels.size(); ++k) {
            const std::int64_t phyxel = exchange.changed_phyxels[k];
            std::uint64_t& word = work.occupancy[static_cast<std::size_t>(phyxel)];
            const std::uint64_t main = shifts.largest_component(word);
            drop_hexels(model, state, exchange, phyxel, word & ~main);
            word = main;
            if (main == 0) remove_phyxel(phyxel);
        }
    }

    void sever_faces(std::int64_t phyxel) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (int side = -1; side <= 1; side += 2) {
                Int3 step(0);
                step[static_cast<int>(axis)] = side;
                const NeighbourLink& link = neighbour_links()[static_cast<std::size_t>(neighbour_index(step))];
                const std::int64_t offset = model.phyxels.offset(step);
                if (link_lives(state, phyxel, offset, link) &&
                    !face_holds(model, shifts, WorkWords{work}, side > 0 ? phyxel : phyxel + offset, axis))
                    sever(phyxel, offset, link);
            }
    }

    void sever_edge(std::int64_t phyxel, const Int3& step) {
        const NeighbourLink& link = neighbour_links()[static_cast<std::size_t>(neighbour_index(step))];
        const std::int64_t offset = model.phyxels.offset(step);
        if (link_lives(state, phyxel, offset, link) && !edge_holds(model, state, phyxel, step))
            sever(phyxel, offset, link);
    }

    /// The edge links of a phyxel and those between its face neighbours.
    void sever_edges(std::int64_t phyxel) {
        for (const NeighbourLink& link : neighbour_links()) {
            if (link.direction < tissue::kFaceDirections) continue;
            sever_edge(phyxel, link.step);
            // From one face neighbour of the phyxel to another, over it.
            const int axis = link.step.x != 0 ? 0 : 1;
            Int3 back(0);
            back[axis] = -link.step[axis];
            sever_edge(phyxel + model.phyxels.offset(back), link.step);
        }
    }

    /// Follows face links from `seed`, those nearer to what holds first. Returns how many phyxels the piece has, in the
    /// last places of Work::search_stack, or 0 when it is held.
    std::int64_t search_loose(std::int64_t seed) {
        const std::uint32_t number = ++work.search;
        const auto cells = static_cast<std::int64_t>(work.search_stack.size());
        std::int64_t waiting = 0, visited = 0;  // at the front of the stack, and at its end
        auto visit_later = [&](std::int64_t p) {
            work.search_mark[static_cast<std::size_t>(p)] = number;
            work.search_stack[static_cast<std::size_t>(waiting++)] = p;
        };
        visit_later(seed);
        while (waiting > 0) {
            const std::int64_t here = work.search_stack[static_cast<std::size_t>(--waiting)];
            ++visited;
            work.search_stack[static_cast<std::size_t>(cells - visited)] = here;
            std::array<std::int64_t, 6> next;
            int count = 0;
            for (std::size_t d = 0; d < tissue::kFaceDirections; ++d)
                for (int side = 0; side < 2; ++side) {
                    const std::int64_t stride = model.phyxels.stride[static_cast<int>(d)];
                    const std::int64_t there = side == 0 ? here + stride : here - stride;
                    if (!state.links[d].test(side == 0 ? here : there)) continue;
                    const std::uint32_t mark = work.search_mark[static_cast<std::size_t>(there)];
                    // Earlier searches of this call that still have links ended at what holds.
                    if (model.phyxel_ghost.test(there) || (mark >= first_search && mark != number)) return 0;
                    if (mark != number) next[static_cast<std::size_t>(count++)] = there;
                }
            const std::uint16_t own = work.hold_distance[static_cast<std::size_t>(here)];
            auto rank = [&](std::int64_t p) {
                const std::uint16_t distance = work.hold_distance[static_cast<std::size_t>(p)];
                return distance > own ? 0 : distance == own ? 1 : 2;
            };
            for (int order = 0; order < 3; ++order)  // the last one pushed is the first visited
                for (int k = 0; k < count; ++k)
                    if (rank(next[static_cast<std::size_t>(k)]) == order)
                        visit_later(next[static_cast<std::size_t>(k)]);
        }
        return visited;
    }

    std::int64_t visited_phyxel(std::int64_t k) const {
        return work.search_stack[work.search_stack.size() - 1 - static_cast<std::size_t>(k)];
    }

    /// Lets the piece that search_loose found fall.
    void free_piece(std::int64_t count) {
        for (std::int64_t k = 0; k < count; ++k) {
            const std::int64_t phyxel = visited_phyxel(k);
            drop_hexels(model, state, exchange, phyxel, work.occupancy[static_cast<std::size_t>(phyxel)]);
            remove_phyxel(phyxel);
            for (const NeighbourLink& link : neighbour_links()) {
                if (link.direction < 0) continue;
                const std::int64_t offset = model.phyxels.offset(link.step);
                if (link_lives(state, phyxel, offset, link)) sever(phyxel, offset, link);
            }
        }
    }

    /// With ghosts: whatever hung on a severed link and finds no ghost any more falls.
    void free_loose() {
        for (std::size_t k = 0; k < exchange.changed_phyxels.size(); ++k) {
            const std::int64_t phyxel = exchange.changed_phyxels[k];
            if (!state.phyxel_present.test(phyxel) ||
                work.search_mark[static_cast<std::size_t>(phyxel)] >= first_search)
                continue;
            free_piece(search_loose(phyxel));
        }
    }

    /// Without ghosts: all pieces but the largest fall. Looks at the whole lattice.
    void free_all_but_largest() {
        std::int64_t best_seed = -1, best_hexels = 0;
        for_each_present([&](std::int64_t phyxel) {
            if (work.search_mark[static_cast<std::size_t>(phyxel)] >= first_search) return;
            const std::int64_t count = search_loose(phyxel);
            std::int64_t hexels = 0;
            for (std::int64_t k = 0; k < count; ++k)
                hexels += __builtin_popcountll(work.occupancy[static_cast<std::size_t>(visited_phyxel(k))]);
            if (hexels > best_hexels) {
                best_hexels = hexels;
                best_seed = phyxel;
            }
        });
        if (best_seed < 0) return;
        first_search = work.search + 1;
        search_loose(best_seed);
        for_each_present([&](std::int64_t phyxel) {
            if (work.search_mark[static_cast<std::size_t>(phyxel)] < first_search) free_piece(search_loose(phyxel));
        });
    }

    template <class Body>
    void for_each_present(const Body& body) {
        const auto& words = state.phyxel_present.words();
        for (std::size_t w = 0; w < words.size(); ++w)
            for (std::uint64_t rest = words[w]; rest != 0; rest &= rest - 1) {
                const auto phyxel = static_cast<std::int64_t>(64 * w) + __builtin_ctzll(rest);
                if (state.phyxel_present.test(phyxel)) body(phyxel);  // a body may clear bits ahead
            }
    }
};

}  // namespace

void sever_links(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work) {
    exchange.changed_phyxels.clear();
    if (exchange.removed_hexels.empty()) return;
    if (work.search > 0xf0000000u) {  // after some ten hours of cutting
        std::fill(work.search_mark.begin(), work.search_mark.end(), 0u);
        work.search = 0;
    }
    Severing severing{model, state, exchange, work, OccupancyShifts(model.hexels_per_edge), work.search + 1};
    severing.keep_main_components();
    const std::size_t touched = exchange.changed_phyxels.size();  // severing appends the other ends
    for (std::size_t k = 0; k < touched; ++k) severing.sever_faces(exchange.changed_phyxels[k]);
    for (std::size_t k = 0; k < touched; ++k) severing.sever_edges(exchange.changed_phyxels[k]);
    if (severing.severed) {
        if (model.phyxel_ghost.count() > 0)
            severing.free_loose();
        else
            severing.free_all_but_largest();
    }
    std::sort(exchange.changed_phyxels.begin(), exchange.changed_phyxels.end());
    for (const std::int64_t phyxel : exchange.changed_phyxels) work.changed.clear(phyxel);
}

void sever_burnt_links(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work) {
    sever_links(model, state, exchange, work);
    if (exchange.changed_phyxels.empty()) return;
    refresh_phyxels(model, state, work, exchange.changed_phyxels);
    update_gradients_about(model, state, work, exchange.changed_phyxels);
}

}  // namespace calot::deformation
