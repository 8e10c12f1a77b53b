#include "calot/thermal/blocks.h"

#include <algorithm>

#include "calot/thermal/axes.h"

namespace calot::thermal {

Cells cells_of(const Lattice& lattice, std::int64_t block) {
    const std::int64_t begin = lattice.first + block * kBlockCells;
    return {begin, std::min(begin + kBlockCells, lattice.last)};
}

std::int64_t block_count(const Lattice& lattice) {
    return (lattice.last - lattice.first + kBlockCells - 1) / kBlockCells;
}

void BlockSet::set_range(std::int64_t first, std::int64_t last) {
    for (std::int64_t w = first >> 6; w <= last >> 6; ++w) {
        std::uint64_t bits = ~std::uint64_t{0};
        if (w == first >> 6) bits &= ~std::uint64_t{0} << (first & 63);
        if (w == last >> 6) bits &= ~std::uint64_t{0} >> (63 - (last & 63));
        words_[static_cast<std::size_t>(w)] |= bits;
    }
}

void BlockSet::add_shifted(const BlockSet& other, std::int64_t shift) {
    const std::int64_t words = static_cast<std::int64_t>(words_.size());
    const std::int64_t whole = shift >> 6;  // rounds down, for negative shifts as well
    const auto bits = static_cast<unsigned>(shift & 63);
    for (std::int64_t w = std::max<std::int64_t>(0, whole); w < words; ++w) {
        const std::int64_t from = w - whole;
        if (from - 1 >= words) break;
        std::uint64_t moved = from < words ? other.words_[static_cast<std::size_t>(from)] << bits : 0;
        if (bits != 0 && from > 0) moved |= other.words_[static_cast<std::size_t>(from - 1)] >> (64 - bits);
        words_[static_cast<std::size_t>(w)] |= moved;
    }
}

void BlockSet::keep(const BlockSet& other) {
    for (std::size_t k = 0; k < words_.size(); ++k) words_[k] &= other.words_[k];
}

std::int64_t BlockSet::count() const {
    std::int64_t total = 0;
    for (const std::uint64_t w : words_) total += __builtin_popcountll(w);
    return total;
}

BlockSet populated_blocks(const tissue::Model& model) {
    const Lattice& lattice = model.hexels;
    BlockSet populated(block_count(lattice));
    for (std::int64_t i = lattice.first; i < lattice.last; ++i)
        if (model.hexel_initial.test(i)) populated.set((i - lattice.first) / kBlockCells);
    return populated;
}

// A block shifted by an offset of o cells lies across one or two blocks: o / kBlockCells on, and the next.
void dilate(const Lattice& lattice, const BlockSet& warm, BlockSet& out) {
    out = warm;  // of equal size: no allocation
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t cells = lattice.stride[axis], blocks = cells / kBlockCells;
        for (const std::int64_t shift : {blocks, blocks + 1}) {
            if (shift == blocks + 1 && cells % kBlockCells == 0) continue;
            out.add_shifted(warm, shift);
            out.add_shifted(warm, -shift);
        }
    }
}

void add_heated(const Lattice& lattice, const tissue::JouleHeat& joule, BlockSet& out) {
    const Axes axes = axes_of(lattice);
    const Int3 low = glm::max(joule.low, Int3(0)), high = glm::min(joule.low + joule.size, lattice.size);
    if (glm::any(glm::lessThanEqual(high, low))) return;
    for (int plane = low[axes.slow]; plane < high[axes.slow]; ++plane) {
        Int3 first = low, last = high - 1;
        first[axes.slow] = last[axes.slow] = plane;
        out.set_range((lattice.index(first) - lattice.first) / kBlockCells,
                      (lattice.index(last) - lattice.first) / kBlockCells);
    }
}

}  // namespace calot::thermal
