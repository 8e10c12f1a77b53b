#pragma once
// Hands out ranges of a long array, in sizes 32, 64, 128, ... Freed ranges wait in a list of their size, so that a
// range is found without a search. Where a range lies never shows in the mesh.

#include <array>
#include <cstdint>
#include <vector>

namespace calot::surface {

struct Range {
    std::uint32_t offset = 0;
    std::int32_t size_class = -1;  ///< capacity 32 << size_class; -1 = none
};

class Pool {
  public:
    static constexpr int kClasses = 8;  ///< up to 32 << 7 = 4096 elements

    void clear(std::size_t most_ranges) {
        end_ = 0;
        for (auto& list : free_) {
            list.clear();
            list.reserve(most_ranges);
        }
    }
    /// Makes the range hold `elements`; what it held is lost.
    void fit(Range& range, int elements) {
        int size_class = -1;
        while (elements > 0 && (size_class < 0 || (32 << size_class) < elements)) ++size_class;
        if (size_class == range.size_class) return;
        if (range.size_class >= 0) free_[static_cast<std::size_t>(range.size_class)].push_back(range.offset);
        range.size_class = size_class;
        if (size_class < 0) return;
        auto& list = free_[static_cast<std::size_t>(size_class)];
        if (!list.empty()) {
            range.offset = list.back();
            list.pop_back();
        } else {
            range.offset = end_;
            end_ += 32u << size_class;
        }
    }
    /// Elements that the array behind must have.
    std::uint32_t end() const { return end_; }

  private:
    std::uint32_t end_ = 0;
    std::array<std::vector<std::uint32_t>, kClasses> free_;
};

}  // namespace calot::surface
