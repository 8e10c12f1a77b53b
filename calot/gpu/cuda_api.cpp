#include "calot/gpu/cuda_api.h"

#include <dlfcn.h>

#include <mutex>

#include <fmt/format.h>

namespace calot::gpu::cuda {

namespace {

template <class F>
void find(void* library, const char* name, F& function, std::string& missing) {
    void* symbol = dlsym(library, name);
    if (symbol == nullptr) missing += (missing.empty() ? "" : ", ") + std::string(name);
    function = reinterpret_cast<F>(symbol);
}

std::string find_all(void* library, Api& api) {
    std::string missing;
    find(library, "cuInit", api.Init, missing);
    find(library, "cuDriverGetVersion", api.DriverGetVersion, missing);
    find(library, "cuGetErrorName", api.GetErrorName, missing);
    find(library, "cuGetErrorString", api.GetErrorString, missing);
    find(library, "cuDeviceGetCount", api.DeviceGetCount, missing);
    find(library, "cuDeviceGet", api.DeviceGet, missing);
    find(library, "cuDeviceGetName", api.DeviceGetName, missing);
    find(library, "cuDeviceTotalMem_v2", api.DeviceTotalMem, missing);
    find(library, "cuDeviceGetAttribute", api.DeviceGetAttribute, missing);
    find(library, "cuDevicePrimaryCtxRetain", api.DevicePrimaryCtxRetain, missing);
    find(library, "cuDevicePrimaryCtxRelease_v2", api.DevicePrimaryCtxRelease, missing);
    find(library, "cuCtxSetCurrent", api.CtxSetCurrent, missing);
    find(library, "cuStreamCreate", api.StreamCreate, missing);
    find(library, "cuStreamDestroy_v2", api.StreamDestroy, missing);
    find(library, "cuStreamSynchronize", api.StreamSynchronize, missing);
    find(library, "cuMemAlloc_v2", api.MemAlloc, missing);
    find(library, "cuMemFree_v2", api.MemFree, missing);
    find(library, "cuMemcpyHtoDAsync_v2", api.MemcpyHtoDAsync, missing);
    find(library, "cuMemcpyDtoHAsync_v2", api.MemcpyDtoHAsync, missing);
    find(library, "cuMemcpyDtoDAsync_v2", api.MemcpyDtoDAsync, missing);
    find(library, "cuMemsetD8Async", api.MemsetD8Async, missing);
    find(library, "cuModuleLoadData", api.ModuleLoadData, missing);
    find(library, "cuModuleUnload", api.ModuleUnload, missing);
    find(library, "cuModuleGetFunction", api.ModuleGetFunction, missing);
    find(library, "cuLaunchKernel", api.LaunchKernel, missing);
    find(library, "cuEventCreate", api.EventCreate, missing);
    find(library, "cuEventDestroy_v2", api.EventDestroy, missing);
    find(library, "cuEventRecord", api.EventRecord, missing);
    find(library, "cuEventElapsedTime", api.EventElapsedTime, missing);
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
