#pragma once
// Which backend a run gets.

#include <optional>
#include <string>

#include "calot/gpu/device.h"
#include "calot/simulation/setup.h"

namespace calot::gpu {

enum class BackendKind { cpu, gpu, automatic };

struct BackendWish {
    BackendKind kind = BackendKind::cpu;
    int device = -1;  ///< place in devices(); -1: the first
};

/// With `automatic`, scenes of fewer present hexels stay with the CPU. What rules a small scene's tick on a device is
/// not its size but some thirty launches and a few waits. From here on a desktop's GPU should be some times faster, by
/// the model of docs/gpu.md. Nothing was measured: little would be no reason.
inline constexpr std::int64_t kWorthADevice = 1'000'000;

struct BackendChoice {
    std::optional<DeviceInfo> device;  ///< none: the CPU
    std::string why;                   ///< for people: what was taken, and why
};

/// Throws InputError when a device is wished for and there is none, or none of that number.
BackendChoice choose_backend(const BackendWish& wish, const std::vector<DeviceInfo>& devices, std::int64_t hexels);

/// Simulations of this setup are to run there.
void use_backend(const BackendChoice& choice, simulation::Setup& setup);

/// "NVIDIA RTX A2000 (CUDA, 6138 MB)"
std::string describe(const DeviceInfo& info);

}  // namespace calot::gpu
