#include "calot/gpu/cuda_api.h"

#include <dlfcn.h>

#include <mutex>

#include <fmt/format.h>

#include "calot/base/library.h"

namespace calot::gpu::cuda {

namespace {

std::string find_all(void* library, Api& api) {
    std::string missing;
    find_function(library, "cuInit", api.Init, missing);
    find_function(library, "cuDriverGetVersion", api.DriverGetVersion, missing);
    find_function(library, "cuGetErrorName", api.GetErrorName, missing);
    find_function(library, "cuGetErrorString", api.GetErrorString, missing);
    find_function(library, "cuDeviceGetCount", api.DeviceGetCount, missing);
    find_function(library, "cuDeviceGet", api.DeviceGet, missing);
    find_function(library, "cuDeviceGetName", api.DeviceGetName, missing);
    find_function(library, "cuDeviceTotalMem_v2", api.DeviceTotalMem, missing);
    find_function(library, "cuDeviceGetAttribute", api.DeviceGetAttribute, missing);
    find_function(library, "cuDevicePrimaryCtxRetain", api.DevicePrimaryCtxRetain, missing);
    find_function(library, "cuDevicePrimaryCtxRelease_v2", api.DevicePrimaryCtxRelease, missing);
    find_function(library, "cuCtxSetCurrent", api.CtxSetCurrent, missing);
    find_function(library, "cuStreamCreate", api.StreamCreate, missing);
    find_function(library, "cuStreamDestroy_v2", api.StreamDestroy, missing);
    find_function(library, "cuStreamSynchronize", api.StreamSynchronize, missing);
    find_function(library, "cuMemAlloc_v2", api.MemAlloc, missing);
    find_function(library, "cuMemFree_v2", api.MemFree, missing);
    find_function(library, "cuMemcpyHtoDAsync_v2", api.MemcpyHtoDAsync, missing);
    find_function(library, "cuMemcpyDtoHAsync_v2", api.MemcpyDtoHAsync, missing);
    find_function(library, "cuMemcpyDtoDAsync_v2", api.MemcpyDtoDAsync, missing);
    find_function(library, "cuMemsetD8Async", api.MemsetD8Async, missing);
    find_function(library, "cuModuleLoadData", api.ModuleLoadData, missing);
    find_function(library, "cuModuleUnload", api.ModuleUnload, missing);
    find_function(library, "cuModuleGetFunction", api.ModuleGetFunction, missing);
    find_function(library, "cuLaunchKernel", api.LaunchKernel, missing);
    find_function(library, "cuEventCreate", api.EventCreate, missing);
    find_function(library, "cuEventDestroy_v2", api.EventDestroy, missing);
    find_function(library, "cuEventRecord", api.EventRecord, missing);
    find_function(library, "cuEventElapsedTime", api.EventElapsedTime, missing);
    return missing;
}

}  // namespace

const Api* load(const std::string& path, std::string& why) {
    static std::mutex mutex;
    static Api api;
    static bool loaded = false;
    const std::lock_guard<std::mutex> lock(mutex);
    if (loaded) return &api;
    void* library = dlopen(path.empty() ? "libcuda.so.1" : path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        why = path.empty() ? "NVIDIA's driver (libcuda.so.1) is not installed" : dlerror();
        return nullptr;
    }
    Api found;
    const std::string missing = find_all(library, found);
    if (!missing.empty())
        why = fmt::format("the driver lacks {}", missing);
    else if (const Result result = found.Init(0); result != kSuccess)
        why = fmt::format("the driver does not start (error {})", result);
    else {
        api = found;
        loaded = true;
        return &api;
    }
    dlclose(library);
    return nullptr;
}

}  // namespace calot::gpu::cuda
