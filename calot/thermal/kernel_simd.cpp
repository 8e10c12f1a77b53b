// The heat kernels, a vector of neighbouring cells at a time. Formulas and their sources: kernel_scalar.cpp.
//
//     T[i - slow], T[i - middle], T[i - 1]  ->  i .. i + N - 1  <-  T[i + 1], T[i + middle], T[i + slow]
//
// One pass does it all: it reads temperatures of the start of the step and writes those of its end into another array,
// so that cells need no order. Nearly all vectors lie inside one tissue (group_material): its properties are then one
// number for all lanes. Where tissues meet, properties are looked up lane by lane. Neighbours' presence is a few bits
// at a constant offset. Multiplication and addition stay separate so that instruction sets with and without fused
// multiply-add give the same bytes.

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

/// Cells are counted in groups of 16, which take one vector or more.
constexpr int kLanes = static_cast<int>(hn::MaxLanes(D())), kParts = kGroupCells / kLanes;

/// The bits of the 64 cells from `cell` on.
HWY_INLINE std::uint64_t word_at(const std::uint8_t* bits, std::int64_t cell) {
    std::uint64_t words[2];
    std::memcpy(words, bits + (cell >> 6) * 8, sizeof(words));
    const auto shift = static_cast<unsigned>(cell & 63);
    return (words[0] >> shift) | ((words[1] << 1) << (63 - shift));
}

/// Lanes of a mask from bits of a word, from bit `first` (a multiple of the lanes) on. The word lies in memory, with
/// something behind it.
HWY_INLINE Mask mask_of(const std::uint64_t& word, unsigned first) {
    if constexpr (hn::MaxLanes(D()) >= 8)
        return hn::LoadMaskBits(D(), reinterpret_cast<const std::uint8_t*>(&word) + first / 8);
    const std::uint64_t shifted = word >> first;
    std::uint8_t lanes[8];
    std::memcpy(lanes, &shifted, sizeof(shifted));
    return hn::LoadMaskBits(D(), lanes);
}
/// Those bits as an integer.
HWY_INLINE std::uint64_t lanes_of(std::uint64_t word, unsigned first) {
    return (word >> first) & ((std::uint64_t{1} << hn::Lanes(D())) - 1);
}

HWY_INLINE F number(float value) {
    return hn::Set(D(), value);
}

/// A property of the material of every lane.
template <bool mixed>
class PropertyLookup {
  public:
    /// For the cells from i on; all of the group's material, unless `mixed`.
    HWY_INLINE PropertyLookup(const HeatStep& step, std::int64_t i) : group_(step.group_material[i / kGroupCells]) {
        if constexpr (mixed) index_ = indices(step.material + i);
    }
    HWY_INLINE F operator()(const Properties::PerMaterial<float>& property) const {
        if constexpr (mixed) return hn::GatherIndex(D(), property.data(), index_);
        return number(property[group_]);
    }
    static HWY_INLINE hn::Vec<DI> indices(const tissue::MaterialIndex* material) {
        const hn::Rebind<std::uint8_t, D> bytes;
        return hn::PromoteTo(DI(), hn::LoadU(bytes, material));
    }

  private:
    std::uint8_t group_;
    hn::Vec<DI> index_ = hn::Zero(DI());
};

/// A sum over cells in 16 partial sums, one for each place in a group, so that it does not depend on how wide vectors
/// are.
class CellSum {
  public:
    HWY_INLINE CellSum() {
        for (F& partial : partial_) partial = hn::Zero(D());
    }
    /// `part` of a group.
    HWY_INLINE void add(int part, F values) { partial_[part] = hn::Add(partial_[part], values); }
    /// Pairwise, which is more exact than one after the other.
    HWY_INLINE double total() const {
        HWY_ALIGN float sums[kGroupCells];
        for (int part = 0; part < kParts; ++part) hn::Store(partial_[part], D(), sums + part * kLanes);
        for (int half = kGroupCells / 2; half > 1; half /= 2)
            for (int k = 0; k < half; ++k) sums[k] += sums[k + half];
        return static_cast<double>(sums[0] + sums[1]);
    }

