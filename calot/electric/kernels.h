#pragma once
// The loops over a level. Each exists twice with the same bytes as result: plain (kernels_reference.cpp) and wide
// (kernels_simd.cpp). Multiplication and addition stay separate and sums keep 64 partial sums in double, one per place
// in four consecutive groups, so that the instruction set does not show in the result.

#include <algorithm>
#include <array>
#include <cstdint>

#include "calot/electric/level.h"
#include "calot/tissue/material.h"

namespace calot::electric {

/// Damping of Jacobi smoothing.
inline constexpr float kDamping = 0.85f;
/// Coarse corrections are scaled by this: constant aggregates make the coarse grid up to twice too stiff (Braess 1995).
inline constexpr float kCorrection = 1.6f;
/// On the finest level Jacobi and the coarse correction are added, not chained; `weight` counts this much then. (Tuned:
/// with 1, 1.5, 2, 2.5, 3.5 the standard scene takes 6.0, 5.5, 5.3, 5.4, 5.9 iterations a solve.)
inline constexpr float kAdded = 2.0f;

/// What an outer iteration works on, beside the finest level's vectors.
struct Krylov {
    CellStorage storage;
    Cells x;  ///< the potential
    Cells p;  ///< search direction
};

/// Partial sums of a dot product: one per place in this many consecutive groups. (Several, so that additions need not
/// wait for one another.)
inline constexpr std::int64_t kSums = 4 * kGroup;

/// What a step of conjugate gradients leaves behind.
struct Norms {
    double residual = 0.0;  ///< r . r
    double weighted = 0.0;  ///< r . weight r
};

/// Conductivity of tissue as it is now, from its enthalpy and water (conductivity.h).
struct Conductivity {
    template <class T>
    using PerMaterial = std::array<T, 256>;

    const float* rest_S_per_m = nullptr;  ///< of each hexel at body temperature
    const std::uint8_t* present = nullptr;
    const std::uint8_t* held = nullptr;
    const tissue::MaterialIndex* material = nullptr;
    const float* enthalpy_J_per_m3 = nullptr;
    const float* water_kg_per_m3 = nullptr;
    PerMaterial<float> slope_per_K{};  ///< relative rise per kelvin
    PerMaterial<float> dry_S_per_m{};
    PerMaterial<float> dry_capacity_J_per_m3K{};  ///< tissue::PhaseCurve
    PerMaterial<float> water_capacity_J_per_kgK{};
    PerMaterial<float> alive_water_kg_per_m3{};
    PerMaterial<float> per_water_m3_per_kg{};  ///< its inverse; 0 without water
    float wet_limit_K = 0.0f;                  ///< rise that wet tissue stops at

    /// sigma = sigma_w - (sigma_w - sigma_dry) (share of the water that is gone), sigma_w = sigma_0 (1 + slope (T -
    /// T_0)) with T up to boiling; 0 where nothing conducts. Organs that hold tissue, and hexels without heat, are at
    /// rest.
    float of(std::int64_t hexel) const {
        const bool there = (present[hexel >> 3] >> (hexel & 7)) & 1, organ = (held[hexel >> 3] >> (hexel & 7)) & 1;
        if (!there && !organ) return 0.0f;
        const float enthalpy = enthalpy_J_per_m3[hexel], water = water_kg_per_m3[hexel];
        if (!there || enthalpy == 0.0f) return rest_S_per_m[hexel];
        const tissue::MaterialIndex m = material[hexel];
        const float capacity = dry_capacity_J_per_m3K[m] + water * water_capacity_J_per_kgK[m];
        const float rise = std::min(enthalpy * (1.0f / capacity), wet_limit_K);
        const float wet = rest_S_per_m[hexel] * (1.0f + slope_per_K[m] * rise);
        const float missing = (alive_water_kg_per_m3[m] - water) * per_water_m3_per_kg[m];
        return wet - (wet - dry_S_per_m[m]) * missing;
    }
};

/// Sums over the heat of a window, for one volt.
struct HeatSums {
    using Places = std::array<double, kGroup>;  ///< a partial sum for each place in a group
    std::array<Places, 256> kept{};             ///< by material, in hexels that are present
    Places rest{};                              ///< elsewhere
    std::array<float, 256> greatest{};          ///< of heat times conductivity: the square of the current density
    /// Back to zero, for so many materials.
    void clear(std::size_t materials) {
        std::fill_n(kept.begin(), materials, Places{});
        rest = {};
        std::fill_n(greatest.begin(), materials, 0.0f);
    }
};

struct Kernels {
    /// out[k] = conductivity of hexel first + k, 0 where there is none.
    void (*gather)(const Conductivity& tissue, std::int64_t first, std::int64_t count, float* out);
    /// g on faces between cells of conductivity sigma, in S/m: harmonic means; ground 0. Over level.groups.
    void (*faces)(Level& level, const float* sigma, std::int64_t begin, std::int64_t end);
    /// weight from g and ground, over level.groups. (Coarse levels list all their groups for this.)
    void (*weights)(Level& level, std::int64_t begin, std::int64_t end);
    /// Galerkin sum of 2x2x2 cells, one plane of the coarse level: g and ground.
    void (*aggregate)(const Level& fine, Level& coarse, int plane);

    // Over level.groups[begin, end):
    /// scratch = A p; returns p . A p.
    double (*apply)(Level& level, const float* p, std::int64_t begin, std::int64_t end);
    /// a . b
    double (*dot)(const Level& level, const float* a, const float* b, std::int64_t begin, std::int64_t end);
    /// x = alpha x, where there is an unknown, else 0; right -= alpha scratch.
    Norms (*start)(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end);
    /// x += alpha p, right -= alpha scratch.
    Norms (*advance)(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end);
    /// p = kAdded weight right + kCorrection * coarse + beta p, where there is an unknown. `coarse` lies as the coarse
    /// level's vectors do.
    void (*direction)(const Level& level, Krylov& krylov, const float* coarse, float beta, std::int64_t begin,
                      std::int64_t end);
    /// scratch = right - A solution.
    void (*residual)(Level& level, std::int64_t begin, std::int64_t end);
    /// scratch = solution + weight (right - A solution); returns right . scratch.
    double (*smooth)(Level& level, std::int64_t begin, std::int64_t end);
    /// coarse right = sum of the fine values, coarse solution = weight right. Groups of the coarse level.
    void (*restrict_residual)(const Level& fine, const float* values, Level& coarse, std::int64_t begin,
                              std::int64_t end);
    /// fine solution += kCorrection * coarse solution. Groups of the fine level.
    void (*correct)(Level& fine, const Level& coarse, std::int64_t begin, std::int64_t end);
    /// out = factor times Joule heat per cell in units of s V^2: sum over faces of (g dphi)^2 / (2 sigma).
    void (*heat)(const Level& level, const float* sigma, const float* phi, float factor, float* out, std::int64_t begin,
                 std::int64_t end);
    /// out[k] = scale heat[k] where hexel first + k is present, else 0; adds to the sums, in groups of kGroup.
    void (*split)(const Conductivity& tissue, const float* heat, const float* sigma, float scale, std::int64_t first,
                  std::int64_t count, float* out, HeatSums& sums);
};

Kernels reference_kernels();
Kernels wide_kernels();  ///< for the instruction set that is the best here and now

}  // namespace calot::electric
