// The heat kernels, a vector of neighbouring cells at a time. Formulas and their sources: kernel_scalar.cpp.
//
//     T[i - slow], T[i - middle], T[i - 1]  ->  i .. i + N - 1  <-  T[i + 1], T[i + middle], T[i + slow]
//
// Nearly all vectors lie inside one tissue (group_material): its properties are then one number for all lanes. Where
// tissues meet, properties are looked up lane by lane. Neighbours' presence is a few bits at a constant offset.
// Multiplication and addition stay separate so that instruction sets with and without fused multiply-add give the same
// bytes.

#include "calot/thermal/kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/thermal/kernel_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"
#include "calot/base/units.h"

HWY_BEFORE_NAMESPACE();
namespace calot::thermal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

using D = simd::Floats;
using DI = hn::RebindToSigned<D>;
using F = hn::Vec<D>;
using Mask = hn::Mask<D>;

/// Lanes of a mask from the low bits of an integer.
HWY_INLINE Mask mask_of(std::uint32_t bits) {
    std::uint8_t lanes[8] = {};
    std::memcpy(lanes, &bits, sizeof(bits));
    return hn::LoadMaskBits(D(), lanes);
}

HWY_INLINE F number(float value) {
    return hn::Set(D(), value);
}

/// A property of the material of every lane.
class PropertyLookup {
  public:
    /// For the cells from i on; all of `group`'s material, unless that is kMixedGroup.
    HWY_INLINE PropertyLookup(const tissue::MaterialIndex* material, std::int64_t i, std::uint8_t group)
        : group_(group) {
        if (HWY_UNLIKELY(group == kMixedGroup)) index_ = indices(material + i);
    }
    HWY_INLINE F operator()(const Properties::PerMaterial<float>& property) const {
        if (HWY_LIKELY(group_ != kMixedGroup)) return number(property[group_]);
        return hn::GatherIndex(D(), property.data(), index_);
    }
    static HWY_INLINE hn::Vec<DI> indices(const tissue::MaterialIndex* material) {
        const hn::Rebind<std::uint8_t, D> bytes;
        return hn::PromoteTo(DI(), hn::LoadU(bytes, material));
    }

  private:
    std::uint8_t group_;
    hn::Vec<DI> index_ = hn::Zero(DI());
};

HWY_INLINE double sum_of(F values) {
    HWY_ALIGN float lanes[16];
    hn::Store(values, D(), lanes);
    double sum = 0.0;
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) sum += static_cast<double>(lanes[k]);
    return sum;
}

/// e^x for x in [-87, 87], to 2e-7: x = n ln 2 + r, Taylor's series in |r| <= ln 2 / 2 (the first term left out is
/// r^8/8! = 5e-9).
HWY_INLINE F exponential(F x) {
    const D d;
    const F n = hn::Round(hn::Mul(x, number(1.44269504f)));
    // ln 2 = 355/512 - 2.1219444e-4; n times the first part is exact.
    const F r = hn::Sub(hn::Sub(x, hn::Mul(n, number(0.693359375f))), hn::Mul(n, number(-2.12194440e-4f)));
    F series = number(1.0f / 5040.0f);
    for (const float coefficient : {1.0f / 720.0f, 1.0f / 120.0f, 1.0f / 24.0f, 1.0f / 6.0f, 0.5f, 1.0f, 1.0f})
        series = hn::Add(hn::Mul(series, r), number(coefficient));
    const auto power = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(DI(), n), hn::Set(DI(), 127)));
    return hn::Mul(series, hn::BitCast(d, power));
}

bool is_warm(const HeatStep& step, std::int64_t begin, std::int64_t end) {
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    for (std::int64_t i = begin; i < end; i += lanes) {
        const std::uint32_t present = simd::bits_at(d, step.present, i);
        if (present == 0) continue;
        // Not "unequal", which some instruction sets deny for what is not a number.
        const Mask cold = hn::Eq(hn::Load(d, step.temperature_K + i), number(step.body_K));
        if (!hn::AllFalse(d, hn::AndNot(cold, mask_of(present)))) return true;
    }
    return false;
}