  private:
    F partial_[kParts];
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

void deposit_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    const D d;
    const F dt = number(step.joule.scaled_dt_s);
    CellSum sum;
    float rest = 0.0f;
    for_joule_rows(step.joule, begin, end, [&](std::int64_t first, const float* density, std::int64_t count) HWY_ATTR {
        std::int64_t k = 0;
        for (; k + kGroupCells <= count; k += kGroupCells) {
            const std::uint64_t living[2] = {word_at(step.living, first + k), 0};
            for (int part = 0; part < kParts; ++part) {
                const std::int64_t at = k + part * kLanes;
                float* enthalpy = step.enthalpy_J_per_m3 + first + at;
                const F before = hn::LoadU(d, enthalpy), heat = hn::Mul(hn::LoadU(d, density + at), dt);
                const F next =
                    hn::Add(before, hn::IfThenElseZero(mask_of(living[0], static_cast<unsigned>(part * kLanes)), heat));
                sum.add(part, hn::Sub(next, before));
                hn::StoreU(next, d, enthalpy);
            }
        }
        if (k == count) return;
        const std::uint64_t living = word_at(step.living, first + k);
        for (std::int64_t j = 0; k + j < count; ++j) {  // cells beyond belong to other threads
            if (((living >> j) & 1u) == 0) continue;
            float& enthalpy = step.enthalpy_J_per_m3[first + k + j];
            const float next = enthalpy + density[k + j] * step.joule.scaled_dt_s;
            rest += next - enthalpy;
            enthalpy = next;
        }
    });
    sums.delivered += sum.total() + static_cast<double>(rest);
}

/// Offset to one of the six neighbours.
HWY_INLINE std::int64_t neighbour(const HeatStep& step, int n) {
    return n % 2 == 0 ? -step.offset[n / 2] : step.offset[n / 2];
}

/// Presence around 64 cells. Neighbours are those along -x, +x, -y, +y, -z, +z.
struct Surroundings {
    std::uint64_t present;    ///< the cells themselves
    std::uint64_t living;     ///< of those, the ones still there
    std::uint64_t beside[6];  ///< present neighbours
    std::uint64_t gas[3];     ///< number of faces towards gas: its ones, twos and fours
    std::uint64_t held[3];    ///< and towards held tissue
    std::uint64_t by_held;    ///< cells with such faces
    std::uint64_t exposed;    ///< and cells with faces towards either
};

/// Bit by bit, the sum of six words of ones: ones, twos and fours.
HWY_INLINE void count_bits(const std::uint64_t (&words)[6], std::uint64_t (&count)[3]) {
    const auto majority = [](std::uint64_t a, std::uint64_t b, std::uint64_t c) { return (a & b) | (c & (a ^ b)); };
    const std::uint64_t ones_1 = words[0] ^ words[1] ^ words[2], twos_1 = majority(words[0], words[1], words[2]);
    const std::uint64_t ones_2 = words[3] ^ words[4] ^ words[5], twos_2 = majority(words[3], words[4], words[5]);
    const std::uint64_t carry = ones_1 & ones_2;
    count[0] = ones_1 ^ ones_2;
    count[1] = twos_1 ^ twos_2 ^ carry;
    count[2] = majority(twos_1, twos_2, carry);
}

HWY_INLINE void look_around(const HeatStep& step, std::int64_t word, Surroundings& around) {
    std::uint64_t gas[6], held[6];
    around.by_held = 0;
    around.present = word_at(step.present, word);
    around.living = word_at(step.living, word);
    for (int n = 0; n < 6; ++n) {
        around.beside[n] = word_at(step.present, word + neighbour(step, n));
        held[n] = word_at(step.held, word + neighbour(step, n)) & ~around.beside[n];
        gas[n] = ~(around.beside[n] | held[n]);
        around.by_held |= held[n] & around.present;
    }
    count_bits(gas, around.gas);
    around.exposed = around.present & (around.gas[0] | around.gas[1] | around.gas[2] | around.by_held);
    count_bits(held, around.held);
}

/// Numbers of faces of the lanes from `k` on.
HWY_INLINE F faces_of(const std::uint64_t (&count)[3], unsigned k) {
    const F ones = hn::IfThenElseZero(mask_of(count[0], k), number(1.0f));
    const F twos = hn::IfThenElseZero(mask_of(count[1], k), number(2.0f));
    return hn::Add(hn::Add(ones, twos), hn::IfThenElseZero(mask_of(count[2], k), number(4.0f)));
}

/// Conductivity of the faces between lanes of two conductivities: their harmonic mean.
HWY_INLINE F face_conductivity(F a, F b) {
    const F total = hn::Max(hn::Add(a, b), number(1e-30f));  // both zero only where either is absent
    const F mean = hn::Div(hn::Mul(number(2.0f), hn::Mul(a, b)), total);
    return hn::IfThenElse(hn::Eq(a, b), a, mean);
}

