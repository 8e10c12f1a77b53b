// A stand-in for libcuda.so.1. Values are written out from the public documentation, apart from those in
// calot/gpu/cuda_api.h, so that a slip in one does not hide in the other. Nothing here runs a kernel.
#include "stand_in_cuda.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace {

constexpr int kInvalidValue = 1, kOutOfMemory = 2, kNotInitialized = 3, kInvalidDevice = 101, kInvalidImage = 200,
              kInvalidContext = 201, kInvalidHandle = 400, kNotFound = 500;

struct World {
    StandInCudaRecord record{};
    bool initialised = false;
    int devices = 1, major = 9, minor = 0, fails_with = 0;
    unsigned long long memory = 8 << 20;
    std::map<unsigned long long, std::size_t> buffers;  ///< by address
    std::set<const void*> streams, modules, events;
    std::map<std::string, std::vector<int>> parameters;
    std::map<std::string, int> functions;  ///< whose address is a handle
};
std::mutex mutex;
World world;
thread_local void* current = nullptr;
int the_context = 0;

using Lock = std::lock_guard<std::mutex>;

int misuse(int error) {
    ++world.record.misuse;
    return error;
}
/// What every call but the first looks at.
int entered(bool needs_context = true) {
    if (!world.initialised) return misuse(kNotInitialized);
    if (world.fails_with != 0) return world.fails_with;
    if (needs_context && (current != &the_context || world.record.contexts == 0)) return misuse(kInvalidContext);
    return 0;
}
bool holds(unsigned long long pointer, std::size_t bytes) {
    auto found = world.buffers.upper_bound(pointer);
    if (found == world.buffers.begin()) return false;
    --found;
    return pointer + bytes <= found->first + found->second;
}
void* at(unsigned long long pointer) {
    return reinterpret_cast<void*>(pointer);  // memory of the stand-in is the host's
}
template <class T>
int make(T** out, std::set<const void*>& alive, int& count) {
    *out = static_cast<T*>(std::malloc(1));
    alive.insert(*out);
    ++count;
    return 0;
}
int drop(const void* handle, std::set<const void*>& alive, int& count) {
    if (alive.erase(handle) == 0) return misuse(kInvalidHandle);
    std::free(const_cast<void*>(handle));
    --count;
    return 0;
}

}  // namespace

