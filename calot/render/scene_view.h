#pragma once
// From model and state to what a View holds. The caller moves vertices (deformation::embed_points); here they get their
// looks, normals and what heat did to them. Pure functions.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "calot/render/view.h"
#include "calot/tissue/state.h"

namespace calot::render {

/// The surface's vertices, as surface::Surface and deformation::embed_points give them. All of one length, except that
/// `deformation_gradient` may be empty (normals then stay as at rest).
struct SurfaceVertices {
    std::span<const Vec3f> rest_m;
    std::span<const Vec3f> rest_normal;
    std::span<const std::int64_t> owner;  ///< a hexel near each vertex
    std::span<const Vec3f> world_m;
    std::span<const Mat3f> deformation_gradient;
    std::span<const float> film_m{};  ///< of blood, over hexels (effects::Bleeding); empty = none
};

/// Fills `vertices` (resized). `temperature_K` is thermal::Work's array over hexels; empty = all at body temperature.
/// Looks, temperatures and water are averages over the present hexels of the 3^3 around the owner, weighted by their
/// distance to the vertex; exposure is the share of burnt cells among the empty ones within 2.5 cells.
void fill_tissue(const tissue::Model& model, const tissue::State& state, std::span<const float> temperature_K,
                 const SurfaceVertices& surface, std::vector<TissueVertex>& vertices);
/// The vertices low ... high - 1 of them alone; `vertices` has all places.
void fill_tissue(const tissue::Model& model, const tissue::State& state, std::span<const float> temperature_K,
                 const SurfaceVertices& surface, std::size_t low, std::size_t high, std::span<TissueVertex> vertices);

/// Only moves vertices that have their looks: world, rest and turned normals, all of one length.
void place_tissue(std::span<const Vec3f> rest_m, std::span<const Vec3f> rest_normal, std::span<const Vec3f> world_m,
                  std::span<const Mat3f> deformation_gradient, std::span<TissueVertex> vertices);

/// Which look an organ or material name asks for ("cystic_artery" -> artery ...); peritoneum when nothing fits.
Look look_of(const std::string& name);

/// Meshes of the model's rigid organs within `reach_m` of the hexel lattice, at about `spacing_m`: ducts and arteries
/// finer, liver and backdrop coarser.
std::vector<OrganMesh> organ_meshes(const tissue::Model& model, double spacing_m = 1.6e-3, double reach_m = 0.07);

}  // namespace calot::render