/// Temperatures of the 64 cells from `word` on and of their neighbours.
struct Temperatures {
    const float* own;
    const float* beside[6];
    HWY_INLINE Temperatures(const HeatStep& step, std::int64_t word) : own(step.temperature_K + word) {
        for (int n = 0; n < 6; ++n) beside[n] = own + neighbour(step, n);
    }
};

/// sum_alive k_ij (T_j - T_i) of the lanes from cell k of the word on. `mixed`: not all lanes and neighbours are of one
/// tissue.
template <bool mixed>
HWY_INLINE F conduction(const HeatStep& step, const Surroundings& around, const Temperatures& temperature,
                        std::int64_t word, unsigned k, F own_K, F conductivity) {
    const D d;
    F sum = hn::Zero(d);
    for (int n = 0; n < 6; ++n) {
        F flow = hn::Sub(hn::LoadU(d, temperature.beside[n] + k), own_K);
        if constexpr (mixed) {
            const tissue::MaterialIndex* material = step.material + word + neighbour(step, n) + k;
            const F other = hn::GatherIndex(d, step.properties->conductivity_W_per_mK.data(),
                                            PropertyLookup<true>::indices(material));
            flow = hn::Mul(face_conductivity(conductivity, other), flow);
        }
        sum = hn::Add(sum, hn::IfThenElseZero(mask_of(around.beside[n], k), flow));
    }
    return mixed ? sum : hn::Mul(conductivity, sum);
}

/// T from its rise above body temperature.
HWY_INLINE F temperature_of(const HeatStep& step, F rise) {
    const Mask rests = hn::Lt(hn::Abs(rise), number(tissue::kRest_K));
    return hn::Add(number(step.body_K), hn::IfThenZeroElse(rests, rise));
}

/// Share of blood flow that damage leaves: see kernel_scalar.cpp.
HWY_INLINE F flow_left(F damage) {
    const F healthy = hn::Sub(number(1.0f), hn::Min(damage, number(1.0f)));
    return hn::Mul(hn::Mul(healthy, healthy), hn::Sub(number(3.0f), hn::Mul(number(2.0f), healthy)));
}

/// Sums over a block of what every hexel does. They stay in registers.
struct ConductSums {
    CellSum conducted, perfusion, surface;
    HWY_INLINE ConductSums() {}
};

/// Conduction and surroundings of the lanes from cell k of the word on; `before` is their enthalpy. Returns the new
/// one.
template <bool pristine, bool mixed>
HWY_INLINE F conduct(const HeatStep& step, const PropertyLookup<mixed>& of, const Surroundings& around,
                     const Temperatures& temperature, std::int64_t word, unsigned k, F before, ConductSums& sums) {
    const D d;
    const F zero = hn::Zero(d);
    const int part = static_cast<int>(k % kGroupCells) / kLanes;
    const F own_K = hn::Load(d, temperature.own + k), rise = hn::Sub(own_K, number(step.body_K));
    const F conductivity = of(step.properties->conductivity_W_per_mK);
    const F flow = conduction<mixed>(step, around, temperature, word, k, own_K, conductivity);
    F blood = hn::Mul(of(step.properties->blood_W_per_m3K), number(step.dt_s));
    if constexpr (!pristine) blood = hn::Mul(blood, flow_left(hn::Load(d, step.damage + word + k)));
    const F conducted = hn::Add(before, hn::Mul(number(step.conduction_factor), flow));
    const F perfused = hn::Sub(conducted, hn::Mul(blood, rise));
    const Mask present = mask_of(around.present, k);
    sums.conducted.add(part, hn::IfThenElseZero(mask_of(around.living, k), hn::Sub(conducted, before)));
    sums.perfusion.add(part, hn::IfThenElseZero(present, hn::Sub(conducted, perfused)));
    // Masked stores are slow; absent cells get back what they had.
    if (lanes_of(around.exposed, k) == 0) return hn::IfThenElse(present, perfused, before);
    F held = perfused;
    if (HWY_UNLIKELY(around.by_held != 0)) {
        const F to_held = hn::Mul(number(step.surface_factor), of(step.properties->held_transfer_W_per_m2K));
        held = hn::Sub(perfused, hn::Mul(hn::Mul(to_held, faces_of(around.held, k)), rise));
    }
    const F to_gas = hn::Mul(number(step.surface_factor), of(step.properties->gas_transfer_W_per_m2K));
    F gas = hn::Mul(hn::Mul(to_gas, faces_of(around.gas, k)), hn::Sub(own_K, number(step.gas_K)));
    gas = hn::Min(hn::IfThenElseZero(hn::Gt(rise, zero), gas), hn::Max(held, zero));
    const F next = hn::Sub(held, gas);
    const F lost = hn::Add(hn::Sub(perfused, held), hn::Sub(held, next));
    sums.surface.add(part, hn::IfThenElseZero(present, lost));
    return hn::IfThenElse(present, next, before);
}