/// sum_alive k_ij (T_j - T_i) of a group in one tissue whose neighbours are all there.
HWY_INLINE F conduction_inside(const HeatStep& step, std::int64_t i, F own_K, F conductivity) {
    const D d;
    F sum = hn::Zero(d);
    for (const std::int64_t stride : step.offset) {
        sum = hn::Add(sum, hn::Sub(hn::LoadU(d, step.temperature_K + i - stride), own_K));
        sum = hn::Add(sum, hn::Sub(hn::LoadU(d, step.temperature_K + i + stride), own_K));
    }
    return hn::Mul(conductivity, sum);
}

/// The same anywhere, with the numbers of faces towards gas and towards held tissue.
struct Faces {
    F conduction, gas, held;
};
HWY_INLINE Faces conduction_anywhere(const HeatStep& step, std::int64_t i, F own_K, F conductivity,
                                     std::uint8_t group) {
    const D d;
    const F one = number(1.0f);
    Faces faces{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    auto across = [&](std::int64_t j) HWY_ATTR {
        const std::uint32_t present = simd::bits_at(d, step.present, j);
        const std::uint32_t held = simd::bits_at(d, step.held, j) & ~present;
        const F difference = hn::Sub(hn::LoadU(d, step.temperature_K + j), own_K);
        F face = conductivity;
        if (group == kMixedGroup) {
            const F other = hn::GatherIndex(d, step.properties->conductivity_W_per_mK.data(),
                                            PropertyLookup::indices(step.material + j));
            // Both zero only where either is absent.
            const F total = hn::Max(hn::Add(conductivity, other), number(1e-30f));
            face = hn::IfThenElse(hn::Eq(conductivity, other), conductivity,
                                  hn::Div(hn::Mul(number(2.0f), hn::Mul(conductivity, other)), total));
        }
        faces.conduction = hn::Add(faces.conduction, hn::IfThenElseZero(mask_of(present), hn::Mul(face, difference)));
        faces.held = hn::Add(faces.held, hn::IfThenElseZero(mask_of(held), one));
        faces.gas = hn::Add(faces.gas, hn::IfThenZeroElse(mask_of(present | held), one));
    };
    for (const std::int64_t stride : step.offset) {
        across(i - stride);
        across(i + stride);
    }
    return faces;
}

void conduct_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    const F body = number(step.body_K), zero = hn::Zero(d);
    F perfusion = zero, surface = zero;
    for (std::int64_t i = begin; i < end; i += lanes) {
        const std::uint32_t present = simd::bits_at(d, step.present, i);
        if (present == 0) continue;
        const std::uint8_t group = step.group_material[i / kGroupCells];
        const PropertyLookup of(step.material, i, group);
        std::uint32_t surrounded = present;
        for (const std::int64_t stride : step.offset)
            surrounded &= simd::bits_at(d, step.present, i - stride) & simd::bits_at(d, step.present, i + stride);

        const F own_K = hn::Load(d, step.temperature_K + i);
        const F conductivity = of(step.properties->conductivity_W_per_mK);
        const F rise = hn::Sub(own_K, body);
        const F before = hn::Load(d, step.enthalpy_J_per_m3 + i);
        const F perfused_per_K = hn::Mul(of(step.properties->perfusion_W_per_m3K), number(step.dt_s));
        const Mask mask = mask_of(present);
        F next;
        if (HWY_LIKELY(surrounded == present && group != kMixedGroup)) {
            const F flow = conduction_inside(step, i, own_K, conductivity);
            const F conducted = hn::Add(before, hn::Mul(number(step.conduction_factor), flow));
            next = hn::Sub(conducted, hn::Mul(perfused_per_K, rise));
            perfusion = hn::Add(perfusion, hn::IfThenElseZero(mask, hn::Sub(conducted, next)));
        } else {
            const Faces faces = conduction_anywhere(step, i, own_K, conductivity, group);
            const F conducted = hn::Add(before, hn::Mul(number(step.conduction_factor), faces.conduction));
            const F factor = number(step.surface_factor);
            const F perfused = hn::Sub(conducted, hn::Mul(perfused_per_K, rise));
            const F held = hn::Sub(
                perfused,
                hn::Mul(hn::Mul(hn::Mul(factor, of(step.properties->held_transfer_W_per_m2K)), faces.held), rise));
            F to_gas = hn::Mul(hn::Mul(hn::Mul(factor, of(step.properties->gas_transfer_W_per_m2K)), faces.gas),
                               hn::Sub(own_K, number(step.gas_K)));
            to_gas = hn::Min(hn::IfThenElseZero(hn::Gt(rise, zero), to_gas), hn::Max(held, zero));
            next = hn::Sub(held, to_gas);
            perfusion = hn::Add(perfusion, hn::IfThenElseZero(mask, hn::Sub(conducted, perfused)));
            const F lost = hn::Add(hn::Sub(perfused, held), hn::Sub(held, next));
            surface = hn::Add(surface, hn::IfThenElseZero(mask, lost));
        }
        hn::BlendedStore(next, mask, d, step.enthalpy_J_per_m3 + i);
    }
    sums.perfusion += sum_of(perfusion);
    sums.surface += sum_of(surface);
}

