#include "calot/gpu/cuda.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "calot/gpu/cuda_api.h"

namespace calot::gpu {

namespace {

/// Writes of up to so many bytes are staged, so that nobody waits for them.
constexpr std::size_t kMostStaged = 256 * 1024;
/// Bytes staged at most before the stream is waited for.
constexpr std::size_t kMostStagedTogether = 32 * 1024 * 1024;

void check(const cuda::Api& api, cuda::Result result, const char* what, const std::string& about = "") {
    if (result == cuda::kSuccess) return;
    const char *name = nullptr, *text = nullptr;
    api.GetErrorName(result, &name);
    api.GetErrorString(result, &text);
    throw DeviceError(fmt::format("CUDA, {}{}{}: {} ({})", what, about.empty() ? "" : " ", about,
                                  text != nullptr ? text : "error", name != nullptr ? name : std::to_string(result)));
}

/// The driver's objects of one device, alive as long as anything is that belongs to them.
struct Driver {
    Driver(const cuda::Api& driver_api, cuda::DeviceId device_id) : api(driver_api), id(device_id) {
        check(api, api.DevicePrimaryCtxRetain(&context, id), "opening device", std::to_string(id));
        enter();
        const cuda::Result result = api.StreamCreate(&stream, cuda::kOwnStream);
        if (result != cuda::kSuccess) api.DevicePrimaryCtxRelease(id);
        check(api, result, "making a stream");
    }
    ~Driver() {
        api.CtxSetCurrent(context);
        api.StreamDestroy(stream);
        api.DevicePrimaryCtxRelease(id);
    }
    Driver(const Driver&) = delete;
    Driver& operator=(const Driver&) = delete;

    /// Whatever thread calls: what follows is for this device.
    void enter() const { check(api, api.CtxSetCurrent(context), "entering the context"); }

    const cuda::Api& api;
    cuda::DeviceId id;
    cuda::Context context = nullptr;
    cuda::Stream stream = nullptr;
};

struct CudaMemory : Buffer::Memory {
    CudaMemory(std::shared_ptr<const Driver> owner, std::size_t bytes) : driver(std::move(owner)) {
        check(driver->api, driver->api.MemAlloc(&it, bytes), "making a buffer of", fmt::format("{} bytes", bytes));
    }
    ~CudaMemory() override {
        driver->api.CtxSetCurrent(driver->context);
        driver->api.MemFree(it);
    }
    std::shared_ptr<const Driver> driver;
    cuda::Pointer it = 0;
};

struct LoadedModule {
    LoadedModule(std::shared_ptr<const Driver> owner, const CudaModule& module) : driver(std::move(owner)) {
        check(driver->api, driver->api.ModuleLoadData(&it, module.image.data()), "loading kernels", module.name);
    }
    ~LoadedModule() {
        driver->api.CtxSetCurrent(driver->context);
        driver->api.ModuleUnload(it);
    }
    LoadedModule(const LoadedModule&) = delete;
    LoadedModule& operator=(const LoadedModule&) = delete;

    std::shared_ptr<const Driver> driver;
    cuda::Module it = nullptr;
};

struct CudaCode : Kernel::Code {
    std::shared_ptr<const LoadedModule> module;
    cuda::Function function = nullptr;
};

class CudaDevice final : public Device {
  public:
    CudaDevice(const DeviceInfo& info, const cuda::Api& api, cuda::DeviceId id, std::span<const CudaModule> modules)
        : Device(info), api_(api), driver_(std::make_shared<const Driver>(api, id)), images_(modules) {}
    ~CudaDevice() override {
        api_.CtxSetCurrent(driver_->context);
        api_.StreamSynchronize(driver_->stream);
        for (const Watched& w : watched_) drop(w);
    }

    void measure(bool on) override {
        finish();
        measures_ = on;
    }

    Buffer make_buffer(std::size_t bytes) override {
        driver_->enter();
        const std::size_t whole = (std::max<std::size_t>(bytes, 1) + 3) / 4 * 4;
        Buffer buffer(std::make_unique<CudaMemory>(driver_, whole), bytes);
        check(api_, api_.MemsetD8Async(pointer_of(buffer), 0, whole, driver_->stream), "clearing");
        return buffer;
    }

