// OpenCL 1.2 and newer, through the system's loader of drivers (libOpenCL).

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "calot/gpu/drivers.h"

namespace calot::gpu {

namespace {

/// Writes of up to so many bytes are staged, so that nobody waits for them.
constexpr std::size_t kMostStaged = 256 * 1024;
/// The largest work-group that kernels are launched in.
constexpr std::size_t kMostGroup = 256;
/// Bytes staged at most before the queue is waited for.
constexpr std::size_t kMostStagedTogether = 32 * 1024 * 1024;

const char* name_of(cl_int error) {
    switch (error) {
        case CL_DEVICE_NOT_FOUND:
            return "device not found";
        case CL_DEVICE_NOT_AVAILABLE:
            return "device not available";
        case CL_COMPILER_NOT_AVAILABLE:
            return "compiler not available";
        case CL_MEM_OBJECT_ALLOCATION_FAILURE:
            return "too little device memory";
        case CL_OUT_OF_RESOURCES:
            return "out of resources, or the device is lost";
        case CL_OUT_OF_HOST_MEMORY:
            return "too little host memory";
        case CL_BUILD_PROGRAM_FAILURE:
            return "build failure";
        case CL_INVALID_BUFFER_SIZE:
            return "buffer too large";
        case CL_INVALID_KERNEL_NAME:
            return "no such kernel";
        case CL_INVALID_ARG_INDEX:
            return "no such argument";
        case CL_INVALID_ARG_VALUE:
            return "wrong argument";
        case CL_INVALID_ARG_SIZE:
            return "wrong size of an argument";
        case CL_INVALID_KERNEL_ARGS:
            return "missing arguments";
        case CL_INVALID_WORK_GROUP_SIZE:
            return "work-group too large";
        case CL_INVALID_COMMAND_QUEUE:
            return "the queue is lost";
        case CL_INVALID_CONTEXT:
            return "the context is lost";
        default:
            return "error";
    }
}

void check(cl_int error, const char* what, const std::string& about = "") {
    if (error == CL_SUCCESS) return;
    throw DeviceError(
        fmt::format("OpenCL, {}{}{}: {} ({})", what, about.empty() ? "" : " ", about, name_of(error), error));
}

/// A handle of OpenCL with its owner.
template <class T, cl_int (*release)(T)>
struct Handle {
    T it = nullptr;
    Handle() = default;
    explicit Handle(T handle) : it(handle) {}
    Handle(Handle&& other) noexcept : it(std::exchange(other.it, nullptr)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(it, other.it);
        return *this;
    }
    ~Handle() {
        if (it != nullptr) release(it);
    }
};
using Context = Handle<cl_context, clReleaseContext>;
using Queue = Handle<cl_command_queue, clReleaseCommandQueue>;
using Program = Handle<cl_program, clReleaseProgram>;
using Function = Handle<cl_kernel, clReleaseKernel>;
using Event = Handle<cl_event, clReleaseEvent>;

struct OpenClMemory : Buffer::Memory {
    explicit OpenClMemory(cl_mem memory) : it(memory) {}
    ~OpenClMemory() override { clReleaseMemObject(it); }
    cl_mem it;
};

struct OpenClCode : Kernel::Code {
    Function function;
};

cl_mem memory_of(const Buffer& buffer) {
    return static_cast<const OpenClMemory*>(buffer.memory())->it;
}

std::string text(cl_device_id device, cl_device_info what) {
    std::size_t bytes = 0;
    if (clGetDeviceInfo(device, what, 0, nullptr, &bytes) != CL_SUCCESS || bytes == 0) return "";
    std::string value(bytes, '\0');
    if (clGetDeviceInfo(device, what, bytes, value.data(), nullptr) != CL_SUCCESS) return "";
    value.resize(bytes - 1);
    const std::size_t first = value.find_first_not_of(' '), last = value.find_last_not_of(' ');
    return first == std::string::npos ? "" : value.substr(first, last - first + 1);
}

template <class T>
T number(cl_device_id device, cl_device_info what) {
    T value{};
    return clGetDeviceInfo(device, what, sizeof(value), &value, nullptr) == CL_SUCCESS ? value : T{};
}

std::vector<cl_platform_id> platforms() {
    cl_uint count = 0;
    if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS) return {};
    std::vector<cl_platform_id> list(count);
    return count == 0 || clGetPlatformIDs(count, list.data(), nullptr) != CL_SUCCESS ? std::vector<cl_platform_id>{}
                                                                                     : list;
}

std::vector<cl_device_id> devices_of(cl_platform_id platform) {
    cl_uint count = 0;
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS) return {};
    std::vector<cl_device_id> list(count);
    return count == 0 || clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, list.data(), nullptr) != CL_SUCCESS
               ? std::vector<cl_device_id>{}
               : list;
}