/// One vector of cells that are hot, dry or may boil: the lanes `living` from cell i on, `part` of their group.
struct CellVector {
    std::int64_t i;
    int part;
    Mask living;
};

/// Sums over a block of what hot hexels do.
struct SettleSums {
    CellSum gas, latent;
    Mask warm, hot, spent;
    HWY_INLINE SettleSums() : warm(none()), hot(none()), spent(none()) {}
    static HWY_INLINE Mask none() { return hn::FirstN(D(), 0); }
};

/// Boils the lanes above the boiling point.
template <bool mixed>
HWY_INLINE void boil(const HeatStep& step, const PropertyLookup<mixed>& of, const CellVector& at, F capacity, F& water,
                     F& enthalpy, SettleSums& sums, BlockSums& block) {
    const D d;
    const F zero = hn::Zero(d), latent_heat = number(static_cast<float>(kLatentHeatOfWater_J_per_kg));
    const F excess = hn::Sub(enthalpy, hn::Mul(capacity, number(step.properties->wet_limit_K)));
    const Mask boils = hn::And(hn::And(hn::Gt(water, zero), hn::Gt(excess, zero)), at.living);
    if (HWY_LIKELY(hn::AllFalse(d, boils))) return;
    const F wanted = hn::Div(hn::Max(excess, zero), latent_heat);
    const F left = hn::Max(hn::Sub(water, wanted), zero);
    const F steam = hn::IfThenElseZero(boils, hn::Sub(water, left));
    const F after = hn::Sub(enthalpy, hn::Mul(steam, of(step.properties->boil_off_J_per_kg)));
    sums.gas.add(at.part, hn::IfThenElseZero(boils, hn::Sub(enthalpy, after)));
    sums.latent.add(at.part, hn::Mul(steam, latent_heat));
    enthalpy = hn::IfThenElse(boils, after, enthalpy);
    water = hn::IfThenElse(boils, left, water);
    hn::Store(enthalpy, d, step.enthalpy_J_per_m3 + at.i);
    hn::Store(water, d, step.water_kg_per_m3 + at.i);
    hn::Store(hn::Add(hn::Load(d, step.steam_kg_per_m3 + at.i), steam), d, step.steam_kg_per_m3 + at.i);
    block.boiled = true;
}

/// Peak and Arrhenius' integral over the step of the lanes that are hot enough.
template <bool mixed>
HWY_INLINE void hurt(const HeatStep& step, const PropertyLookup<mixed>& of, std::int64_t i, Mask hurts, F now_K) {
    const D d;
    const F peak = hn::Load(d, step.peak_temperature_K + i);
    hn::Store(hn::IfThenElse(hurts, hn::Max(peak, now_K), peak), d, step.peak_temperature_K + i);
    const F damage = hn::Load(d, step.damage + i);
    if (hn::AllFalse(d, hn::And(hurts, hn::Lt(damage, number(kDamageLimit))))) return;
    const F relative = hn::Div(hn::Sub(now_K, number(kDamageReference_K)), now_K);
    const F exponent =
        hn::Add(of(step.properties->damage_log_rate), hn::Mul(of(step.properties->damage_slope), relative));
    const F rate = exponential(hn::Max(hn::Min(exponent, number(40.0f)), number(-87.0f)));
    const F more = hn::Min(hn::Add(damage, hn::Mul(rate, number(step.dt_s))), number(kDamageLimit));
    hn::Store(hn::IfThenElse(hurts, more, damage), d, step.damage + i);
}

/// Lanes that are not at body temperature. Not "unequal", which some instruction sets deny for what is not a number.
HWY_INLINE Mask warm_lanes(const HeatStep& step, const CellVector& at, F now_K) {
    return hn::AndNot(hn::Eq(now_K, number(step.body_K)), at.living);
}

