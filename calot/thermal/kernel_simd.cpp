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

/// Bits of presence are read 64 cells at a time, and used a vector of cells at a time.
constexpr std::int64_t kWordCells = 64;
static_assert(kBlockCells % kWordCells == 0);

/// The bits of the 64 cells from `cell` on.
HWY_INLINE std::uint64_t word_at(const std::uint8_t* bits, std::int64_t cell) {
    std::uint64_t words[2];
    std::memcpy(words, bits + (cell >> 6) * 8, sizeof(words));
    const auto shift = static_cast<unsigned>(cell & 63);
    return (words[0] >> shift) | ((words[1] << 1) << (63 - shift));
}

/// Lanes of a mask from bits of a word, from bit `first` on.
HWY_INLINE Mask mask_of(std::uint64_t word, std::int64_t first) {
    word >>= first;
    std::uint8_t lanes[8];
    std::memcpy(lanes, &word, sizeof(word));
    return hn::LoadMaskBits(D(), lanes);
}
/// Those bits as an integer.
HWY_INLINE std::uint64_t lanes_of(std::uint64_t word, std::int64_t first) {
    return (word >> first) & ((std::uint64_t{1} << hn::Lanes(D())) - 1);
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

/// A sum over cells in 16 partial sums, cell i in that of i mod 16, so that it does not depend on how wide vectors are.
class CellSum {
  public:
    /// `k` counts cells from a multiple of 16 on.
    HWY_INLINE void add(std::int64_t k, F values) {
        float* partial = partial_ + k % 16;
        hn::Store(hn::Add(hn::Load(D(), partial), values), D(), partial);
    }
    HWY_INLINE void add_one(std::int64_t k, float value) { partial_[k % 16] += value; }
    /// Pairwise, which is more exact than one after the other.
    HWY_INLINE double total() const {
        float sums[8];
        for (int k = 0; k < 8; ++k) sums[k] = partial_[k] + partial_[k + 8];
        for (int k = 0; k < 4; ++k) sums[k] += sums[k + 4];
        return static_cast<double>((sums[0] + sums[2]) + (sums[1] + sums[3]));
    }

  private:
    HWY_ALIGN float partial_[16] = {};
};

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

double deposit_tile(const HeatStep& step, const HeatTile& density, std::int64_t first, std::int64_t stride, int rows,
                    int columns) {
    const D d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    const F dt = number(step.dt_s);
    CellSum sum;
    for (int row = 0; row < rows; ++row) {
        const std::int64_t i = first + row * stride;
        const std::uint64_t present = word_at(step.present, i) & ((std::uint64_t{1} << columns) - 1);
        if (present == 0) continue;
        float* enthalpy = step.enthalpy_J_per_m3 + i;
        int k = 0;
        for (; k + lanes <= columns; k += lanes) {
            const F before = hn::LoadU(d, enthalpy + k);
            const F heat = hn::IfThenElseZero(mask_of(present, k), hn::Mul(hn::Load(d, density[row] + k), dt));
            const F next = hn::Add(before, heat);
            sum.add(k, hn::Sub(next, before));
            hn::StoreU(next, d, enthalpy + k);
        }
        for (; k < columns; ++k) {  // cells beyond belong to other threads
            if (((present >> k) & 1u) == 0) continue;
            const float next = enthalpy[k] + density[row][k] * step.dt_s;
            sum.add_one(k, next - enthalpy[k]);
            enthalpy[k] = next;
        }
    }
    return sum.total();
}

bool is_warm(const HeatStep& step, std::int64_t begin, std::int64_t end) {
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    for (std::int64_t word = begin; word < end; word += kWordCells) {
        const std::uint64_t present = word_at(step.present, word);
        for (std::int64_t k = 0; present != 0 && k < kWordCells; k += lanes) {
            if (lanes_of(present, k) == 0) continue;
            // Not "unequal", which some instruction sets deny for what is not a number.
            const Mask cold = hn::Eq(hn::Load(d, step.temperature_K + word + k), number(step.body_K));
            if (!hn::AllFalse(d, hn::AndNot(cold, mask_of(present, k)))) return true;
        }
    }
    return false;
}

/// Offset to one of the six neighbours.
HWY_INLINE std::int64_t neighbour(const HeatStep& step, int n) {
    return n % 2 == 0 ? -step.offset[n / 2] : step.offset[n / 2];
}

/// Presence around 64 cells. Neighbours are those along -x, +x, -y, +y, -z, +z.
struct Surroundings {
    std::uint64_t present;     ///< the cells themselves
    std::uint64_t surrounded;  ///< of those, where all neighbours are present
    std::uint64_t by_held;     ///< of those, where a neighbour is held
    std::uint64_t beside[6];   ///< present neighbours
    std::uint64_t held[6];     ///< held neighbours, where by_held
};
HWY_INLINE Surroundings look_around(const HeatStep& step, std::int64_t word) {
    Surroundings around;
    around.present = around.surrounded = word_at(step.present, word);
    around.by_held = 0;
    if (around.present == 0) return around;
    for (int n = 0; n < 6; ++n) {
        around.beside[n] = word_at(step.present, word + neighbour(step, n));
        around.surrounded &= around.beside[n];
    }
    for (int n = 0; around.surrounded != around.present && n < 6; ++n) {
        around.held[n] = word_at(step.held, word + neighbour(step, n)) & ~around.beside[n];
        around.by_held |= around.held[n] & around.present;
    }
    return around;
}

/// sum_alive k_ij (T_j - T_i) of cells in one tissue whose neighbours are all there.
HWY_INLINE F conduction_inside(const HeatStep& step, std::int64_t i, F own_K, F conductivity) {
    const D d;
    F sum = hn::Zero(d);
    for (const std::int64_t stride : step.offset) {
        sum = hn::Add(sum, hn::Sub(hn::LoadU(d, step.temperature_K + i - stride), own_K));
        sum = hn::Add(sum, hn::Sub(hn::LoadU(d, step.temperature_K + i + stride), own_K));
    }
    return hn::Mul(conductivity, sum);
}

/// Conductivity of the faces between lanes of two conductivities: their harmonic mean.
HWY_INLINE F face_conductivity(F a, F b) {
    const F total = hn::Max(hn::Add(a, b), number(1e-30f));  // both zero only where either is absent
    const F mean = hn::Div(hn::Mul(number(2.0f), hn::Mul(a, b)), total);
    return hn::IfThenElse(hn::Eq(a, b), a, mean);
}

/// The same anywhere, with the numbers of faces towards gas and towards held tissue. `k` counts cells from `word` on.
struct Faces {
    F conduction, gas, held;
};
template <bool mixed>
HWY_INLINE Faces conduction_anywhere(const HeatStep& step, const Surroundings& around, std::int64_t word,
                                     std::int64_t k, F own_K, F conductivity) {
    const D d;
    const F one = number(1.0f);
    Faces faces{hn::Zero(d), number(6.0f), hn::Zero(d)};
    for (int n = 0; n < 6; ++n) {
        const std::int64_t j = word + k + neighbour(step, n);
        const Mask present = mask_of(around.beside[n], k);
        F flow = hn::Sub(hn::LoadU(d, step.temperature_K + j), own_K);
        if constexpr (mixed) {
            const F other = hn::GatherIndex(d, step.properties->conductivity_W_per_mK.data(),
                                            PropertyLookup::indices(step.material + j));
            flow = hn::Mul(face_conductivity(conductivity, other), flow);
        }
        faces.conduction = hn::Add(faces.conduction, hn::IfThenElseZero(present, flow));
        faces.gas = hn::Sub(faces.gas, hn::IfThenElseZero(present, one));
    }
    if (HWY_UNLIKELY(lanes_of(around.by_held, k) != 0)) {
        for (int n = 0; n < 6; ++n)
            faces.held = hn::Add(faces.held, hn::IfThenElseZero(mask_of(around.held[n], k), one));
        faces.gas = hn::Sub(faces.gas, faces.held);
    }
    if constexpr (!mixed) faces.conduction = hn::Mul(conductivity, faces.conduction);
    return faces;
}

void conduct_cells(const HeatStep& shared, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    const HeatStep step = shared;  // a copy of its own stays in registers
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    const F body = number(step.body_K), zero = hn::Zero(d);
    const F surface_factor = number(step.surface_factor), conduction_factor = number(step.conduction_factor);
    CellSum perfusion, surface;
    for (std::int64_t word = begin; word < end; word += kWordCells) {
        const Surroundings around = look_around(step, word);
        for (std::int64_t k = 0; around.present != 0 && k < kWordCells; k += lanes) {
            const std::uint64_t present = lanes_of(around.present, k);
            if (present == 0) continue;
            const std::int64_t i = word + k;
            const std::uint8_t group = step.group_material[i / kGroupCells];
            const PropertyLookup of(step.material, i, group);
            const F own_K = hn::Load(d, step.temperature_K + i);
            const F conductivity = of(step.properties->conductivity_W_per_mK);
            const F rise = hn::Sub(own_K, body);
            const F before = hn::Load(d, step.enthalpy_J_per_m3 + i);
            const F perfused_per_K = hn::Mul(of(step.properties->perfusion_W_per_m3K), number(step.dt_s));
            const Mask mask = mask_of(around.present, k);
            F next;
            if (lanes_of(around.surrounded, k) == present && group != kMixedGroup) {
                const F flow = conduction_inside(step, i, own_K, conductivity);
                const F conducted = hn::Add(before, hn::Mul(conduction_factor, flow));
                next = hn::Sub(conducted, hn::Mul(perfused_per_K, rise));
                perfusion.add(k, hn::IfThenElseZero(mask, hn::Sub(conducted, next)));
            } else {
                const Faces faces = group == kMixedGroup
                                        ? conduction_anywhere<true>(step, around, word, k, own_K, conductivity)
                                        : conduction_anywhere<false>(step, around, word, k, own_K, conductivity);
                const F to_held = hn::Mul(surface_factor, of(step.properties->held_transfer_W_per_m2K));
                const F to_gas = hn::Mul(surface_factor, of(step.properties->gas_transfer_W_per_m2K));
                const F conducted = hn::Add(before, hn::Mul(conduction_factor, faces.conduction));
                const F perfused = hn::Sub(conducted, hn::Mul(perfused_per_K, rise));
                const F held = hn::Sub(perfused, hn::Mul(hn::Mul(to_held, faces.held), rise));
                F gas = hn::Mul(hn::Mul(to_gas, faces.gas), hn::Sub(own_K, number(step.gas_K)));
                gas = hn::Min(hn::IfThenElseZero(hn::Gt(rise, zero), gas), hn::Max(held, zero));
                next = hn::Sub(held, gas);
                perfusion.add(k, hn::IfThenElseZero(mask, hn::Sub(conducted, perfused)));
                const F lost = hn::Add(hn::Sub(perfused, held), hn::Sub(held, next));
                surface.add(k, hn::IfThenElseZero(mask, lost));
            }
            // Masked stores are slow; absent cells get back what they had.
            hn::Store(hn::IfThenElse(mask, next, before), d, step.enthalpy_J_per_m3 + i);
        }
    }
    sums.perfusion += perfusion.total();
    sums.surface += surface.total();
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

/// Arrhenius' integral over the step.
HWY_INLINE F add_damage(const HeatStep& step, const PropertyLookup& of, F now_K, F damage) {
    const F relative = hn::Div(hn::Sub(now_K, number(kDamageReference_K)), now_K);
    const F exponent =
        hn::Add(of(step.properties->damage_log_rate), hn::Mul(of(step.properties->damage_slope), relative));
    const F rate = exponential(hn::Max(hn::Min(exponent, number(40.0f)), number(-87.0f)));
    return hn::Min(hn::Add(damage, hn::Mul(rate, number(step.dt_s))), number(kDamageLimit));
}

/// Sums over a block, lane by lane.
struct SettleSums {
    CellSum gas, latent;
    Mask spent;
};

/// Sets temperature and peak. Temperatures of absent cells are nobody's business: no mask.
HWY_INLINE void set_temperature(const HeatStep& step, std::int64_t i, Mask mask, F now_K) {
    const D d;
    hn::Store(now_K, d, step.temperature_K + i);
    const F peak = hn::Load(d, step.peak_temperature_K + i);
    const Mask hotter = hn::And(hn::Gt(now_K, peak), mask);
    if (!hn::AllFalse(d, hotter)) hn::Store(hn::IfThenElse(hotter, now_K, peak), d, step.peak_temperature_K + i);
}

/// settle_cells for the lanes of `mask` from cell i on.
HWY_INLINE void settle_vector(const HeatStep& step, std::int64_t i, Mask mask, SettleSums& lanes, BlockSums& sums) {
    const D d;
    const Properties& p = *step.properties;
    const F zero = hn::Zero(d), latent_heat = number(static_cast<float>(kLatentHeatOfWater_J_per_kg));
    const PropertyLookup of(step.material, i, step.group_material[i / kGroupCells]);
    const F dry_capacity = of(p.dry_capacity_J_per_m3K), water_capacity = of(p.water_capacity_J_per_kgK);
    F enthalpy = hn::Load(d, step.enthalpy_J_per_m3 + i);
    F water = hn::Load(d, step.water_kg_per_m3 + i);
    F capacity = hn::Add(dry_capacity, hn::Mul(water, water_capacity));
    const F rise = hn::Mul(enthalpy, hn::Div(number(1.0f), capacity));
    if (HWY_LIKELY(hn::AllTrue(d, hn::Le(rise, number(p.quick_rise_K))))) {
        set_temperature(step, i, mask, hn::Add(number(step.body_K), rise));
        return;
    }
    const Mask bad = hn::AndNot(hn::Lt(hn::Abs(enthalpy), number(1e30f)), mask);
    if (HWY_UNLIKELY(!hn::AllFalse(d, bad)) && sums.bad_hexel < 0) sums.bad_hexel = i + hn::FindFirstTrue(d, bad);

    F limit = of(p.dry_limit_K);
    Mask dry = mask;
    if (step.threshold) {
        const F taken = hn::Max(hn::Sub(enthalpy, of(p.plateau_J_per_m3)), zero);
        const F left = hn::Max(hn::Sub(of(p.water_kg_per_m3), hn::Div(taken, latent_heat)), zero);
        hn::Store(hn::IfThenElse(mask, left, water), d, step.water_kg_per_m3 + i);
    } else {
        const F excess = hn::Sub(enthalpy, hn::Mul(capacity, number(p.wet_limit_K)));
        const Mask boils = hn::And(hn::And(hn::Gt(water, zero), hn::Gt(excess, zero)), mask);
        if (HWY_UNLIKELY(!hn::AllFalse(d, boils))) {
            F after = enthalpy, left = water;
            const F steam = hn::IfThenElseZero(boils, boil(excess, of(p.boil_off_J_per_kg), left, after));
            lanes.gas.add(i, hn::IfThenElseZero(boils, hn::Sub(enthalpy, after)));
            lanes.latent.add(i, hn::Mul(steam, latent_heat));
            enthalpy = hn::IfThenElse(boils, after, enthalpy);
            water = hn::IfThenElse(boils, left, water);
            capacity = hn::Add(dry_capacity, hn::Mul(water, water_capacity));
            hn::Store(enthalpy, d, step.enthalpy_J_per_m3 + i);
            hn::Store(water, d, step.water_kg_per_m3 + i);
            hn::Store(hn::Add(hn::Load(d, step.steam_kg_per_m3 + i), steam), d, step.steam_kg_per_m3 + i);
            sums.boiled = true;
        }
        const Mask wet = hn::Gt(water, zero);
        limit = hn::IfThenElse(wet, number(p.wet_limit_K), limit);
        dry = hn::AndNot(wet, mask);
    }
    const F now_K = hn::Add(number(step.body_K), hn::Min(hn::Mul(enthalpy, hn::Div(number(1.0f), capacity)), limit));
    set_temperature(step, i, mask, now_K);
    if (HWY_UNLIKELY(!hn::AllFalse(d, dry)))
        lanes.spent = hn::Or(lanes.spent, hn::And(dry, hn::Ge(enthalpy, of(p.spent_J_per_m3))));
    const Mask hurts = hn::And(hn::Gt(now_K, number(kDamageThreshold_K)), mask);
    if (HWY_UNLIKELY(!hn::AllFalse(d, hurts))) {
        const F damage = hn::Load(d, step.damage + i);
        if (!hn::AllFalse(d, hn::And(hurts, hn::Lt(damage, number(kDamageLimit)))))
            hn::Store(hn::IfThenElse(hurts, add_damage(step, of, now_K, damage), damage), d, step.damage + i);
    }
}

void settle_cells(const HeatStep& shared, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    const HeatStep step = shared;  // a copy of its own stays in registers
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    SettleSums found{{}, {}, hn::FirstN(d, 0)};
    for (std::int64_t word = begin; word < end; word += kWordCells) {
        const std::uint64_t present = word_at(step.present, word);
        for (std::int64_t k = 0; present != 0 && k < kWordCells; k += lanes)
            if (lanes_of(present, k) != 0) settle_vector(step, word + k, mask_of(present, k), found, sums);
    }
    if (sums.boiled) {
        sums.gas += found.gas.total();
        sums.latent += found.latent.total();
    }
    sums.spent |= !hn::AllFalse(d, found.spent);
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::thermal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::thermal {

HWY_EXPORT(deposit_tile);
HWY_EXPORT(is_warm);
HWY_EXPORT(conduct_cells);
HWY_EXPORT(settle_cells);

double deposit_tile(const HeatStep& step, const HeatTile& density_W_per_m3, std::int64_t first, std::int64_t stride,
                    int rows, int columns) {
    return HWY_DYNAMIC_DISPATCH(deposit_tile)(step, density_W_per_m3, first, stride, rows, columns);
}
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