bool usable(cl_device_id device) {
    return number<cl_bool>(device, CL_DEVICE_AVAILABLE) == CL_TRUE &&
           number<cl_bool>(device, CL_DEVICE_COMPILER_AVAILABLE) == CL_TRUE &&
           number<cl_bool>(device, CL_DEVICE_ENDIAN_LITTLE) == CL_TRUE &&
           number<std::size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE) >= kMostGroup &&
           text(device, CL_DEVICE_PROFILE) == "FULL_PROFILE";
}

class OpenClDevice final : public Device {
  public:
    OpenClDevice(const DeviceInfo& info, cl_device_id device) : Device(info), device_(device) {
        cl_int error = CL_SUCCESS;
        context_ = Context(clCreateContext(nullptr, 1, &device_, nullptr, nullptr, &error));
        check(error, "opening", info_.name);
        queue_ = Queue(clCreateCommandQueue(context_.it, device_, CL_QUEUE_PROFILING_ENABLE, &error));
        check(error, "making a queue on", info_.name);
        // Division and roots as IEEE 754 has them, where the device can: results are then those of the CPU.
        const auto floats = number<cl_device_fp_config>(device_, CL_DEVICE_SINGLE_FP_CONFIG);
        if ((floats & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0) options_ = "-cl-fp32-correctly-rounded-divide-sqrt";
        if (info_.has_double) options_ += " -DCALOT_DOUBLE";
    }
    ~OpenClDevice() override { clFinish(queue_.it); }

    void measure(bool on) override {
        finish();
        measures_ = on;
    }

    Buffer make_buffer(std::size_t bytes) override {
        const std::size_t whole = (std::max<std::size_t>(bytes, 1) + 3) / 4 * 4;
        cl_int error = CL_SUCCESS;
        const cl_mem memory = clCreateBuffer(context_.it, CL_MEM_READ_WRITE, whole, nullptr, &error);
        check(error, "making a buffer of", fmt::format("{} bytes", whole));
        Buffer buffer(std::make_unique<OpenClMemory>(memory), bytes);
        zero(memory, whole);
        return buffer;
    }

    void write(Buffer& to, const void* data, std::size_t bytes, std::size_t offset) override {
        if (bytes == 0) return;
        require(offset + bytes <= to.bytes(), "writing beyond a buffer");
        const void* from = data;
        const bool stages = bytes <= kMostStaged;
        if (stages) {
            if (staged_bytes_ + bytes > kMostStagedTogether) finish();
            const auto* first = static_cast<const std::byte*>(data);
            from = staged_.emplace_back(first, first + bytes).data();
            staged_bytes_ += bytes;
        }
        cl_event event = nullptr;
        check(clEnqueueWriteBuffer(queue_.it, memory_of(to), stages ? CL_FALSE : CL_TRUE, offset, bytes, from, 0,
                                   nullptr, watch(&event)),
              "writing");
        note(event, "");
        ++counters_.writes;
        counters_.bytes_up += bytes;
    }

    void read(const Buffer& from, void* data, std::size_t bytes, std::size_t offset) override {
        if (bytes == 0) return;
        require(offset + bytes <= from.bytes(), "reading beyond a buffer");
        cl_event event = nullptr;
        check(clEnqueueReadBuffer(queue_.it, memory_of(from), CL_TRUE, offset, bytes, data, 0, nullptr, watch(&event)),
              "reading");
        note(event, "");
        ++counters_.reads;
        counters_.bytes_down += bytes;
        after_wait();
    }

    void copy(const Buffer& from, Buffer& to, std::size_t bytes, std::size_t from_offset,
              std::size_t to_offset) override {
        if (bytes == 0) return;
        require(from_offset + bytes <= from.bytes() && to_offset + bytes <= to.bytes(), "copying beyond a buffer");
        cl_event event = nullptr;
        check(clEnqueueCopyBuffer(queue_.it, memory_of(from), memory_of(to), from_offset, to_offset, bytes, 0, nullptr,
                                  watch(&event)),
              "copying");
        note(event, "copy");
        ++counters_.launches;
    }

    void fill_zero(Buffer& buffer) override { zero(memory_of(buffer), (buffer.bytes() + 3) / 4 * 4); }

    Kernel kernel(const std::string& source, const std::string& name) override {
        auto found = programs_.find(source);
        if (found == programs_.end()) found = programs_.emplace(source, build(source)).first;
        cl_int error = CL_SUCCESS;
        auto code = std::make_shared<OpenClCode>();
        code->name = name;
        code->function = Function(clCreateKernel(found->second.it, name.c_str(), &error));
        check(error, "finding kernel", name);
        return {code};
    }

    void finish() override {
        check(clFinish(queue_.it), "waiting");
        after_wait();
    }

  protected:
    void enqueue(const Kernel& kernel, std::size_t items, std::size_t group,
                 std::span<const Argument> arguments) override {
        const auto& code = static_cast<const OpenClCode&>(*kernel.code);
        for (cl_uint k = 0; k < arguments.size(); ++k) {
            const Argument& a = arguments[k];
            const cl_mem memory = a.buffer != nullptr ? memory_of(*a.buffer) : nullptr;
            check(a.buffer != nullptr ? clSetKernelArg(code.function.it, k, sizeof(memory), &memory)
                                      : clSetKernelArg(code.function.it, k, a.bytes, a.value),
                  "argument", fmt::format("{} of {}", k, code.name));
        }
        const std::size_t whole = (items + group - 1) / group * group;
        cl_event event = nullptr;
        check(
            clEnqueueNDRangeKernel(queue_.it, code.function.it, 1, nullptr, &whole, &group, 0, nullptr, watch(&event)),
            "running", code.name);
        note(event, code.name);
        ++counters_.launches;
    }

  private:
    struct Watched {
        Event event;
        std::string kernel;  ///< empty for a transfer
    };

    static void require(bool holds, const char* what) {
        if (!holds) throw DeviceError(fmt::format("OpenCL: {}", what));
    }

    Program build(const std::string& source) {
        const char* code = kernel_text(source);
        cl_int error = CL_SUCCESS;
        Program program(clCreateProgramWithSource(context_.it, 1, &code, nullptr, &error));
        check(error, "reading", source);
        error = clBuildProgram(program.it, 1, &device_, options_.c_str(), nullptr, nullptr);
        if (error == CL_SUCCESS) return program;
        std::size_t bytes = 0;
        clGetProgramBuildInfo(program.it, device_, CL_PROGRAM_BUILD_LOG, 0, nullptr, &bytes);
        std::string log(bytes, '\0');
        clGetProgramBuildInfo(program.it, device_, CL_PROGRAM_BUILD_LOG, bytes, log.data(), nullptr);
        throw DeviceError(
            fmt::format("OpenCL, building {}.cl: {} ({})\n{}", source, name_of(error), error, log.c_str()));
    }

    void zero(cl_mem memory, std::size_t bytes) {
        const cl_uint nought = 0;
        check(clEnqueueFillBuffer(queue_.it, memory, &nought, sizeof(nought), 0, bytes, 0, nullptr, nullptr),
              "clearing");
    }

    cl_event* watch(cl_event* event) const { return measures_ ? event : nullptr; }
    void note(cl_event event, const std::string& kernel) {
        if (event != nullptr) watched_.push_back({Event(event), kernel});
    }

    /// Everything enqueued has run: what was kept for it goes.
    void after_wait() {
        staged_.clear();
        staged_bytes_ = 0;
        for (const Watched& w : watched_) {
            cl_ulong start = 0, end = 0;
            check(clGetEventProfilingInfo(w.event.it, CL_PROFILING_COMMAND_START, sizeof(start), &start, nullptr),
                  "timing");
            check(clGetEventProfilingInfo(w.event.it, CL_PROFILING_COMMAND_END, sizeof(end), &end, nullptr), "timing");
            const double seconds = 1e-9 * static_cast<double>(end - start);
            if (w.kernel.empty()) {
                counters_.transfer_s += seconds;
            } else {
                counters_.kernel_s += seconds;
                counters_.kernel_s_of[w.kernel] += seconds;
            }
        }
        watched_.clear();
    }

    cl_device_id device_;
    Context context_;
    Queue queue_;
    std::string options_;
    std::map<std::string, Program> programs_;
    std::vector<std::vector<std::byte>> staged_;
    std::size_t staged_bytes_ = 0;
    bool measures_ = false;
    std::vector<Watched> watched_;
};

}  // namespace

