#include "calot/thermal/groups.h"

#include <algorithm>
#include <cmath>

namespace calot::thermal {

namespace {

std::uint16_t bits_of(const BitArray& bits, std::int64_t cell) {
    return static_cast<std::uint16_t>(bits.bits32(cell));
}

/// kMixed, unless all hexels of a group and their neighbours, at the start and hence later, are of one tissue.
GroupKind find_material(const tissue::Model& model, std::int64_t first, tissue::MaterialIndex& common) {
    common = tissue::kNoMaterial;
    bool mixed = false;
    auto see = [&](std::int64_t cell) {
        if (!model.hexel_initial.test(cell)) return;
        const tissue::MaterialIndex material = model.hexel_material[static_cast<std::size_t>(cell)];
        if (common == tissue::kNoMaterial) common = material;
        mixed |= common != material;
    };
    for (std::int64_t cell = first; cell < first + kGroupCells; ++cell) {
        if (!model.hexel_initial.test(cell)) continue;
        see(cell);
        for (int axis = 0; axis < 3; ++axis)
            for (const std::int64_t offset : {-model.hexels.stride[axis], model.hexels.stride[axis]}) see(cell + offset);
    }
    return mixed ? kMixed : kPlain;
}

/// 1 / (|nx| + |ny| + |nz|) of a hexel's surface; 1 where the tissue around it balances.
double share_of(const Lattice& lattice, const BitArray& present, std::int64_t cell) {
    Vec3 inward(0.0);
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (present.test(cell + lattice.offset({x, y, z})))
                    inward += Vec3(x, y, z) / std::max(1.0, static_cast<double>(x * x + y * y + z * z));
    const double sum = std::abs(inward.x) + std::abs(inward.y) + std::abs(inward.z);
    return sum > 1e-9 ? glm::length(inward) / sum : 1.0;
}

}  // namespace

Groups Groups::make(const tissue::Model& model, const BitArray& present) {
    const Lattice& lattice = model.hexels;
    Groups all;
    const std::int64_t count = lattice.cells / kGroupCells + 17;  // a block of 16 groups may begin with the last cells
    all.groups.assign(static_cast<std::size_t>(count), {});
    all.cost.assign(static_cast<std::size_t>(count), 0);
    all.faces.assign(static_cast<std::size_t>(lattice.cells), 0);
    all.share.assign(static_cast<std::size_t>(lattice.cells), 0);
    all.dirty = BitArray(count);
    for (std::int64_t group = lattice.first / kGroupCells; group * kGroupCells < lattice.last; ++group) {
        if (bits_of(model.hexel_initial, group * kGroupCells) == 0) continue;
        CellGroup& own = all.groups[static_cast<std::size_t>(group)];
        own.kind = find_material(model, group * kGroupCells, own.material);
        all.look_at(model, present, group);
    }
    return all;
}

void Groups::look_at(const tissue::Model& model, const BitArray& present, std::int64_t group) {
    const std::int64_t first = group * kGroupCells;
    CellGroup& own = groups[static_cast<std::size_t>(group)];
    own.present = bits_of(present, first);
    std::uint16_t gas[6], held[6], exposed = 0;
    for (int n = 0; n < 6; ++n) {
        const std::int64_t stride = model.hexels.stride[n / 2], there = first + (n % 2 == 0 ? -stride : stride);
        own.beside[n] = bits_of(present, there);
        const auto absent = static_cast<std::uint16_t>(own.present & ~own.beside[n]);
        held[n] = static_cast<std::uint16_t>(absent & bits_of(model.hexel_held, there));
        gas[n] = static_cast<std::uint16_t>(absent & ~held[n]);
        exposed |= absent;
    }
    own.kind = static_cast<std::uint8_t>(exposed != 0 ? own.kind | kExposed : own.kind & ~kExposed);
    weigh(group);
    for (int k = 0; k < kGroupCells; ++k) {
        const auto cell = static_cast<std::size_t>(first + k);
        faces[cell] = 0;
        if ((exposed >> k & 1) == 0) continue;
        int count = 0;
        for (int n = 0; n < 6; ++n) count += (gas[n] >> k & 1) + kHeldFace * (held[n] >> k & 1);
        faces[cell] = static_cast<std::uint8_t>(count);
        share[cell] = static_cast<std::uint8_t>(std::lround(kWholeFace * share_of(model.hexels, present, first + k)));
    }
}

void Groups::touch(const Lattice& lattice, std::int64_t hexel) {
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) dirty.set((hexel + lattice.offset({x, y, z})) / kGroupCells);
}

void Groups::refresh(const tissue::Model& model, const BitArray& present) {
    for (std::uint64_t& word : dirty.words())
        for (; word != 0; word &= word - 1) {
            const auto group = 64 * (&word - dirty.words().data()) + __builtin_ctzll(word);
            // What never held tissue needs no look.
            if (bits_of(model.hexel_initial, group * kGroupCells) != 0) look_at(model, present, group);
        }
}

}  // namespace calot::thermal
