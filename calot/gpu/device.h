#pragma once
// A device that computes, whatever its driver: memory, kernels, an in-order queue.
//
// Kernels are written once (kernels/*.cl, kernels/language.h) and embedded in the library as text; a device builds them
// at run time. What is enqueued runs in order and nobody waits for it; read() and finish() wait. A device and what
// belongs to it is used by one thread at a time. What goes wrong is thrown as a DeviceError: nothing of a device's
// memory can be trusted afterwards.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace calot::gpu {

enum class Api { opencl, cuda };

/// A device as its driver describes it.
struct DeviceInfo {
    Api api = Api::opencl;
    std::string name, vendor, version;  ///< version of driver and language
    std::uint64_t memory_bytes = 0;
    std::uint64_t most_buffer_bytes = 0;  ///< of one buffer
    int compute_units = 0;
    bool is_gpu = false;
    bool has_double = true;       ///< computes in double precision; kernels use it for little
    int platform = 0, index = 0;  ///< in the driver's lists
};

/// Every usable device, GPUs first. Empty where there is no driver; never throws.
std::vector<DeviceInfo> devices();

/// Lost device, too little memory, a kernel that does not build: what() says which, with the build log.
class DeviceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A piece of a device's memory, freed with its last owner.
class Buffer {
  public:
    /// What a driver keeps of it.
    struct Memory {
        virtual ~Memory() = default;
    };

    Buffer() = default;
    Buffer(std::unique_ptr<Memory> memory, std::size_t bytes) : memory_(std::move(memory)), bytes_(bytes) {}
    std::size_t bytes() const { return bytes_; }
    Memory* memory() const { return memory_.get(); }

  private:
    std::unique_ptr<Memory> memory_;
    std::size_t bytes_ = 0;
};

/// A function of a kernel source, built for a device.
struct Kernel {
    struct Code {
        virtual ~Code() = default;
        std::string name;
    };
    std::shared_ptr<Code> code;
};

/// An argument of a launch: a buffer or the bytes of a value.
struct Argument {
    const Buffer* buffer = nullptr;
    const void* value = nullptr;
    std::size_t bytes = 0;
};
inline Argument argument(const Buffer& buffer) {
    return {&buffer, nullptr, 0};
}
/// 32-bit numbers and structs of them (kernels/types.h).
template <class T, class = std::enable_if_t<std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0>>
Argument argument(const T& value) {
    return {nullptr, &value, sizeof(T)};
}

/// What went over the bus and what ran, since the last reset.
struct Counters {
    std::uint64_t launches = 0, writes = 0, reads = 0;
    std::uint64_t bytes_up = 0, bytes_down = 0;
    // Only while Device::measure(true): by the device's own clock.
    double transfer_s = 0.0, kernel_s = 0.0;
    std::map<std::string, double> kernel_s_of;  ///< by kernel
};

class Device {
  public:
    virtual ~Device() = default;
    /// Throws a DeviceError when the device cannot be used.
    static std::shared_ptr<Device> open(const DeviceInfo& info);

    const DeviceInfo& info() const { return info_; }
    Counters& counters() { return counters_; }
    /// Takes times of everything enqueued from now on; costs some of it.
    virtual void measure(bool on) = 0;

    /// Zeroed; of at least one byte.
    virtual Buffer make_buffer(std::size_t bytes) = 0;
    /// The data may be changed as soon as it returns.
    virtual void write(Buffer& to, const void* data, std::size_t bytes, std::size_t offset = 0) = 0;
    /// Waits for everything enqueued so far.
    virtual void read(const Buffer& from, void* data, std::size_t bytes, std::size_t offset = 0) = 0;
    virtual void copy(const Buffer& from, Buffer& to, std::size_t bytes, std::size_t from_offset = 0,
                      std::size_t to_offset = 0) = 0;
    virtual void fill_zero(Buffer& buffer) = 0;

    /// Function `name` of kernels/`source`.cl; the source is built when it is first asked for.
    virtual Kernel kernel(const std::string& source, const std::string& name) = 0;
    /// Runs a kernel for at least `items` work-items in groups of `group`, in whole groups. Arguments: Buffers,
    /// DeviceArrays, 32-bit numbers, structs.
    template <class... Arguments>
    void launch(const Kernel& kernel, std::int64_t items, int group, const Arguments&... arguments) {
        const Argument list[] = {argument(arguments)...};
        if (items > 0) enqueue(kernel, static_cast<std::size_t>(items), static_cast<std::size_t>(group), list);
    }
    virtual void finish() = 0;

  protected:
    explicit Device(DeviceInfo info) : info_(std::move(info)) {}
    virtual void enqueue(const Kernel& kernel, std::size_t items, std::size_t group,
                         std::span<const Argument> arguments) = 0;

    DeviceInfo info_;
    Counters counters_;
};

/// An array of 32-bit numbers or bytes on a device.
template <class T>
class DeviceArray {
  public:
    DeviceArray() = default;
    DeviceArray(Device& device, std::int64_t size)
        : buffer_(device.make_buffer(static_cast<std::size_t>(size) * sizeof(T))), size_(size) {}

    std::int64_t size() const { return size_; }
    const Buffer& buffer() const { return buffer_; }
    Buffer& buffer() { return buffer_; }

    void upload(Device& device, std::span<const T> data, std::int64_t first = 0) {
        device.write(buffer_, data.data(), data.size_bytes(), static_cast<std::size_t>(first) * sizeof(T));
    }
    void download(Device& device, std::span<T> data, std::int64_t first = 0) const {
        device.read(buffer_, data.data(), data.size_bytes(), static_cast<std::size_t>(first) * sizeof(T));
    }
    std::vector<T> download(Device& device) const {
        std::vector<T> data(static_cast<std::size_t>(size_));
        download(device, std::span<T>(data));
        return data;
    }

  private:
    Buffer buffer_;
    std::int64_t size_ = 0;
};
template <class T>
Argument argument(const DeviceArray<T>& array) {
    return argument(array.buffer());
}

/// A kernel source as it was embedded, with what it includes.
struct KernelSource {
    const char* name;
    const char* text;
};
std::span<const KernelSource> kernel_sources();
/// Text of a source; throws a DeviceError when there is none of that name.
const char* kernel_text(const std::string& name);

}  // namespace calot::gpu
