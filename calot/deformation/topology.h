#pragma once
// Burning changes topology: links are severed where tissue no longer holds together (docs/physics.md section 4).
//
// The rules, on the m^3 hexels of a phyxel's cell as bits of one word:
//   - a phyxel keeps its largest component of face neighbours (of equals, the one with the lowest bit);
//   - a face link lives while the main components of both cells touch across the face;
//   - an edge link lives while one of its two two-step face paths does;
//   - a ghost's component is the held cells of its cell, joined through held cells inside the phyxel's own cell; ghosts
//     are linked among themselves, since the organ that holds is rigid;
//   - what no path of links joins to a ghost is a crumb and falls. Where there is no ghost at all, the largest piece
//     stays (of equals, the one with the lowest cell) and the others are crumbs.
// Tissue only ever goes, so links never come back, and the outcome is a function of the present hexels alone.

#include "calot/deformation/work.h"

namespace calot::deformation {

/// For the phyxels that lost hexels this tick (Exchange::removed_hexels): recomputes components and links, frees crumbs
/// (their hexels leave State::hexel_present, are appended to Exchange::removed_hexels and counted as fallen), refreshes
/// what changed and lists it in Exchange::changed_phyxels, in the order of cells. Nothing is allocated.
void sever_burnt_links(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// The first part of it: all but what is refreshed, for whoever keeps rest properties elsewhere.
void sever_links(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// Before the first step: brings a fresh State to where the rules above hold, severing links that the anatomy itself
/// does not carry (lobes in neighbouring cells that do not touch) and dropping crumbs. Not counted as severed or
/// fallen. Returns the hexels dropped. The same rules over the whole lattice: the reference of sever_burnt_links.
std::int64_t sever_initial_links(const tissue::Model& model, tissue::State& state);

/// Part of make_work, comes first: Work::occupancy, the embedding's table and the searches' scratch.
void initialise_topology(const tissue::Model& model, const tissue::State& state, Work& work);

}  // namespace calot::deformation
