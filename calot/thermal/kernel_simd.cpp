// The heat kernels, a vector of neighbouring cells at a time. Formulas and their sources: kernel_scalar.cpp.
//
//     T[i - slow], T[i - middle], T[i - 1]  ->  i .. i + N - 1  <-  T[i + 1], T[i + middle], T[i + slow]
//
// One pass does it all: it reads temperatures of the start of the step and writes those of its end into another array,
// so that cells need no order. The groups of a run of blocks are sorted by what there is to do (GroupKind), and each
// kind has a loop of its own without branches. Nearly all groups lie inside one tissue: its properties are then one
// number for all lanes. Where tissues meet, properties are looked up lane by lane. Neighbours' presence is a few bits
// of the group. What is hot is listed on the way and settled afterwards. Multiplication and addition stay separate so
// that instruction sets with and without fused multiply-add give the same bytes.

#include "calot/thermal/kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/thermal/kernel_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"
#include "calot/base/units.h"
#include <hwy/cache_control.h>

HWY_BEFORE_NAMESPACE();
namespace calot::thermal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

using D = simd::Floats;
using DI = hn::RebindToSigned<D>;
using F = hn::Vec<D>;
using Mask = hn::Mask<D>;

constexpr int kLanes = static_cast<int>(hn::MaxLanes(D())), kParts = kGroupCells / kLanes;

/// Lanes of a mask from the bits of a group, from cell `k` of it on. The bits lie in memory, with something behind them.
HWY_INLINE Mask mask_of(const std::uint16_t& bits, int k) {
    if constexpr (kLanes >= 8) return hn::LoadMaskBits(D(), reinterpret_cast<const std::uint8_t*>(&bits) + k / 8);
    return simd::mask_of(D(), bits, k);
}
/// The same from a bit array.
HWY_INLINE Mask mask_at(const std::uint8_t* bits, std::int64_t cell) {
    if constexpr (kLanes >= 8) return hn::LoadMaskBits(D(), bits + cell / 8);
    return simd::mask_at(D(), bits, cell);
}

HWY_INLINE F number(float value) {
    return hn::Set(D(), value);
}

/// A property of the material of every lane of a group.
template <bool mixed>
class PropertyLookup {
  public:
    HWY_INLINE PropertyLookup(const HeatStep&, const CellGroup& group, std::int64_t) : material_(group.material) {}
    HWY_INLINE F operator()(const Properties::PerMaterial<float>& property) const { return number(property[material_]); }

  private:
    tissue::MaterialIndex material_;
};
template <>
class PropertyLookup<true> {
  public:
    /// For the cells from i on.
    HWY_INLINE PropertyLookup(const HeatStep& step, const CellGroup&, std::int64_t i)
        : index_(hn::PromoteTo(DI(), hn::LoadU(hn::Rebind<std::uint8_t, D>(), step.material + i))),
          few_(step.properties->few) {}
    HWY_INLINE F operator()(const Properties::PerMaterial<float>& property) const {
        if constexpr (kLanes == 16)
            if (HWY_LIKELY(few_))
                return hn::TableLookupLanes(hn::Load(D(), property.data()), hn::IndicesFromVec(D(), index_));
        return hn::GatherIndex(D(), property.data(), index_);
    }

  private:
    hn::Vec<DI> index_;
    bool few_;
};

/// A sum over cells in 16 partial sums, one for each place in a group, so that it does not depend on how wide vectors
/// are: in floats over some groups, then in doubles.
class CellSum {
  public:
    HWY_INLINE CellSum() {
        for (F& partial : partial_) partial = hn::Zero(D());
    }
    /// `part` of a group.
    HWY_INLINE void add(int part, F values) { partial_[part] = hn::Add(partial_[part], values); }
    /// Adds what it has to `places`.
    HWY_INLINE void add_to(double* places) const {
        HWY_ALIGN float sums[kGroupCells];
        for (int part = 0; part < kParts; ++part) hn::Store(partial_[part], D(), sums + part * kLanes);
        const hn::CappedTag<double, 8> wide;
        const hn::Rebind<float, decltype(wide)> narrow;
        for (std::size_t k = 0; k < kGroupCells; k += hn::Lanes(wide))
            hn::Store(hn::Add(hn::Load(wide, places + k), hn::PromoteTo(wide, hn::Load(narrow, sums + k))), wide,
                      places + k);
    }

