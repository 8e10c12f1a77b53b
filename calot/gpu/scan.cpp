#include "calot/gpu/scan.h"

#include <cassert>

namespace calot::gpu {

namespace {

constexpr int kGroup = 256;  // SCAN_GROUP of kernels/scan_group.h

std::int64_t groups_of(std::int64_t count) {
    return (count + kGroup - 1) / kGroup;
}

}  // namespace

Scan::Scan(std::shared_ptr<Device> device, std::int64_t most)
    : device_(std::move(device)),
      popcounts_(device_->kernel("scan", "popcounts")),
      group_sums_(device_->kernel("scan", "group_sums")),
      scan_sums_(device_->kernel("scan", "scan_sums")),
      scan_numbers_(device_->kernel("scan", "scan_numbers")),
      list_bits_(device_->kernel("scan", "list_bits")),
      sums_(*device_, groups_of(most)),
      counts_(*device_, most) {}

void Scan::exclusive(DeviceArray<std::int32_t>& numbers, std::int64_t count, DeviceArray<std::int32_t>& total) {
    assert(count <= counts_.size());
    const auto n = static_cast<std::int32_t>(count), groups = static_cast<std::int32_t>(groups_of(count));
    device_->launch(group_sums_, count, kGroup, numbers, n, sums_);
    device_->launch(scan_sums_, kGroup, kGroup, sums_, groups, total);
    device_->launch(scan_numbers_, count, kGroup, numbers, n, sums_);
}

void Scan::list_bits(const DeviceArray<std::uint32_t>& bits, std::int64_t words, DeviceArray<std::int32_t>& list,
                     DeviceArray<std::int32_t>& total) {
    const auto n = static_cast<std::int32_t>(words), room = static_cast<std::int32_t>(list.size());
    device_->launch(popcounts_, words, kGroup, bits, n, counts_);
    exclusive(counts_, words, total);
    device_->launch(list_bits_, words, kGroup, bits, n, counts_, list, room);
}

}  // namespace calot::gpu
