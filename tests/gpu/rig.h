#pragma once
// The device of the tests: PoCL, which runs kernels on the CPU. It comes with the project's packages, so that every
// kernel runs here; a machine's GPU is taken instead where CALOT_TEST_GPU is set.

#include <cstdlib>

#include <gtest/gtest.h>

#include "calot/gpu/device.h"

namespace calot::gpu {

/// `in_double` = false: as if the device had no double precision.
inline std::shared_ptr<Device> test_device(bool in_double = true) {
    const bool wants_gpu = std::getenv("CALOT_TEST_GPU") != nullptr;
    for (DeviceInfo info : devices()) {
        info.has_double = info.has_double && in_double;
        if (info.is_gpu == wants_gpu) return Device::open(info);
    }
    throw DeviceError("no device to test on: is pocl-opencl-icd installed?");
}

}  // namespace calot::gpu