  private:
    F partial_[kParts];
};

/// The same in doubles.
struct Places {
    HWY_ALIGN double place[kGroupCells] = {};
    HWY_INLINE double total() const {
        double sum = 0.0;
        for (const double value : place) sum += value;
        return sum;
    }
};

/// What a run adds up.
struct RunSums {
    Places delivered, conducted, perfusion, surface, gas, latent;
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

/// Joule heat in the cells [begin, end).
HWY_NOINLINE void deposit(const HeatStep& step, std::int64_t begin, std::int64_t end, RunSums& sums) {
    const D d;
    const F dt = number(step.joule.scaled_dt_s);
    CellSum sum;
    for_joule_rows(step.joule, begin, end, [&](std::int64_t first, const float* density, std::int64_t count) HWY_ATTR {
        std::int64_t k = 0;
        for (; k + kGroupCells <= count; k += kGroupCells)
            for (int part = 0; part < kParts; ++part) {
                const std::int64_t at = k + part * kLanes;
                float* enthalpy = step.enthalpy_J_per_m3 + first + at;
                const F before = hn::LoadU(d, enthalpy), heat = hn::Mul(hn::LoadU(d, density + at), dt);
                const F next = hn::Add(before, hn::IfThenElseZero(simd::mask_at(d, step.living, first + at), heat));
                sum.add(part, hn::Sub(next, before));
                hn::StoreU(next, d, enthalpy);
            }
        for (; k < count; ++k) {  // cells beyond belong to other threads
            const std::int64_t i = first + k;
            if (((step.living[i >> 3] >> (i & 7)) & 1u) == 0) continue;
            const float before = step.enthalpy_J_per_m3[i], next = before + density[k] * step.joule.scaled_dt_s;
            sums.delivered.place[k % kGroupCells] += static_cast<double>(next - before);
            step.enthalpy_J_per_m3[i] = next;
        }
    });
    sum.add_to(sums.delivered.place);
}

/// Conductivity of the faces between lanes of two conductivities: their harmonic mean.
HWY_INLINE F face_conductivity(F a, F b) {
    const F total = hn::Max(hn::Add(a, b), number(1e-30f));  // both zero only where either is absent
    const F mean = hn::Div(hn::Mul(number(2.0f), hn::Mul(a, b)), total);
    return hn::IfThenElse(hn::Eq(a, b), a, mean);
}

/// Heat that the lanes of a group from cell k on, i of the lattice, get from their neighbours.
template <bool mixed>
HWY_INLINE F conduction(const HeatStep& step, const CellGroup& group, std::int64_t i, int k, F own_K, F conducted) {
    const D d;
    const float* temperature = step.temperature_K + i;
    F sum = hn::Zero(d);
    for (int n = 0; n < 6; ++n) {
        const std::int64_t offset = n % 2 == 0 ? -step.offset[n / 2] : step.offset[n / 2];
        F flow = hn::Sub(hn::LoadU(d, temperature + offset), own_K);
        if constexpr (mixed) {
            const PropertyLookup<true> of(step, group, i + offset);
            flow = hn::Mul(face_conductivity(conducted, of(step.properties->conducted_J_per_m3K)), flow);
        }
        sum = hn::Add(sum, hn::IfThenElseZero(mask_of(group.beside[n], k), flow));
    }
    return mixed ? sum : hn::Mul(conducted, sum);
}

/// Lanes that are at body temperature.
HWY_INLINE Mask at_rest(F rise) {
    return hn::Lt(hn::Abs(rise), number(tissue::kRest_K));
}

/// T from its rise above body temperature.
HWY_INLINE F temperature_of(const HeatStep& step, F rise) {
    return hn::Add(number(step.body_K), hn::IfThenZeroElse(at_rest(rise), rise));
}

/// Share of blood flow that damage leaves: see kernel_scalar.cpp.
HWY_INLINE F flow_left(F damage) {
    const F healthy = hn::Sub(number(1.0f), hn::Min(damage, number(1.0f)));
    return hn::Mul(hn::Mul(healthy, healthy), hn::Sub(number(3.0f), hn::Mul(number(2.0f), healthy)));
}

/// What every hexel does, over some groups. They stay in registers.
struct ConductSums {
    CellSum conducted, perfusion, surface;
    HWY_INLINE ConductSums() {}
    HWY_INLINE void add_to(RunSums& run) const {
        conducted.add_to(run.conducted.place);
        perfusion.add_to(run.perfusion.place);
        surface.add_to(run.surface.place);
    }
};

/// Through faces to held tissue and to gas, from `before` on; returns what is left.
template <bool mixed>
HWY_INLINE F exchange(const HeatStep& step, const PropertyLookup<mixed>& of, std::int64_t i, F own_K, F rise,
                      F before) {
    const D d;
    const F zero = hn::Zero(d);
    const auto bytes = [&](const std::uint8_t* from)
                           HWY_ATTR { return hn::PromoteTo(DI(), hn::LoadU(hn::Rebind<std::uint8_t, D>(), from + i)); };
    const auto faces = bytes(step.faces);
    const F share = hn::Mul(hn::ConvertTo(d, bytes(step.share)), number(1.0f / kWholeFace));
    const F held_faces = hn::Mul(share, hn::ConvertTo(d, hn::ShiftRight<kHeldShift>(faces)));
    const F gas_faces = hn::Mul(share, hn::ConvertTo(d, hn::And(faces, hn::Set(DI(), kFaceMask))));
    const F to_held = hn::Mul(of(step.properties->to_held_J_per_m3K), held_faces);
    const F held = hn::Sub(before, hn::Mul(to_held, rise));
    F gas = hn::Mul(hn::Mul(of(step.properties->to_gas_J_per_m3K), gas_faces), hn::Sub(own_K, number(step.gas_K)));
    gas = hn::Min(hn::IfThenElseZero(hn::Gt(rise, zero), gas), hn::Max(held, zero));
    return hn::Sub(held, gas);
}

/// Notes whether a group of a block is warm; once is enough.
HWY_INLINE void mark_warm(BlockMarks& marks, unsigned group, bool warm) {
    marks.warm = static_cast<std::uint16_t>(marks.warm | static_cast<unsigned>(warm) << group);
}

/// One vector of cells that are hot, dry or may boil: the lanes `living` from cell i on, `part` of their group.
struct CellVector {
    std::int64_t i;
    int part;
    Mask living;
};

/// Boils the lanes above the boiling point; false when there are none.
template <bool mixed>
HWY_INLINE bool boil(const HeatStep& step, const PropertyLookup<mixed>& of, const CellVector& at, F capacity, F& water,
                     F& enthalpy, RunSums& sums, BlockMarks& marks) {
    const D d;
    const F zero = hn::Zero(d), latent_heat = number(static_cast<float>(kLatentHeatOfWater_J_per_kg));
    const F excess = hn::Sub(enthalpy, hn::Mul(capacity, number(step.properties->wet_limit_K)));
    const Mask boils = hn::And(hn::And(hn::Gt(water, zero), hn::Gt(excess, zero)), at.living);
    if (HWY_LIKELY(hn::AllFalse(d, boils))) return false;
    const F wanted = hn::Div(hn::Max(excess, zero), latent_heat);
    const F left = hn::Max(hn::Sub(water, wanted), zero);
    const F steam = hn::IfThenElseZero(boils, hn::Sub(water, left));
    const F after = hn::Sub(enthalpy, hn::Mul(steam, of(step.properties->boil_off_J_per_kg)));
    CellSum gas, latent;
    gas.add(at.part, hn::IfThenElseZero(boils, hn::Sub(enthalpy, after)));
    latent.add(at.part, hn::Mul(steam, latent_heat));
    gas.add_to(sums.gas.place);
    latent.add_to(sums.latent.place);
    enthalpy = hn::IfThenElse(boils, after, enthalpy);
    water = hn::IfThenElse(boils, left, water);
    hn::Store(enthalpy, d, step.enthalpy_J_per_m3 + at.i);
    hn::Store(water, d, step.water_kg_per_m3 + at.i);
    hn::Store(hn::Add(hn::Load(d, step.steam_kg_per_m3 + at.i), steam), d, step.steam_kg_per_m3 + at.i);
    marks.boiled = true;
    return true;
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

/// Phases, temperature, peak and damage of what is hot, dry or may boil, in a group of its block. True when any lane
/// lost water or took damage.
template <bool mixed>
HWY_INLINE bool settle(const HeatStep& step, const PropertyLookup<mixed>& of, const CellVector& at, unsigned group,
                       BlockMarks& marks, RunSums& sums, HeatSums& shared) {
    const D d;
    const Properties& p = *step.properties;
    const F zero = hn::Zero(d), dry_capacity = of(p.dry_capacity_J_per_m3K);
    const F water_capacity = of(p.water_capacity_J_per_kgK);
    F enthalpy = hn::Load(d, step.enthalpy_J_per_m3 + at.i);
    const Mask bad = hn::AndNot(hn::Lt(hn::Abs(enthalpy), number(1e30f)), at.living);
    if (HWY_UNLIKELY(!hn::AllFalse(d, bad)) && shared.bad_hexel < 0)
        shared.bad_hexel = at.i + hn::FindFirstTrue(d, bad);

    F water = hn::Load(d, step.water_kg_per_m3 + at.i), limit = of(p.dry_limit_K);
    Mask dry = at.living;
    bool changed = false;
    if (step.threshold) {
        const F taken = hn::Max(hn::Sub(enthalpy, of(p.plateau_J_per_m3)), zero);
        const F gone = hn::Div(taken, number(static_cast<float>(kLatentHeatOfWater_J_per_kg)));
        water = hn::IfThenElse(at.living, hn::Max(hn::Sub(of(p.water_kg_per_m3), gone), zero), water);
        hn::Store(water, d, step.water_kg_per_m3 + at.i);
    } else {
        const F full = hn::Add(dry_capacity, hn::Mul(water, water_capacity));
        changed = boil(step, of, at, full, water, enthalpy, sums, marks);
        const Mask wet = hn::Gt(water, zero);
        limit = hn::IfThenElse(wet, number(p.wet_limit_K), limit);
        dry = hn::AndNot(wet, at.living);
    }
    const F capacity = hn::Add(dry_capacity, hn::Mul(water, water_capacity));
    const F rise = hn::Min(hn::Mul(enthalpy, hn::Div(number(1.0f), capacity)), limit);
    const F now_K = temperature_of(step, rise);
    hn::Store(now_K, d, step.next_temperature_K + at.i);
    mark_warm(marks, group, !hn::AllFalse(d, hn::AndNot(at_rest(rise), at.living)));
    marks.spent |= !hn::AllFalse(d, hn::And(dry, hn::Ge(enthalpy, of(p.spent_J_per_m3))));
    const Mask hurts = hn::And(hn::Gt(now_K, number(kDamageThreshold_K)), at.living);
    if (hn::AllFalse(d, hurts)) return changed;
    hurt(step, of, at.i, hurts, now_K);
    return true;
}

/// Blocks that are worked on together, and what comes of it.
struct Run {
    const std::int32_t* blocks;
    BlockMarks* marks;
    RunSums sums;
    /// First cell of a group.
    HWY_INLINE std::int64_t cell(const HeatStep& step, unsigned place) const {
        return step.first + blocks[place / kBlockGroups] * kBlockCells + place % kBlockGroups * kGroupCells;
    }
};

/// Groups of a run, told by their place in it.
struct GroupList {
    std::uint16_t places[kRunBlocks * kBlockGroups];
    int count = 0;
    /// Adds one where `yes`, without a branch. At most as many as there are.
    HWY_INLINE void add_if(bool yes, unsigned place) {
        places[count] = static_cast<std::uint16_t>(place);
        count += yes ? 1 : 0;
    }
};

HWY_NOINLINE void settle_groups(const HeatStep& step, Run& run, const GroupList& list, HeatSums& shared) {
    for (int n = 0; n < list.count; ++n) {
        const unsigned place = list.places[n];
        const std::int64_t first = run.cell(step, place);
        CellGroup& group = step.groups[first / kGroupCells];
        BlockMarks& marks = run.marks[place / kBlockGroups];
        bool changed = false;
        for (int part = 0; part < kParts; ++part) {
            const std::int64_t i = first + part * kLanes;
            const CellVector at{i, part, mask_at(step.living, i)};
            if (hn::AllFalse(D(), at.living)) continue;
            const unsigned own = place % kBlockGroups;
            changed |= (group.kind & kMixed) != 0
                           ? settle(step, PropertyLookup<true>(step, group, i), at, own, marks, run.sums, shared)
                           : settle(step, PropertyLookup<false>(step, group, i), at, own, marks, run.sums, shared);
        }
        if (!changed) continue;
        marks.changed = true;
        group.kind |= kChanged;
    }
}

/// 1 / C of the lanes from cell i on.
template <bool changed, bool mixed>
HWY_INLINE F per_capacity(const HeatStep& step, const PropertyLookup<mixed>& of, std::int64_t i) {
    if constexpr (!changed) return of(step.properties->per_capacity_alive_m3K_per_J);
    const F water = hn::Load(D(), step.water_kg_per_m3 + i);
    const F of_water = hn::Mul(water, of(step.properties->water_capacity_J_per_kgK));
    return hn::Div(number(1.0f), hn::Add(of(step.properties->dry_capacity_J_per_m3K), of_water));
}

/// What came of a vector.
struct Outcome {
    bool warm, hot;  ///< hot: settle() has to see it
};

/// The lanes of a group from cell k on, i of the lattice.
template <bool exposed, bool changed, bool mixed>
HWY_INLINE Outcome step_vector(const HeatStep& step, const CellGroup& group, std::int64_t i, int k, ConductSums& sums) {
    const D d;
    const PropertyLookup<mixed> of(step, group, i);
    const Properties& p = *step.properties;
    const Mask present = mask_of(group.present, k), living = mask_at(step.living, i);
    const F own_K = hn::Load(d, step.temperature_K + i), rise = hn::Sub(own_K, number(step.body_K));
    const F before = hn::Load(d, step.enthalpy_J_per_m3 + i);
    F blood = of(p.to_blood_J_per_m3K);
    if constexpr (changed) blood = hn::Mul(blood, flow_left(hn::Load(d, step.damage + i)));
    const F conducted = hn::Add(before, conduction<mixed>(step, group, i, k, own_K, of(p.conducted_J_per_m3K)));
    const F perfused = hn::Sub(conducted, hn::Mul(blood, rise));
    const int part = k / kLanes;
    sums.conducted.add(part, hn::IfThenElseZero(living, hn::Sub(conducted, before)));
    sums.perfusion.add(part, hn::IfThenElseZero(present, hn::Sub(conducted, perfused)));
    F next = perfused;
    if constexpr (exposed) {
        next = exchange(step, of, i, own_K, rise, perfused);
        sums.surface.add(part, hn::IfThenElseZero(present, hn::Sub(perfused, next)));
    }
    next = hn::IfThenElse(present, next, before);  // masked stores are slow; absent cells get back what they had
    hn::Store(next, d, step.enthalpy_J_per_m3 + i);
    const F next_rise = hn::Mul(next, per_capacity<changed>(step, of, i));
    hn::Store(temperature_of(step, next_rise), d, step.next_temperature_K + i);
    return {!hn::AllFalse(d, hn::AndNot(at_rest(next_rise), living)),
            !hn::AllTrue(d, hn::Le(next_rise, number(p.quick_rise_K)))};
}

/// Calls for what a group will want from memory, so that it is there in time.
template <bool exposed, bool changed, bool mixed>
HWY_INLINE void call_for(const HeatStep& step, std::int64_t cell) {
    hwy::Prefetch(step.temperature_K + cell);
    hwy::Prefetch(step.temperature_K + cell + step.furthest);
    hwy::Prefetch(step.enthalpy_J_per_m3 + cell);
    hwy::Prefetch(step.next_temperature_K + cell);
    if constexpr (exposed) {
        hwy::Prefetch(step.faces + cell);
        hwy::Prefetch(step.share + cell);
    }
    if constexpr (changed) {
        hwy::Prefetch(step.water_kg_per_m3 + cell);
        hwy::Prefetch(step.damage + cell);
    }
    if constexpr (mixed) hwy::Prefetch(step.material + cell);
}

/// Groups of one kind.
template <bool exposed, bool changed, bool mixed>
HWY_NOINLINE void step_groups(const HeatStep& shared, Run& run, const GroupList& list, GroupList& hot) {
    constexpr int kInFloats = 16;  // sums of so many groups lose nothing that matters
    constexpr int kAhead = 8;      // groups, about the time that memory takes
    const HeatStep step = shared;  // a copy of its own stays in registers
    for (int from = 0; from < list.count; from += kInFloats) {
        const int to = from + kInFloats < list.count ? from + kInFloats : list.count;
        ConductSums sums;
        for (int n = from; n < to; ++n) {
            const unsigned place = list.places[n];
            if (n + kAhead < list.count)
                call_for<exposed, changed, mixed>(step, run.cell(step, list.places[n + kAhead]));
            const std::int64_t first = run.cell(step, place);
            const CellGroup& group = step.groups[first / kGroupCells];
            Outcome any{false, false};
            for (int k = 0; k < kGroupCells; k += kLanes) {
                const Outcome one = step_vector<exposed, changed, mixed>(step, group, first + k, k, sums);
                any = {any.warm || one.warm, any.hot || one.hot};
            }
            mark_warm(run.marks[place / kBlockGroups], place % kBlockGroups, any.warm);
            hot.add_if(any.hot, place);
        }
        sums.add_to(run.sums);
    }
}

void step_blocks(const HeatStep& step, const std::int32_t* blocks, int count, BlockMarks* marks, HeatSums& sums) {
    Run run{blocks, marks, {}};
    GroupList kinds[kMixed + 1], hot;
    for (int b = 0; b < count; ++b) {
        marks[b] = {};
        const std::int64_t begin = step.first + blocks[b] * kBlockCells, past = begin + kBlockCells;
        if (step.joule.density != nullptr) deposit(step, begin, past < step.last ? past : step.last, run.sums);
        const CellGroup* groups = step.groups + begin / kGroupCells;
        if (b + 2 < count) {
            const CellGroup* ahead = step.groups + (step.first + blocks[b + 2] * kBlockCells) / kGroupCells;
            for (unsigned g = 0; g < kBlockGroups; g += 64 / sizeof(CellGroup)) hwy::Prefetch(ahead + g);
        }
        for (std::uint32_t active = step.active->groups_of(blocks[b]); active != 0; active &= active - 1) {
            const auto g = static_cast<unsigned>(hwy::Num0BitsBelowLS1Bit_Nonzero32(active));
            const unsigned kind = groups[g].kind < kMixed ? groups[g].kind : unsigned{kMixed};
            kinds[kind].add_if(groups[g].present != 0, static_cast<unsigned>(b) * kBlockGroups + g);
        }
    }
    step_groups<false, false, false>(step, run, kinds[kPlain], hot);
    step_groups<true, false, false>(step, run, kinds[kExposed], hot);
    step_groups<false, true, false>(step, run, kinds[kChanged], hot);
    step_groups<true, true, false>(step, run, kinds[kExposed | kChanged], hot);
    step_groups<true, true, true>(step, run, kinds[kMixed], hot);
    settle_groups(step, run, hot, sums);
    sums.delivered += run.sums.delivered.total();
    sums.conducted += run.sums.conducted.total();
    sums.perfusion += run.sums.perfusion.total();
    sums.surface += run.sums.surface.total();
    sums.gas += run.sums.gas.total();
    sums.latent += run.sums.latent.total();
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::thermal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::thermal {

HWY_EXPORT(step_blocks);

void step_blocks(const HeatStep& step, const std::int32_t* blocks, int count, BlockMarks* marks, HeatSums& sums) {
    HWY_DYNAMIC_DISPATCH(step_blocks)(step, blocks, count, marks, sums);
}

}  // namespace calot::thermal
#endif
