#pragma once
// Which blocks of cells, and which groups in them, a heat step runs over, as bits.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/thermal/groups.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::thermal {

/// Cells of a block, the unit of turns: a few rows. Within it, groups work or rest.
inline constexpr std::int64_t kBlockCells = 256;
inline constexpr unsigned kBlockGroups = kBlockCells / kGroupCells;

/// The cells of a block.
struct Cells {
    std::int64_t begin, end;
};
Cells cells_of(const Lattice& lattice, std::int64_t block);
std::int64_t block_count(const Lattice& lattice);

/// A set of blocks, or of groups of kGroupCells cells, counted from the lattice's first cell as well.
class BlockSet {
  public:
    explicit BlockSet(std::int64_t blocks = 0) : words_(static_cast<std::size_t>(blocks / 64 + 1), 0) {}
    bool test(std::int64_t b) const { return (words_[static_cast<std::size_t>(b >> 6)] >> (b & 63)) & 1u; }
    void set(std::int64_t b) { words_[static_cast<std::size_t>(b >> 6)] |= std::uint64_t{1} << (b & 63); }
    void clear() { std::fill(words_.begin(), words_.end(), std::uint64_t{0}); }
    void clear(std::int64_t b) { words_[static_cast<std::size_t>(b >> 6)] &= ~(std::uint64_t{1} << (b & 63)); }
    /// All of [first, last].
    void set_range(std::int64_t first, std::int64_t last);
    /// Of a set of groups, those of a block: bits, lowest first.
    std::uint16_t groups_of(std::int64_t block) const {
        return static_cast<std::uint16_t>(words_[static_cast<std::size_t>(block >> 2)] >> (16 * (block & 3)));
    }
    void set_groups(std::int64_t block, std::uint16_t groups) {
        std::uint64_t& word = words_[static_cast<std::size_t>(block >> 2)];
        const auto shift = 16 * (block & 3);
        word = (word & ~(std::uint64_t{0xffff} << shift)) | std::uint64_t{groups} << shift;
    }
    /// Adds the blocks of `other`, `shift` further on.
    void add_shifted(const BlockSet& other, std::int64_t shift);
    void keep(const BlockSet& other);
    std::int64_t count() const;
    std::size_t words() const { return words_.size(); }
    std::uint64_t word(std::size_t k) const { return words_[k]; }

  private:
    std::vector<std::uint64_t> words_;
};

static_assert(kBlockGroups == 16, "a block's groups are sixteen bits of their set");

/// Blocks, or groups, of `cells` cells that ever held tissue.
BlockSet populated(const tissue::Model& model, std::int64_t cells);

/// The blocks that hold any of these groups, into `out`.
void find_blocks(const BlockSet& groups, BlockSet& out);

/// `warm` and all blocks, or groups, of `cells` cells that hold a face neighbour of one of its cells, into `out`.
void dilate(const Lattice& lattice, const BlockSet& warm, std::int64_t cells, BlockSet& out);

/// Adds the groups that Joule heat reaches.
void add_heated(const Lattice& lattice, const tissue::JouleHeat& joule, BlockSet& groups);

}  // namespace calot::thermal
