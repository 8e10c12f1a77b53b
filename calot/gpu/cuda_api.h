#pragma once
// The part of CUDA's driver API that Calot calls, declared from its public documentation and loaded at run time, so
// that neither a CUDA header is needed to build nor the driver to run (docs/gpu.md).

#include <cstddef>
#include <string>

namespace calot::gpu::cuda {

using Result = int;
using DeviceId = int;
using Pointer = unsigned long long;  ///< of a device's memory
using Context = struct ContextOf*;
using Stream = struct StreamOf*;
using Module = struct ModuleOf*;
using Function = struct FunctionOf*;
using Event = struct EventOf*;

inline constexpr Result kSuccess = 0;      // CUDA_SUCCESS
inline constexpr Result kOutOfMemory = 2;  // CUDA_ERROR_OUT_OF_MEMORY
// Attributes of a device
inline constexpr int kMultiprocessors = 16;          // CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT
inline constexpr int kCapabilityMajor = 75;          // CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR
inline constexpr int kCapabilityMinor = 76;          // CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR
inline constexpr unsigned int kOwnStream = 0x1;      // CU_STREAM_NON_BLOCKING
inline constexpr unsigned int kEventWithTime = 0x0;  // CU_EVENT_DEFAULT

/// The driver's functions, by their names without "cu" and version. All are there, or load() failed.
struct Api {
    Result (*Init)(unsigned int flags) = nullptr;
    Result (*DriverGetVersion)(int* version) = nullptr;
    Result (*GetErrorName)(Result, const char** name) = nullptr;
    Result (*GetErrorString)(Result, const char** text) = nullptr;
    Result (*DeviceGetCount)(int* count) = nullptr;
    Result (*DeviceGet)(DeviceId*, int ordinal) = nullptr;
    Result (*DeviceGetName)(char* name, int length, DeviceId) = nullptr;
    Result (*DeviceTotalMem)(std::size_t* bytes, DeviceId) = nullptr;
    Result (*DeviceGetAttribute)(int* value, int attribute, DeviceId) = nullptr;
    Result (*DevicePrimaryCtxRetain)(Context*, DeviceId) = nullptr;
    Result (*DevicePrimaryCtxRelease)(DeviceId) = nullptr;
    Result (*CtxSetCurrent)(Context) = nullptr;
    Result (*StreamCreate)(Stream*, unsigned int flags) = nullptr;
    Result (*StreamDestroy)(Stream) = nullptr;
    Result (*StreamSynchronize)(Stream) = nullptr;
    Result (*MemAlloc)(Pointer*, std::size_t bytes) = nullptr;
    Result (*MemFree)(Pointer) = nullptr;
    Result (*MemcpyHtoDAsync)(Pointer to, const void* from, std::size_t bytes, Stream) = nullptr;
    Result (*MemcpyDtoHAsync)(void* to, Pointer from, std::size_t bytes, Stream) = nullptr;
    Result (*MemcpyDtoDAsync)(Pointer to, Pointer from, std::size_t bytes, Stream) = nullptr;
    Result (*MemsetD8Async)(Pointer, unsigned char value, std::size_t bytes, Stream) = nullptr;
    Result (*ModuleLoadData)(Module*, const void* image) = nullptr;
    Result (*ModuleUnload)(Module) = nullptr;
    Result (*ModuleGetFunction)(Function*, Module, const char* name) = nullptr;
    Result (*LaunchKernel)(Function, unsigned int grid_x, unsigned int grid_y, unsigned int grid_z,
                           unsigned int block_x, unsigned int block_y, unsigned int block_z, unsigned int shared_bytes,
                           Stream, void** parameters, void** extra) = nullptr;
    Result (*EventCreate)(Event*, unsigned int flags) = nullptr;
    Result (*EventDestroy)(Event) = nullptr;
    Result (*EventRecord)(Event, Stream) = nullptr;
    Result (*EventElapsedTime)(float* milliseconds, Event from, Event to) = nullptr;
};

/// Loads and initialises the driver: `path`, or libcuda.so.1 when it is empty. Returns nothing, with `why` set, when
/// there is none, it lacks a function or does not start. The first that is loaded stays; never unloaded.
const Api* load(const std::string& path, std::string& why);

}  // namespace calot::gpu::cuda