/// Phases, temperature, peak and damage of what is hot, dry or may boil.
template <bool mixed>
HWY_INLINE void settle(const HeatStep& step, const PropertyLookup<mixed>& of, const CellVector& at, SettleSums& sums,
                       BlockSums& block) {
    const D d;
    const Properties& p = *step.properties;
    const F zero = hn::Zero(d), dry_capacity = of(p.dry_capacity_J_per_m3K);
    const F water_capacity = of(p.water_capacity_J_per_kgK);
    F enthalpy = hn::Load(d, step.enthalpy_J_per_m3 + at.i);
    const Mask bad = hn::AndNot(hn::Lt(hn::Abs(enthalpy), number(1e30f)), at.living);
    if (HWY_UNLIKELY(!hn::AllFalse(d, bad)) && block.bad_hexel < 0) block.bad_hexel = at.i + hn::FindFirstTrue(d, bad);

    F water = hn::Load(d, step.water_kg_per_m3 + at.i), limit = of(p.dry_limit_K);
    Mask dry = at.living;
    if (step.threshold) {
        const F taken = hn::Max(hn::Sub(enthalpy, of(p.plateau_J_per_m3)), zero);
        const F gone = hn::Div(taken, number(static_cast<float>(kLatentHeatOfWater_J_per_kg)));
        water = hn::IfThenElse(at.living, hn::Max(hn::Sub(of(p.water_kg_per_m3), gone), zero), water);
        hn::Store(water, d, step.water_kg_per_m3 + at.i);
    } else {
        boil(step, of, at, hn::Add(dry_capacity, hn::Mul(water, water_capacity)), water, enthalpy, sums, block);
        const Mask wet = hn::Gt(water, zero);
        limit = hn::IfThenElse(wet, number(p.wet_limit_K), limit);
        dry = hn::AndNot(wet, at.living);
    }
    const F capacity = hn::Add(dry_capacity, hn::Mul(water, water_capacity));
    const F rise = hn::Min(hn::Mul(enthalpy, hn::Div(number(1.0f), capacity)), limit);
    const F now_K = temperature_of(step, rise);
    hn::Store(now_K, d, step.next_temperature_K + at.i);
    sums.warm = hn::Or(sums.warm, warm_lanes(step, at, now_K));
    sums.spent = hn::Or(sums.spent, hn::And(dry, hn::Ge(enthalpy, of(p.spent_J_per_m3))));
    const Mask hurts = hn::And(hn::Gt(now_K, number(kDamageThreshold_K)), at.living);
    if (hn::AllFalse(d, hurts)) return;
    sums.hot = hn::Or(sums.hot, hurts);
    hurt(step, of, at.i, hurts, now_K);
}

/// Settles the vectors of a block whose first cells are listed.
HWY_NOINLINE void settle_vectors(const HeatStep& step, std::int64_t begin, const std::uint8_t* hot, int count,
                                 BlockSums& block) {
    const D d;
    SettleSums sums;
    for (int n = 0; n < count; ++n) {
        const std::int64_t i = begin + std::int64_t{hot[n]} * kLanes;
        const std::uint64_t living[2] = {word_at(step.living, i), 0};
        if (lanes_of(living[0], 0) == 0) continue;
        const CellVector at{i, static_cast<int>(i % kGroupCells) / kLanes, mask_of(living[0], 0)};
        if (step.group_material[i / kGroupCells] == kMixedGroup)
            settle(step, PropertyLookup<true>(step, i), at, sums, block);
        else
            settle(step, PropertyLookup<false>(step, i), at, sums, block);
    }
    if (block.boiled) {
        block.gas += sums.gas.total();
        block.latent += sums.latent.total();
    }
    block.warm |= !hn::AllFalse(d, sums.warm);
    block.hot |= !hn::AllFalse(d, sums.hot);
    block.spent |= !hn::AllFalse(d, sums.spent);
}

/// 1 / C of the lanes from cell i on.
template <bool pristine, bool mixed>
HWY_INLINE F per_capacity(const HeatStep& step, const PropertyLookup<mixed>& of, std::int64_t i) {
    if constexpr (pristine) return of(step.properties->per_capacity_alive_m3K_per_J);
    const F water = hn::Load(D(), step.water_kg_per_m3 + i);
    const F of_water = hn::Mul(water, of(step.properties->water_capacity_J_per_kgK));
    return hn::Div(number(1.0f), hn::Add(of(step.properties->dry_capacity_J_per_m3K), of_water));
}