std::vector<DeviceInfo> opencl_devices() {
    std::vector<DeviceInfo> list;
    const std::vector<cl_platform_id> all = platforms();
    for (std::size_t p = 0; p < all.size(); ++p) {
        const std::vector<cl_device_id> some = devices_of(all[p]);
        for (std::size_t d = 0; d < some.size(); ++d) {
            if (!usable(some[d])) continue;
            DeviceInfo& info = list.emplace_back();
            info.api = Api::opencl;
            info.name = text(some[d], CL_DEVICE_NAME);
            info.vendor = text(some[d], CL_DEVICE_VENDOR);
            info.version = text(some[d], CL_DEVICE_VERSION) + ", driver " + text(some[d], CL_DRIVER_VERSION);
            info.memory_bytes = number<cl_ulong>(some[d], CL_DEVICE_GLOBAL_MEM_SIZE);
            info.most_buffer_bytes = number<cl_ulong>(some[d], CL_DEVICE_MAX_MEM_ALLOC_SIZE);
            info.compute_units = static_cast<int>(number<cl_uint>(some[d], CL_DEVICE_MAX_COMPUTE_UNITS));
            info.is_gpu = (number<cl_device_type>(some[d], CL_DEVICE_TYPE) & CL_DEVICE_TYPE_GPU) != 0;
            info.has_double = number<cl_device_fp_config>(some[d], CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
            info.platform = static_cast<int>(p);
            info.index = static_cast<int>(d);
        }
    }
    return list;
}

std::shared_ptr<Device> open_opencl(const DeviceInfo& info) {
    const std::vector<cl_platform_id> all = platforms();
    if (info.platform < 0 || static_cast<std::size_t>(info.platform) >= all.size())
        throw DeviceError("OpenCL: " + info.name + " is gone");
    const std::vector<cl_device_id> some = devices_of(all[static_cast<std::size_t>(info.platform)]);
    if (info.index < 0 || static_cast<std::size_t>(info.index) >= some.size())
        throw DeviceError("OpenCL: " + info.name + " is gone");
    return std::make_shared<OpenClDevice>(info, some[static_cast<std::size_t>(info.index)]);
}

}  // namespace calot::gpu