    void write(Buffer& to, const void* data, std::size_t bytes, std::size_t offset) override {
        if (bytes == 0) return;
        require(offset + bytes <= to.bytes(), "writing beyond a buffer");
        driver_->enter();
        const void* from = data;
        const bool stages = bytes <= kMostStaged;
        if (stages) {
            if (staged_bytes_ + bytes > kMostStagedTogether) finish();
            const auto* first = static_cast<const std::byte*>(data);
            from = staged_.emplace_back(first, first + bytes).data();
            staged_bytes_ += bytes;
        }
        const Span time = begin("");
        check(api_, api_.MemcpyHtoDAsync(pointer_of(to) + offset, from, bytes, driver_->stream), "writing");
        end(time);
        ++counters_.writes;
        counters_.bytes_up += bytes;
        if (!stages) finish();
    }

    void read(const Buffer& from, void* data, std::size_t bytes, std::size_t offset) override {
        if (bytes == 0) return;
        require(offset + bytes <= from.bytes(), "reading beyond a buffer");
        driver_->enter();
        const Span time = begin("");
        check(api_, api_.MemcpyDtoHAsync(data, pointer_of(from) + offset, bytes, driver_->stream), "reading");
        end(time);
        ++counters_.reads;
        counters_.bytes_down += bytes;
        finish();
    }

    void copy(const Buffer& from, Buffer& to, std::size_t bytes, std::size_t from_offset,
              std::size_t to_offset) override {
        if (bytes == 0) return;
        require(from_offset + bytes <= from.bytes() && to_offset + bytes <= to.bytes(), "copying beyond a buffer");
        driver_->enter();
        const Span time = begin("copy");
        check(api_,
              api_.MemcpyDtoDAsync(pointer_of(to) + to_offset, pointer_of(from) + from_offset, bytes, driver_->stream),
              "copying");
        end(time);
        ++counters_.launches;
    }

    void fill_zero(Buffer& buffer) override {
        driver_->enter();
        check(api_, api_.MemsetD8Async(pointer_of(buffer), 0, (buffer.bytes() + 3) / 4 * 4, driver_->stream),
              "clearing");
    }

    Kernel kernel(const std::string& source, const std::string& name) override {
        driver_->enter();
        auto code = std::make_shared<CudaCode>();
        code->name = name;
        code->module = module_of(source);
        check(api_, api_.ModuleGetFunction(&code->function, code->module->it, name.c_str()), "finding kernel", name);
        return {code};
    }

    void finish() override {
        driver_->enter();
        check(api_, api_.StreamSynchronize(driver_->stream), "waiting");
        after_wait();
    }

  protected:
    void enqueue(const Kernel& kernel, std::size_t items, std::size_t group,
                 std::span<const Argument> arguments) override {
        const auto& code = static_cast<const CudaCode&>(*kernel.code);
        driver_->enter();
        std::array<cuda::Pointer, kMostArguments> pointers{};
        std::array<void*, kMostArguments> parameters{};
        require(arguments.size() <= kMostArguments, "too many arguments");
        for (std::size_t k = 0; k < arguments.size(); ++k) {
            const Argument& a = arguments[k];
            if (a.buffer != nullptr) {
                pointers[k] = pointer_of(*a.buffer);
                parameters[k] = &pointers[k];
            } else {
                parameters[k] = const_cast<void*>(a.value);  // the driver copies it
            }
        }
        const auto groups = static_cast<unsigned int>((items + group - 1) / group);
        const Span time = begin(code.name);
        check(api_,
              api_.LaunchKernel(code.function, groups, 1, 1, static_cast<unsigned int>(group), 1, 1, 0, driver_->stream,
                                parameters.data(), nullptr),
              "running", code.name);
        end(time);
        ++counters_.launches;
    }

  private:
    static constexpr std::size_t kMostArguments = 64;
    struct Watched {
        cuda::Event from = nullptr, to = nullptr;
        std::string kernel;  ///< empty for a transfer
    };
    using Span = std::size_t;  ///< place in watched_, or kUnwatched
    static constexpr Span kUnwatched = ~Span{0};

    static void require(bool holds, const char* what) {
        if (!holds) throw DeviceError(fmt::format("CUDA: {}", what));
    }
    static cuda::Pointer pointer_of(const Buffer& buffer) {
        return static_cast<const CudaMemory*>(buffer.memory())->it;
    }