/// Steam of the lanes above the boiling point; returns it [kg/m^3] and changes water and enthalpy.
HWY_INLINE F boil(F excess, F boil_off, F& water, F& enthalpy) {
    const D d;
    const F wanted = hn::Div(hn::Max(excess, hn::Zero(d)), number(static_cast<float>(kLatentHeatOfWater_J_per_kg)));
    const F left = hn::Max(hn::Sub(water, wanted), hn::Zero(d));
    const F steam = hn::Sub(water, left);
    enthalpy = hn::Sub(enthalpy, hn::Mul(steam, boil_off));
    water = left;
    return steam;
}

/// Arrhenius' integral over the step for lanes warmer than kDamageThreshold_K.
HWY_INLINE F add_damage(const HeatStep& step, const PropertyLookup& of, F now_K, F damage) {
    const F relative = hn::Div(hn::Sub(now_K, number(kDamageReference_K)), now_K);
    const F exponent =
        hn::Add(of(step.properties->damage_log_rate), hn::Mul(of(step.properties->damage_slope), relative));
    const F rate = exponential(hn::Max(hn::Min(exponent, number(40.0f)), number(-87.0f)));
    const F after = hn::Min(hn::Add(damage, hn::Mul(rate, number(step.dt_s))), number(kDamageLimit));
    return hn::IfThenElse(hn::Gt(now_K, number(kDamageThreshold_K)), after, damage);
}

