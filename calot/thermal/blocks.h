#pragma once
// Which blocks of cells a heat step runs over, as bits.

#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/thermal/groups.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::thermal {

/// Cells of a block, the unit of work and of rest: a few rows.
inline constexpr std::int64_t kBlockCells = 256;
inline constexpr unsigned kBlockGroups = kBlockCells / kGroupCells;

/// The cells of a block.
struct Cells {
    std::int64_t begin, end;
};
Cells cells_of(const Lattice& lattice, std::int64_t block);
std::int64_t block_count(const Lattice& lattice);

/// A set of blocks.
class BlockSet {
  public:
    explicit BlockSet(std::int64_t blocks = 0) : words_(static_cast<std::size_t>(blocks / 64 + 1), 0) {}
    bool test(std::int64_t b) const { return (words_[static_cast<std::size_t>(b >> 6)] >> (b & 63)) & 1u; }
    void set(std::int64_t b) { words_[static_cast<std::size_t>(b >> 6)] |= std::uint64_t{1} << (b & 63); }
    void clear(std::int64_t b) { words_[static_cast<std::size_t>(b >> 6)] &= ~(std::uint64_t{1} << (b & 63)); }
    /// All of [first, last].
    void set_range(std::int64_t first, std::int64_t last);
    /// Adds the blocks of `other`, `shift` further on.
    void add_shifted(const BlockSet& other, std::int64_t shift);
    void keep(const BlockSet& other);
    std::int64_t count() const;
    std::size_t words() const { return words_.size(); }
    std::uint64_t word(std::size_t k) const { return words_[k]; }

  private:
    std::vector<std::uint64_t> words_;
};

/// Blocks that ever held tissue.
BlockSet populated_blocks(const tissue::Model& model);

/// `warm` and all blocks that hold a face neighbour of one of its cells, into `out`.
void dilate(const Lattice& lattice, const BlockSet& warm, BlockSet& out);

/// Adds the blocks that Joule heat reaches.
void add_heated(const Lattice& lattice, const tissue::JouleHeat& joule, BlockSet& out);

}  // namespace calot::thermal
