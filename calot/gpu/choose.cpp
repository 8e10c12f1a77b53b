#include "calot/gpu/choose.h"

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/gpu/backend.h"

namespace calot::gpu {

std::string describe(const DeviceInfo& info) {
    return fmt::format("{} ({}, {} MB{})", info.name, info.api == Api::cuda ? "CUDA" : "OpenCL",
                       info.memory_bytes >> 20, info.is_gpu ? "" : ", not a GPU");
}

BackendChoice choose_backend(const BackendWish& wish, const std::vector<DeviceInfo>& devices, std::int64_t hexels) {
    if (wish.kind == BackendKind::cpu) return {std::nullopt, "CPU"};
    if (wish.device >= static_cast<int>(devices.size()))
        throw InputError(fmt::format("there is no device {}", wish.device),
                         devices.empty() ? "no driver of OpenCL or CUDA offers one"
                                         : "`calot inspect --devices` lists those that there are");
    if (wish.kind == BackendKind::gpu) {
        if (devices.empty())
            throw InputError("there is no device to compute on: no driver of OpenCL or CUDA offers one",
                             "leave --backend out to compute on the CPU");
        const DeviceInfo& device = devices[wish.device < 0 ? 0 : static_cast<std::size_t>(wish.device)];
        return {device, "GPU: " + describe(device)};
    }
    const DeviceInfo* device = nullptr;
    if (wish.device >= 0)
        device = &devices[static_cast<std::size_t>(wish.device)];
    else if (!devices.empty())
        device = &devices.front();  // GPUs come first
    if (device == nullptr || !device->is_gpu) return {std::nullopt, "CPU: there is no GPU"};
    if (hexels < kWorthADevice)
        return {std::nullopt,
                fmt::format("CPU: a scene of {} hexels is too small for a GPU to be worth it ({} and more are)", hexels,
                            kWorthADevice)};
    return {*device, fmt::format("GPU: {}, for {} hexels", describe(*device), hexels)};
}

void use_backend(const BackendChoice& choice, simulation::Setup& setup) {
    if (!choice.device) {
        setup.backend = nullptr;
        return;
    }
    setup.backend = [device = *choice.device](const simulation::Setup& of) {
        return std::make_unique<Backend>(device, of);
    };
}

}  // namespace calot::gpu
