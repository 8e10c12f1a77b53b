#pragma once
// NVIDIA's devices through CUDA's driver API. The kernels were compiled by nvcc when the library was built, for compute
// capabilities 8.0 and 9.0, with PTX that newer drivers turn into code for newer devices.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "calot/gpu/device.h"

namespace calot::gpu {

/// A kernel source as nvcc compiled it: a "fat binary".
struct CudaModule {
    const char* name;
    std::span<const std::uint8_t> image;
};
/// Of every kernel source; empty when the library was built without nvcc.
std::span<const CudaModule> cuda_modules();

/// Least compute capability, major: that of the PTX.
inline constexpr int kCudaCapability = 8;

/// Devices that the modules run on. Empty without modules or driver; never throws.
std::vector<DeviceInfo> cuda_devices(std::span<const CudaModule> modules = cuda_modules());
std::shared_ptr<Device> open_cuda(const DeviceInfo& info, std::span<const CudaModule> modules = cuda_modules());

}  // namespace calot::gpu
