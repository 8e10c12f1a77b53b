#pragma once
// Prefix sums and compaction on a device, with a fixed order of what comes out.

#include "calot/gpu/device.h"

namespace calot::gpu {

class Scan {
  public:
    Scan() = default;
    /// For up to `most` numbers, or words of bits.
    Scan(std::shared_ptr<Device> device, std::int64_t most);

    /// Turns the first `count` numbers into sums of all before each; writes their total to total[0].
    void exclusive(DeviceArray<std::int32_t>& numbers, std::int64_t count, DeviceArray<std::int32_t>& total);

    /// Places of set bits in the first `words` words, ascending, as many as find room in `list`; total[0] is how many
    /// there are.
    void list_bits(const DeviceArray<std::uint32_t>& bits, std::int64_t words, DeviceArray<std::int32_t>& list,
                   DeviceArray<std::int32_t>& total);

  private:
    std::shared_ptr<Device> device_;
    Kernel popcounts_, group_sums_, scan_sums_, scan_numbers_, list_bits_;
    DeviceArray<std::int32_t> sums_, counts_;
};

}  // namespace calot::gpu
