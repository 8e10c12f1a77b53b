#pragma once
// The drivers behind Device: a list of devices and a way to open one, each.

#include "calot/gpu/device.h"

namespace calot::gpu {

/// Empty where there is no driver; never throws.
std::vector<DeviceInfo> opencl_devices();
std::shared_ptr<Device> open_opencl(const DeviceInfo& info);

}  // namespace calot::gpu