    std::shared_ptr<const LoadedModule> module_of(const std::string& source) {
        const auto found = modules_.find(source);
        if (found != modules_.end()) return found->second;
        for (const CudaModule& image : images_)
            if (source == image.name)
                return modules_.emplace(source, std::make_shared<const LoadedModule>(driver_, image)).first->second;
        throw DeviceError("CUDA: there are no kernels named " + source);
    }

    Span begin(const std::string& kernel) {
        if (!measures_) return kUnwatched;
        Watched& w = watched_.emplace_back();
        w.kernel = kernel;
        check(api_, api_.EventCreate(&w.from, cuda::kEventWithTime), "timing");
        check(api_, api_.EventCreate(&w.to, cuda::kEventWithTime), "timing");
        check(api_, api_.EventRecord(w.from, driver_->stream), "timing");
        return watched_.size() - 1;
    }
    void end(Span span) {
        if (span != kUnwatched) check(api_, api_.EventRecord(watched_[span].to, driver_->stream), "timing");
    }
    void drop(const Watched& w) const {
        if (w.from != nullptr) api_.EventDestroy(w.from);
        if (w.to != nullptr) api_.EventDestroy(w.to);
    }

    /// Everything enqueued has run: what was kept for it goes.
    void after_wait() {
        staged_.clear();
        staged_bytes_ = 0;
        for (const Watched& w : watched_) {
            float milliseconds = 0.0f;
            check(api_, api_.EventElapsedTime(&milliseconds, w.from, w.to), "timing");
            const double seconds = 1e-3 * static_cast<double>(milliseconds);
            if (w.kernel.empty()) {
                counters_.transfer_s += seconds;
            } else {
                counters_.kernel_s += seconds;
                counters_.kernel_s_of[w.kernel] += seconds;
            }
            drop(w);
        }
        watched_.clear();
    }

    const cuda::Api& api_;
    std::shared_ptr<const Driver> driver_;
    std::span<const CudaModule> images_;
    std::map<std::string, std::shared_ptr<const LoadedModule>> modules_;
    std::vector<std::vector<std::byte>> staged_;
    std::size_t staged_bytes_ = 0;
    bool measures_ = false;
    std::vector<Watched> watched_;
};

/// False when the device cannot run the modules, or says nothing of itself.
bool describe(const cuda::Api& api, int ordinal, DeviceInfo& info) {
    cuda::DeviceId id = 0;
    std::array<char, 256> name{};
    std::size_t bytes = 0;
    int major = 0, minor = 0, driver = 0;
    for (const cuda::Result result :
         {api.DeviceGet(&id, ordinal), api.DeviceGetName(name.data(), static_cast<int>(name.size()), id),
          api.DeviceTotalMem(&bytes, id), api.DeviceGetAttribute(&major, cuda::kCapabilityMajor, id),
          api.DeviceGetAttribute(&minor, cuda::kCapabilityMinor, id),
          api.DeviceGetAttribute(&info.compute_units, cuda::kMultiprocessors, id), api.DriverGetVersion(&driver)})
        if (result != cuda::kSuccess) return false;
    info.api = gpu::Api::cuda;
    info.name = name.data();
    info.vendor = "NVIDIA Corporation";
    info.version = fmt::format("CUDA {}.{}, compute capability {}.{}", driver / 1000, driver % 1000 / 10, major, minor);
    info.memory_bytes = info.most_buffer_bytes = bytes;
    info.is_gpu = info.has_double = true;
    info.index = ordinal;
    return major >= kCudaCapability;
}

}  // namespace

std::vector<DeviceInfo> cuda_devices(std::span<const CudaModule> modules) {
    std::vector<DeviceInfo> list;
    std::string why;
    const cuda::Api* api = modules.empty() ? nullptr : cuda::load("", why);
    int count = 0;
    if (api == nullptr || api->DeviceGetCount(&count) != cuda::kSuccess) return list;
    for (int ordinal = 0; ordinal < count; ++ordinal) {
        DeviceInfo info;
        if (describe(*api, ordinal, info)) list.push_back(info);
    }
    return list;
}

std::shared_ptr<Device> open_cuda(const DeviceInfo& info, std::span<const CudaModule> modules) {
    std::string why;
    const cuda::Api* api = cuda::load("", why);
    if (api == nullptr) throw DeviceError("CUDA: " + why);
    cuda::DeviceId id = 0;
    check(*api, api->DeviceGet(&id, info.index), "finding", info.name);
    return std::make_shared<CudaDevice>(info, *api, id, modules);
}

}  // namespace calot::gpu
