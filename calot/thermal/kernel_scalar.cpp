// The heat kernels, one hexel at a time: the reference.

#include <algorithm>
#include <cmath>

#include "calot/base/units.h"
#include "calot/thermal/kernel.h"

namespace calot::thermal {

namespace {

constexpr auto kLatentHeat = static_cast<float>(kLatentHeatOfWater_J_per_kg);

bool bit(const std::uint8_t* bits, std::int64_t cell) {
    return (bits[cell >> 3] >> (cell & 7)) & 1u;
}

/// Harmonic mean: the conductance of two half cells in series.
float face_conductivity(float a, float b) {
    return a == b ? a : 2.0f * (a * b) / (a + b);
}

/// Share of blood flow that damage leaves: 1 in healthy tissue, 0 where it has coagulated (Omega >= 1), a cubic without
/// kinks between. Departure from the usual switch at Omega = 1, at which one hexel would flip from one step to the
/// next.
float flow_left(float damage) {
    const float healthy = 1.0f - std::min(damage, 1.0f);
    return healthy * healthy * (3.0f - 2.0f * healthy);
}

/// Conduction and surroundings; returns the new enthalpy.
float conduct(const HeatStep& step, std::int64_t i, HeatSums& sums) {
    const Properties& p = *step.properties;
    const float own_K = step.temperature_K[i];
    const tissue::MaterialIndex m = step.material[i];
    const CellGroup& group = step.groups[i / kGroupCells];
    float flow = 0.0f;
    for (int n = 0; n < 6; ++n) {
        if ((group.beside[n] >> (i % kGroupCells) & 1) == 0) continue;
        const std::int64_t j = i + (n % 2 == 0 ? -step.offset[n / 2] : step.offset[n / 2]);
        flow += face_conductivity(p.conducted_J_per_m3K[m], p.conducted_J_per_m3K[step.material[j]]) *
                (step.temperature_K[j] - own_K);
    }
    const float share = static_cast<float>(step.share[i]) * (1.0f / kWholeFace);
    const float gas_faces = share * static_cast<float>(step.faces[i] & kFaceMask);
    const float held_faces = share * static_cast<float>(step.faces[i] / kHeldFace);
    const float before = step.enthalpy_J_per_m3[i];
    const float rise_K = own_K - step.body_K;
    const float conducted = before + flow;
    const float perfused = conducted - p.to_blood_J_per_m3K[m] * flow_left(step.damage[i]) * rise_K;
    const float held = perfused - p.to_held_J_per_m3K[m] * held_faces * rise_K;
    // Departure: gas takes only heat above body temperature. Tissue that the instrument has not heated is kept at
    // body temperature by blood and the body beneath, although the gas is cooler.
    float to_gas = rise_K > 0.0f ? p.to_gas_J_per_m3K[m] * gas_faces * (own_K - step.gas_K) : 0.0f;
    to_gas = std::min(to_gas, std::max(held, 0.0f));
    const float next = held - to_gas;
    // Booked is what the hexel really lost, after rounding.
    if (bit(step.living, i)) sums.conducted += static_cast<double>(conducted - before);
    sums.perfusion += static_cast<double>(conducted - perfused);
    sums.surface += static_cast<double>((perfused - held) + (held - next));
    return next;
}

/// What exceeds the boiling point turns water to steam, which takes its own heat above T_0 along, so that the rest
/// stays at the boiling point: H - H' = dw (L + c_w (T_b - T_0)), excess = dw L.
void boil(const HeatStep& step, std::int64_t i, float& enthalpy, float& water, BlockMarks& marks,
          HeatSums& sums) {
    const Properties& p = *step.properties;
    const tissue::MaterialIndex m = step.material[i];
    const float capacity = p.dry_capacity_J_per_m3K[m] + water * p.water_capacity_J_per_kgK[m];
    const float excess = enthalpy - capacity * p.wet_limit_K;
    if (excess <= 0.0f) return;
    const float left = std::max(water - excess / kLatentHeat, 0.0f);
    const float steam = water - left;
    const float next = enthalpy - steam * p.boil_off_J_per_kg[m];
    sums.gas += static_cast<double>(enthalpy - next);
    sums.latent += static_cast<double>(steam * kLatentHeat);
    step.steam_kg_per_m3[i] += steam;
    marks.boiled = marks.changed = true;
    step.groups[i / kGroupCells].kind |= kChanged;
    water = left;
    enthalpy = next;
}

void settle(const HeatStep& step, std::int64_t i, float& enthalpy, BlockMarks& marks, HeatSums& sums) {
    const Properties& p = *step.properties;
    const tissue::MaterialIndex m = step.material[i];
    float& water = step.water_kg_per_m3[i];
    if (!(std::abs(enthalpy) < 1e30f) && sums.bad_hexel < 0) sums.bad_hexel = i;
    if (step.threshold) {  // no state of its own: water is a function of H
        const float taken = std::max(enthalpy - p.plateau_J_per_m3[m], 0.0f);
        water = std::max(p.water_kg_per_m3[m] - taken / kLatentHeat, 0.0f);
    } else if (water > 0.0f) {
        boil(step, i, enthalpy, water, marks, sums);
    }
    const bool wet = !step.threshold && water > 0.0f;
    const float capacity = p.dry_capacity_J_per_m3K[m] + water * p.water_capacity_J_per_kgK[m];
    const float rise = std::min(enthalpy * (1.0f / capacity), wet ? p.wet_limit_K : p.dry_limit_K[m]);
    const float now_K = step.body_K + (std::abs(rise) < tissue::kRest_K ? 0.0f : rise);
    step.next_temperature_K[i] = now_K;
    const std::int64_t group = i / kGroupCells - step.first / kGroupCells;
    if (now_K != step.body_K) marks.warm = static_cast<std::uint16_t>(marks.warm | 1u << (group % kBlockGroups));
    if (!wet && enthalpy >= p.spent_J_per_m3[m]) marks.spent = true;
    if (now_K <= kDamageThreshold_K) return;
    marks.changed = true;
    step.groups[i / kGroupCells].kind |= kChanged;
    step.peak_temperature_K[i] = std::max(step.peak_temperature_K[i], now_K);
    // A exp(-Ea/(R T)) as exp(ln rate(T_ref) + Ea/(R T_ref) (1 - T_ref/T)): A itself exceeds a float.
    const float exponent = p.damage_log_rate[m] + p.damage_slope[m] * ((now_K - kDamageReference_K) / now_K);
    const float rate = std::exp(std::min(exponent, 40.0f));
    step.damage[i] = std::min(step.damage[i] + rate * step.dt_s, kDamageLimit);
}

void deposit(const HeatStep& step, std::int64_t begin, std::int64_t end, HeatSums& sums) {
    for_joule_rows(step.joule, begin, end,
                   [&](std::int64_t first, const float* density, std::int64_t count) {
                       for (std::int64_t k = 0; k < count; ++k) {
                           if (!bit(step.living, first + k)) continue;
                           float& enthalpy = step.enthalpy_J_per_m3[first + k];
                           const float next = enthalpy + density[k] * step.joule.scaled_dt_s;
                           sums.delivered += static_cast<double>(next - enthalpy);
                           enthalpy = next;
                       }
                   });
}

}  // namespace

void step_blocks_scalar(const HeatStep& step, const std::int32_t* blocks, int count, BlockMarks* marks, HeatSums& sums) {
    for (int k = 0; k < count; ++k) {
        marks[k] = {};
        const std::int64_t begin = step.first + blocks[k] * kBlockCells, end = std::min(begin + kBlockCells, step.last);
        if (step.joule.density != nullptr) deposit(step, begin, end, sums);
        const std::uint16_t active = step.active->groups_of(blocks[k]);
        for (std::int64_t i = begin; i < end; ++i) {
            if ((active >> ((i - begin) / kGroupCells) & 1) == 0) continue;
            if ((step.groups[i / kGroupCells].present >> (i % kGroupCells) & 1) == 0) continue;
            float enthalpy = conduct(step, i, sums);
            if (bit(step.living, i)) settle(step, i, enthalpy, marks[k], sums);
            step.enthalpy_J_per_m3[i] = enthalpy;
        }
    }
}

}  // namespace calot::thermal