extern "C" {

int cuInit(unsigned flags) {
    const Lock lock(mutex);
    if (flags != 0) return misuse(kInvalidValue);
    world.initialised = true;
    return 0;
}
int cuDriverGetVersion(int* version) {
    *version = 12040;
    return 0;
}
int cuGetErrorName(int error, const char** name) {
    *name = error == kOutOfMemory ? "CUDA_ERROR_OUT_OF_MEMORY"
            : error == 719        ? "CUDA_ERROR_LAUNCH_FAILED"
                                  : "CUDA_ERROR_OTHER";
    return 0;
}
int cuGetErrorString(int error, const char** text) {
    *text = error == kOutOfMemory ? "out of memory" : error == 719 ? "unspecified launch failure" : "some error";
    return 0;
}
int cuDeviceGetCount(int* count) {
    const Lock lock(mutex);
    *count = world.devices;
    return entered(false);
}
int cuDeviceGet(int* device, int ordinal) {
    const Lock lock(mutex);
    if (ordinal < 0 || ordinal >= world.devices) return kInvalidDevice;
    *device = 40 + ordinal;
    return entered(false);
}
int cuDeviceGetName(char* name, int length, int device) {
    const Lock lock(mutex);
    std::snprintf(name, static_cast<std::size_t>(length), "Stand-in %d", device - 40);
    return entered(false);
}
int cuDeviceTotalMem_v2(std::size_t* bytes, int) {
    const Lock lock(mutex);
    *bytes = world.memory;
    return entered(false);
}
int cuDeviceGetAttribute(int* value, int attribute, int) {
    const Lock lock(mutex);
    if (attribute == 75)
        *value = world.major;
    else if (attribute == 76)
        *value = world.minor;
    else if (attribute == 16)
        *value = 108;
    else
        return misuse(kInvalidValue);
    return entered(false);
}
int cuDevicePrimaryCtxRetain(void** context, int device) {
    const Lock lock(mutex);
    if (device < 40 || device >= 40 + world.devices) return misuse(kInvalidDevice);
    if (const int error = entered(false); error != 0) return error;
    *context = &the_context;
    ++world.record.contexts;
    return 0;
}
int cuDevicePrimaryCtxRelease_v2(int) {
    const Lock lock(mutex);
    if (world.record.contexts == 0) return misuse(kInvalidContext);
    --world.record.contexts;
    return 0;
}
int cuCtxSetCurrent(void* context) {
    const Lock lock(mutex);
    current = context;
    return entered(false);
}
int cuStreamCreate(void** stream, unsigned flags) {
    const Lock lock(mutex);
    if (flags > 1) return misuse(kInvalidValue);
    if (const int error = entered(); error != 0) return error;
    return make(stream, world.streams, world.record.streams);
}
int cuStreamDestroy_v2(void* stream) {
    const Lock lock(mutex);
    return drop(stream, world.streams, world.record.streams);
}
int cuStreamSynchronize(void* stream) {
    const Lock lock(mutex);
    if (world.streams.count(stream) == 0) return misuse(kInvalidHandle);
    ++world.record.waits;
    return entered();
}
int cuMemAlloc_v2(unsigned long long* pointer, std::size_t bytes) {
    const Lock lock(mutex);
    if (const int error = entered(); error != 0) return error;
    if (bytes == 0) return misuse(kInvalidValue);
    if (world.record.bytes + bytes > world.memory) return kOutOfMemory;
    void* memory = std::malloc(bytes);
    std::memset(memory, 0xa5, bytes);  // a device's memory is not clear
    *pointer = reinterpret_cast<unsigned long long>(memory);
    world.buffers[*pointer] = bytes;
    world.record.bytes += bytes;
    ++world.record.buffers;
    return 0;
}
int cuMemFree_v2(unsigned long long pointer) {
    const Lock lock(mutex);
    const auto found = world.buffers.find(pointer);
    if (found == world.buffers.end()) return misuse(kInvalidValue);
    world.record.bytes -= found->second;
    --world.record.buffers;
    world.buffers.erase(found);
    std::free(at(pointer));
    return 0;
}
int cuMemcpyHtoDAsync_v2(unsigned long long to, const void* from, std::size_t bytes, void* stream) {
    const Lock lock(mutex);
    if (!holds(to, bytes) || world.streams.count(stream) == 0) return misuse(kInvalidValue);
    if (const int error = entered(); error != 0) return error;
    std::memcpy(at(to), from, bytes);
    return 0;
}
int cuMemcpyDtoHAsync_v2(void* to, unsigned long long from, std::size_t bytes, void* stream) {
    const Lock lock(mutex);
    if (!holds(from, bytes) || world.streams.count(stream) == 0) return misuse(kInvalidValue);
    if (const int error = entered(); error != 0) return error;
    std::memcpy(to, at(from), bytes);
    return 0;
}
int cuMemcpyDtoDAsync_v2(unsigned long long to, unsigned long long from, std::size_t bytes, void* stream) {
    const Lock lock(mutex);
    if (!holds(from, bytes) || !holds(to, bytes) || world.streams.count(stream) == 0) return misuse(kInvalidValue);
    if (const int error = entered(); error != 0) return error;
    std::memcpy(at(to), at(from), bytes);
    return 0;
}
int cuMemsetD8Async(unsigned long long to, unsigned char value, std::size_t bytes, void* stream) {
    const Lock lock(mutex);
    if (!holds(to, bytes) || world.streams.count(stream) == 0) return misuse(kInvalidValue);
    if (const int error = entered(); error != 0) return error;
    std::memset(at(to), value, bytes);
    return 0;
}
int cuModuleLoadData(void** module, const void* image) {
    const Lock lock(mutex);
    if (const int error = entered(); error != 0) return error;
    if (image == nullptr) return misuse(kInvalidImage);
    return make(module, world.modules, world.record.modules);
}
int cuModuleUnload(void* module) {
    const Lock lock(mutex);
    return drop(module, world.modules, world.record.modules);
}
int cuModuleGetFunction(void** function, void* module, const char* name) {
    const Lock lock(mutex);
    if (world.modules.count(module) == 0) return misuse(kInvalidHandle);
    if (const int error = entered(); error != 0) return error;
    if (world.parameters.count(name) == 0) return kNotFound;
    *function = &world.functions.emplace(name, 0).first->second;
    return 0;
}
int cuLaunchKernel(void* function, unsigned grid_x, unsigned grid_y, unsigned grid_z, unsigned block_x,
                   unsigned block_y, unsigned block_z, unsigned shared_bytes, void* stream, void** parameters,
                   void** extra) {
    const Lock lock(mutex);
    if (const int error = entered(); error != 0) return error;
    std::string name;
    for (auto& [known, handle] : world.functions)
        if (&handle == function) name = known;
    if (name.empty() || world.streams.count(stream) == 0) return misuse(kInvalidHandle);
    if (grid_x == 0 || grid_y != 1 || grid_z != 1 || block_x == 0 || block_x > 1024 || block_y != 1 || block_z != 1 ||
        shared_bytes != 0 || extra != nullptr)
        return misuse(kInvalidValue);
    StandInCudaRecord& r = world.record;
    ++r.launches;
    std::snprintf(r.function, sizeof(r.function), "%s", name.c_str());
    r.grid = grid_x;
    r.block = block_x;
    r.parameters = 0;
    for (const int bytes : world.parameters[name]) {
        unsigned long long& value = r.parameter[r.parameters];
        value = 0;
        std::memcpy(&value, parameters[r.parameters], static_cast<std::size_t>(bytes < 8 ? bytes : 8));
        ++r.parameters;
    }
    return 0;
}
int cuEventCreate(void** event, unsigned flags) {
    const Lock lock(mutex);
    if (flags != 0) return misuse(kInvalidValue);
    if (const int error = entered(); error != 0) return error;
    return make(event, world.events, world.record.events);
}
int cuEventDestroy_v2(void* event) {
    const Lock lock(mutex);
    return drop(event, world.events, world.record.events);
}
int cuEventRecord(void* event, void* stream) {
    const Lock lock(mutex);
    if (world.events.count(event) == 0 || world.streams.count(stream) == 0) return misuse(kInvalidHandle);
    return entered();
}
int cuEventElapsedTime(float* milliseconds, void* from, void* to) {
    const Lock lock(mutex);
    if (world.events.count(from) == 0 || world.events.count(to) == 0) return misuse(kInvalidHandle);
    *milliseconds = 0.25f;
    return entered();
}

// --- Controls

void stand_in_cuda_reset() {
    const Lock lock(mutex);
    const bool initialised = world.initialised;
    world = World{};
    world.initialised = initialised;
    current = nullptr;
}
void stand_in_cuda_record(StandInCudaRecord* record) {
    const Lock lock(mutex);
    *record = world.record;
}
void stand_in_cuda_set_devices(int count, int major, int minor) {
    const Lock lock(mutex);
    world.devices = count;
    world.major = major;
    world.minor = minor;
}
void stand_in_cuda_set_parameters(const char* function, const int* bytes) {
    const Lock lock(mutex);
    std::vector<int>& sizes = world.parameters[function];
    for (sizes.clear(); *bytes != 0; ++bytes) sizes.push_back(*bytes);
}
void stand_in_cuda_fail(int error) {
    const Lock lock(mutex);
    world.fails_with = error;
}

}  // extern "C"