void settle_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    const D d;
    const Properties& p = *step.properties;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    const F zero = hn::Zero(d), latent_heat = number(static_cast<float>(kLatentHeatOfWater_J_per_kg));
    F gas = zero, latent = zero;
    Mask spent = hn::FirstN(d, 0);
    for (std::int64_t i = begin; i < end; i += lanes) {
        const std::uint32_t present = simd::bits_at(d, step.present, i);
        if (present == 0) continue;
        const Mask mask = mask_of(present);
        const PropertyLookup of(step.material, i, step.group_material[i / kGroupCells]);
        const F dry_capacity = of(p.dry_capacity_J_per_m3K), water_capacity = of(p.water_capacity_J_per_kgK);
        const F dry_limit = of(p.dry_limit_K);
        F enthalpy = hn::Load(d, step.enthalpy_J_per_m3 + i);
        F water = hn::Load(d, step.water_kg_per_m3 + i);
        const Mask sound = hn::Lt(hn::Abs(enthalpy), number(1e30f));
        if (HWY_UNLIKELY(!hn::AllTrue(d, hn::Or(sound, hn::Not(mask)))) && sums.bad_hexel < 0)
            sums.bad_hexel = i + hn::FindFirstTrue(d, hn::AndNot(sound, mask));

        F limit = dry_limit;
        Mask dry = mask;
        F capacity = hn::Add(dry_capacity, hn::Mul(water, water_capacity));
        if (step.threshold) {
            const F taken = hn::Max(hn::Sub(enthalpy, of(p.plateau_J_per_m3)), zero);
            water = hn::Max(hn::Sub(of(p.water_kg_per_m3), hn::Div(taken, latent_heat)), zero);
            hn::BlendedStore(water, mask, d, step.water_kg_per_m3 + i);
        } else {
            const F excess = hn::Sub(enthalpy, hn::Mul(capacity, number(p.wet_limit_K)));
            const Mask boils = hn::And(hn::And(hn::Gt(water, zero), hn::Gt(excess, zero)), mask);
            if (HWY_UNLIKELY(!hn::AllFalse(d, boils))) {
                F after = enthalpy, left = water;
                const F steam = boil(excess, of(p.boil_off_J_per_kg), left, after);
                gas = hn::Add(gas, hn::IfThenElseZero(boils, hn::Sub(enthalpy, after)));
                latent = hn::Add(latent, hn::IfThenElseZero(boils, hn::Mul(steam, latent_heat)));
                enthalpy = hn::IfThenElse(boils, after, enthalpy);
                water = hn::IfThenElse(boils, left, water);
                capacity = hn::Add(dry_capacity, hn::Mul(water, water_capacity));
                hn::BlendedStore(enthalpy, boils, d, step.enthalpy_J_per_m3 + i);
                hn::BlendedStore(water, boils, d, step.water_kg_per_m3 + i);
                hn::BlendedStore(hn::Add(hn::Load(d, step.steam_kg_per_m3 + i), steam), boils, d,
                                 step.steam_kg_per_m3 + i);
                sums.boiled = true;
            }
            const Mask wet = hn::Gt(water, zero);
            limit = hn::IfThenElse(wet, number(p.wet_limit_K), dry_limit);
            dry = hn::AndNot(wet, mask);
        }
        const F now_K = hn::Add(number(step.body_K), hn::Min(hn::Div(enthalpy, capacity), limit));
        hn::BlendedStore(now_K, mask, d, step.temperature_K + i);
        if (!hn::AllFalse(d, dry)) spent = hn::Or(spent, hn::And(dry, hn::Ge(enthalpy, of(p.spent_J_per_m3))));

        const F peak = hn::Load(d, step.peak_temperature_K + i);
        const Mask hotter = hn::And(hn::Gt(now_K, peak), mask);
        if (!hn::AllFalse(d, hotter)) hn::BlendedStore(now_K, hotter, d, step.peak_temperature_K + i);
        const Mask hurts = hn::And(hn::Gt(now_K, number(kDamageThreshold_K)), mask);
        if (HWY_UNLIKELY(!hn::AllFalse(d, hurts))) {
            const F damage = hn::Load(d, step.damage + i);
            if (!hn::AllFalse(d, hn::And(hurts, hn::Lt(damage, number(kDamageLimit)))))
                hn::BlendedStore(add_damage(step, of, now_K, damage), mask, d, step.damage + i);
        }
    }
    sums.gas += sum_of(gas);
    sums.latent += sum_of(latent);
    sums.spent |= !hn::AllFalse(d, spent);
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::thermal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::thermal {

HWY_EXPORT(is_warm);
HWY_EXPORT(conduct_cells);
HWY_EXPORT(settle_cells);

bool is_warm(const HeatStep& step, std::int64_t begin, std::int64_t end) {
    return HWY_DYNAMIC_DISPATCH(is_warm)(step, begin, end);
}
void conduct_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    HWY_DYNAMIC_DISPATCH(conduct_cells)(step, begin, end, sums);
}
void settle_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    HWY_DYNAMIC_DISPATCH(settle_cells)(step, begin, end, sums);
}

}  // namespace calot::thermal
#endif
