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
    const auto from = [&](std::int64_t w) {
        return w >= 0 && w < words ? other.words_[static_cast<std::size_t>(w)] : 0;
    };
    const auto carry = [&](std::uint64_t below) { return bits != 0 ? below >> (64 - bits) : 0; };
    const std::int64_t first = std::max<std::int64_t>(0, whole), last = std::min(words - 1, whole + words);
    if (first > last) return;
    words_[static_cast<std::size_t>(first)] |= from(first - whole) << bits | carry(from(first - whole - 1));
    if (first == last) return;
    words_[static_cast<std::size_t>(last)] |= from(last - whole) << bits | carry(from(last - whole - 1));
    // In between, both words are there.
    std::uint64_t* __restrict to = words_.data();
    const std::uint64_t* __restrict source = other.words_.data();
    if (bits == 0)
        for (std::int64_t w = first + 1; w < last; ++w) to[w] |= source[w - whole];
    else
        for (std::int64_t w = first + 1; w < last; ++w)
            to[w] |= source[w - whole] << bits | source[w - whole - 1] >> (64 - bits);
}

void BlockSet::keep(const BlockSet& other) {
    for (std::size_t k = 0; k < words_.size(); ++k) words_[k] &= other.words_[k];
}

std::int64_t BlockSet::count() const {
    std::int64_t total = 0;
    for (const std::uint64_t w : words_) total += __builtin_popcountll(w);
    return total;
}

BlockSet populated(const tissue::Model& model, std::int64_t cells) {
    const Lattice& lattice = model.hexels;
    BlockSet populated(block_count(lattice) * (kBlockCells / cells));
    for (std::int64_t i = lattice.first; i < lattice.last; ++i)
        if (model.hexel_initial.test(i)) populated.set((i - lattice.first) / cells);
    return populated;
}

void find_blocks(const BlockSet& groups, BlockSet& out) {
    out.clear();
    for (std::size_t k = 0; k < groups.words(); ++k) {
        if (groups.word(k) == 0) continue;
        for (std::int64_t b = static_cast<std::int64_t>(4 * k); b < static_cast<std::int64_t>(4 * k + 4); ++b)
            if (groups.groups_of(b) != 0) out.set(b);
    }
}

// A block shifted by an offset of o cells lies across one or two blocks: o / cells on, and the next.
void dilate(const Lattice& lattice, const BlockSet& warm, std::int64_t cells, BlockSet& out) {
    out = warm;  // of equal size: no allocation
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t offset = lattice.stride[axis], blocks = offset / cells;
        for (const std::int64_t shift : {blocks, blocks + 1}) {
            if ((shift == blocks + 1 && offset % cells == 0) || shift == 0) continue;
            out.add_shifted(warm, shift);
            out.add_shifted(warm, -shift);
        }
    }
}

void add_heated(const Lattice& lattice, const tissue::JouleHeat& joule, BlockSet& groups) {
    const Axes axes = axes_of(lattice);
    const Int3 low = glm::max(joule.low, Int3(0)), high = glm::min(joule.low + joule.size, lattice.size);
    if (glm::any(glm::lessThanEqual(high, low))) return;
    const int length = high[axes.fast] - low[axes.fast] - 1;
    Int3 first = low;
    for (first[axes.slow] = low[axes.slow]; first[axes.slow] < high[axes.slow]; ++first[axes.slow])
        for (first[axes.middle] = low[axes.middle]; first[axes.middle] < high[axes.middle]; ++first[axes.middle]) {
            const std::int64_t cell = lattice.index(first) - lattice.first;
            groups.set_range(cell / kGroupCells, (cell + length) / kGroupCells);
        }
}

}  // namespace calot::thermal
