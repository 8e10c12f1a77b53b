#include "calot/gpu/device.h"

#include <algorithm>

#include "calot/gpu/cuda.h"
#include "calot/gpu/drivers.h"

namespace calot::gpu {

std::vector<DeviceInfo> devices() {
    std::vector<DeviceInfo> all = opencl_devices();
    for (DeviceInfo& info : cuda_devices()) all.push_back(std::move(info));
    std::stable_sort(all.begin(), all.end(), [](const DeviceInfo& a, const DeviceInfo& b) {
        return a.is_gpu != b.is_gpu ? a.is_gpu : a.memory_bytes > b.memory_bytes && a.is_gpu;
    });
    return all;
}

std::shared_ptr<Device> Device::open(const DeviceInfo& info) {
    switch (info.api) {
        case Api::opencl:
            return open_opencl(info);
        case Api::cuda:
            return open_cuda(info);
    }
    throw DeviceError("no driver for " + info.name);
}

const char* kernel_text(const std::string& name) {
    for (const KernelSource& source : kernel_sources())
        if (name == source.name) return source.text;
    throw DeviceError("there is no kernel source named " + name);
}

}  // namespace calot::gpu