/// Vectors of a block, told by their number.
struct VectorList {
    std::uint8_t entries[kBlockCells / kLanes + 1];
    int count = 0;
    /// Adds one where `yes`, without a branch.
    HWY_INLINE void add_if(bool yes, std::int64_t cell) {
        entries[count] = static_cast<std::uint8_t>(cell / kLanes);
        count += yes ? 1 : 0;
    }
};

/// The lanes from cell k of the word on. True when settle() has to see them.
template <bool pristine, bool mixed>
HWY_INLINE bool step_vector(const HeatStep& step, const Surroundings& around, const Temperatures& temperature,
                            std::int64_t word, unsigned k, ConductSums& sums, Mask& warm) {
    const D d;
    const std::int64_t i = word + k;
    const PropertyLookup<mixed> of(step, i);
    const F before = hn::Load(d, step.enthalpy_J_per_m3 + i);
    const F next = conduct<pristine, mixed>(step, of, around, temperature, word, k, before, sums);
    hn::Store(next, d, step.enthalpy_J_per_m3 + i);
    const F rise = hn::Mul(next, per_capacity<pristine>(step, of, i));
    const F now_K = temperature_of(step, rise);
    hn::Store(now_K, d, step.next_temperature_K + i);
    // Not "unequal", which some instruction sets deny for what is not a number.
    warm = hn::Or(warm, hn::AndNot(hn::Eq(now_K, number(step.body_K)), mask_of(around.living, k)));
    return !hn::AllTrue(d, hn::Le(rise, number(step.properties->quick_rise_K)));
}

/// Vectors where tissues meet.
template <bool pristine>
HWY_NOINLINE void step_mixed(const HeatStep& step, std::int64_t begin, const VectorList& mixed, VectorList& hot,
                             BlockSums& block) {
    ConductSums sums;
    Mask warm = hn::FirstN(D(), 0);
    for (int n = 0; n < mixed.count; ++n) {
        const std::int64_t cell = std::int64_t{mixed.entries[n]} * kLanes,
                           word = begin + cell / kWordCells * kWordCells;
        Surroundings around;
        look_around(step, word, around);
        const bool is_hot = step_vector<pristine, true>(step, around, Temperatures(step, word), word,
                                                        static_cast<unsigned>(cell % kWordCells), sums, warm);
        hot.add_if(is_hot, cell);
    }
    block.conducted += sums.conducted.total();
    block.perfusion += sums.perfusion.total();
    block.surface += sums.surface.total();
    block.warm |= !hn::AllFalse(D(), warm);
}

template <bool pristine>
HWY_INLINE void step_block(const HeatStep& shared, std::int64_t begin, std::int64_t end, BlockSums& block) {
    const HeatStep step = shared;  // a copy of its own stays in registers
    ConductSums sums;
    Mask warm = hn::FirstN(D(), 0);
    VectorList hot, mixed;
    for (std::int64_t word = begin; word < end; word += kWordCells) {
        if (word_at(step.present, word) == 0) continue;
        Surroundings around;
        look_around(step, word, around);
        const Temperatures temperature(step, word);
#pragma GCC unroll 4
        for (unsigned k = 0; k < kWordCells; k += kLanes) {
            if (lanes_of(around.present, k) == 0) continue;
            const std::int64_t cell = word - begin + k;
            if (HWY_UNLIKELY(step.group_material[(word + k) / kGroupCells] == kMixedGroup)) {
                mixed.add_if(true, cell);
                continue;
            }
            const bool is_hot = step_vector<pristine, false>(step, around, temperature, word, k, sums, warm);
            hot.add_if(is_hot, cell);
        }
    }
    block.conducted += sums.conducted.total();
    block.perfusion += sums.perfusion.total();
    block.surface += sums.surface.total();
    block.warm |= !hn::AllFalse(D(), warm);
    if (mixed.count > 0) step_mixed<pristine>(shared, begin, mixed, hot, block);
    if (hot.count > 0) settle_vectors(shared, begin, hot.entries, hot.count, block);
}

void step_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, bool pristine, BlockSums& sums) {
    pristine ? step_block<true>(step, begin, end, sums) : step_block<false>(step, begin, end, sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::thermal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::thermal {

HWY_EXPORT(deposit_cells);
HWY_EXPORT(step_cells);

void deposit_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums) {
    HWY_DYNAMIC_DISPATCH(deposit_cells)(step, begin, end, sums);
}
void step_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, bool pristine, BlockSums& sums) {
    HWY_DYNAMIC_DISPATCH(step_cells)(step, begin, end, pristine, sums);
}

}  // namespace calot::thermal
#endif
