// The CUDA layer against a stand-in for NVIDIA's driver: what it is told, memory, errors. No kernel runs here. And the
// kernels as nvcc compiled them, where it was there when this was built.
#include <dlfcn.h>

#include <cstring>
#include <string_view>
#include <thread>

#include <gtest/gtest.h>

#include "calot/gpu/cuda.h"
#include "calot/gpu/cuda_api.h"
#include "stand_in_cuda.h"
#include "support/paths.h"

namespace calot::gpu {
namespace {

constexpr std::uint8_t kImage[] = {1, 2, 3, 4};
constexpr CudaModule kModules[] = {{"add", kImage}};

/// The stand-in's controls, from the library that the layer loads.
class StandIn {
  public:
    StandIn() {
        std::string why;
        if (cuda::load(CALOT_STAND_IN_CUDA, why) == nullptr) throw std::runtime_error(why);
        void* library = dlopen(CALOT_STAND_IN_CUDA, RTLD_NOW | RTLD_LOCAL);
        auto find = [&](const char* name, auto& function) {
            function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(library, name));
            if (function == nullptr) throw std::runtime_error(name);
        };
        find("stand_in_cuda_reset", reset);
        find("stand_in_cuda_record", record_);
        find("stand_in_cuda_set_devices", set_devices);
        find("stand_in_cuda_set_parameters", set_parameters);
        find("stand_in_cuda_fail", fail);
        reset();
    }
    StandInCudaRecord record() const {
        StandInCudaRecord record;
        record_(&record);
        return record;
    }
    std::shared_ptr<Device> open() const {
        const auto all = cuda_devices(kModules);
        if (all.empty()) throw std::runtime_error("no device");
        return open_cuda(all.front(), kModules);
    }

    decltype(&stand_in_cuda_reset) reset;
    decltype(&stand_in_cuda_set_devices) set_devices;
    decltype(&stand_in_cuda_set_parameters) set_parameters;
    decltype(&stand_in_cuda_fail) fail;

  private:
    decltype(&stand_in_cuda_record) record_;
};

}  // namespace

TEST(Cuda, ListsDevicesThatRunTheKernels) {
    const StandIn stand_in;
    stand_in.set_devices(2, 8, 6);
    const std::vector<DeviceInfo> list = cuda_devices(kModules);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[1].name, "Stand-in 1");
    EXPECT_EQ(list[1].api, Api::cuda);
    EXPECT_EQ(list[1].version, "CUDA 12.4, compute capability 8.6");
    EXPECT_EQ(list[1].memory_bytes, 8u << 20);
    EXPECT_EQ(list[1].compute_units, 108);
    EXPECT_TRUE(list[1].is_gpu);
    EXPECT_TRUE(cuda_devices({}).empty()) << "without kernels";
    stand_in.set_devices(2, 7, 5);
    EXPECT_TRUE(cuda_devices(kModules).empty()) << "older than the kernels";
    EXPECT_EQ(stand_in.record().misuse, 0);
}

TEST(Cuda, KeepsWhatIsWritten) {
    const StandIn stand_in;
    {
        const auto device = stand_in.open();
        DeviceArray<std::int32_t> a(*device, 1000), b(*device, 1000);
        for (const std::int32_t x : a.download(*device)) ASSERT_EQ(x, 0) << "not cleared";
        std::vector<std::int32_t> numbers(1000);
        for (int k = 0; k < 1000; ++k) numbers[static_cast<std::size_t>(k)] = 7 * k;
        a.upload(*device, std::span<const std::int32_t>(numbers));
        device->copy(a.buffer(), b.buffer(), 500 * 4, 0, 500 * 4);
        EXPECT_EQ(a.download(*device), numbers);
        EXPECT_EQ(b.download(*device)[999], numbers[499]);
        EXPECT_EQ(b.download(*device)[499], 0);
        device->fill_zero(b.buffer());
        EXPECT_EQ(b.download(*device)[999], 0);
        const std::vector<std::uint8_t> large(1 << 20, 7);  // too large to be staged
        Buffer more = device->make_buffer(large.size());
        const int waits = stand_in.record().waits;
        device->write(more, large.data(), large.size());
        EXPECT_EQ(stand_in.record().waits, waits + 1) << "the data may be changed as soon as it returns";
        EXPECT_THROW(device->write(more, large.data(), large.size(), 1), DeviceError);
        EXPECT_EQ(device->counters().bytes_up, 4000u + (1u << 20));
        EXPECT_EQ(stand_in.record().buffers, 3);
        std::thread([&] { EXPECT_EQ(a.download(*device), numbers); }).join();  // whatever thread calls
    }
    const StandInCudaRecord end = stand_in.record();
    EXPECT_EQ(end.misuse, 0);
    EXPECT_EQ(end.buffers + end.streams + end.events + end.modules + end.contexts, 0) << "something was left behind";
}

TEST(Cuda, LaunchesWholeGroupsWithTheirArguments) {
    const StandIn stand_in;
    struct Pair {
        std::int32_t a, b;
    };
    const int sizes[] = {8, 4, 4, 8, 0};
    stand_in.set_parameters("add_all", sizes);
    {
        const auto device = stand_in.open();
        device->measure(true);
        const Kernel kernel = device->kernel("add", "add_all");
        DeviceArray<float> data(*device, 100);
        device->launch(kernel, 100, 64, data, -3, 0.5f, Pair{5, 6});
        StandInCudaRecord r = stand_in.record();
        EXPECT_STREQ(r.function, "add_all");
        EXPECT_EQ(r.grid, 2u);
        EXPECT_EQ(r.block, 64u);
        ASSERT_EQ(r.parameters, 4);
        EXPECT_EQ(r.parameter[1], 0xfffffffdu);
        EXPECT_EQ(r.parameter[2], 0x3f000000u);
        EXPECT_EQ(r.parameter[3], 5u | 6ull << 32);
        const std::vector<float> ones(100, 1.0f);
        data.upload(*device, std::span<const float>(ones));
        float seen = 0.0f;  // the stand-in's memory is the host's
        std::memcpy(&seen, reinterpret_cast<const void*>(r.parameter[0]), sizeof(seen));
        EXPECT_EQ(seen, 1.0f) << "the first argument is the buffer's address";
        device->launch(kernel, 0, 64, data, 1, 1.0f, Pair{});
        EXPECT_EQ(stand_in.record().launches, 1) << "nothing to do";
        device->finish();
        EXPECT_DOUBLE_EQ(device->counters().kernel_s_of.at("add_all"), 0.25e-3);
        EXPECT_DOUBLE_EQ(device->counters().transfer_s, 0.25e-3);
        EXPECT_EQ(stand_in.record().events, 0) << "events are not dropped";
        EXPECT_THROW(device->kernel("add", "no_such_kernel"), DeviceError);
        EXPECT_THROW(device->kernel("no such source", "add_all"), DeviceError);
    }
    EXPECT_EQ(stand_in.record().misuse, 0);
}

TEST(Cuda, SaysWhatIsWrong) {
    const StandIn stand_in;
    const int sizes[] = {4, 0};
    stand_in.set_parameters("add_all", sizes);
    const auto device = stand_in.open();
    const Kernel kernel = device->kernel("add", "add_all");
    const auto message_of = [](const auto& act) -> std::string {
        try {
            act();
        } catch (const DeviceError& error) {
            return error.what();
        }
        return "nothing was thrown";
    };
    EXPECT_EQ(message_of([&] { device->make_buffer(9 << 20); }),
              "CUDA, making a buffer of 9437184 bytes: out of memory (CUDA_ERROR_OUT_OF_MEMORY)");
    Buffer kept = device->make_buffer(16);
    stand_in.fail(719);  // the device is lost
    EXPECT_NE(message_of([&] { device->launch(kernel, 1, 1, 1); }).find("CUDA_ERROR_LAUNCH_FAILED"), std::string::npos);
    EXPECT_NE(message_of([&] { device->finish(); }).find("unspecified launch failure"), std::string::npos);
    int x = 0;
    EXPECT_NE(message_of([&] { device->read(kept, &x, 4); }), "nothing was thrown");
    EXPECT_EQ(stand_in.record().misuse, 0);
}

TEST(Cuda, NvccCompiledEverySource) {
    if (cuda_modules().empty()) GTEST_SKIP() << "built without nvcc";
    ASSERT_EQ(cuda_modules().size(), kernel_sources().size());
    for (const KernelSource& source : kernel_sources()) {
        const CudaModule* module = nullptr;
        for (const CudaModule& m : cuda_modules())
            if (std::string_view(m.name) == source.name) module = &m;
        ASSERT_NE(module, nullptr) << source.name;
        ASSERT_GT(module->image.size(), 1000u);
        const std::uint32_t magic = 0xba55ed50;  // of a fat binary
        EXPECT_EQ(std::memcmp(module->image.data(), &magic, 4), 0) << source.name;
        // Names of kernels stand in the ELF images' tables as they are.
        const std::string_view image(reinterpret_cast<const char*>(module->image.data()), module->image.size());
        std::string_view text = source.text;
        int kernels = 0;
        for (std::size_t at = text.find("\nKERNEL void "); at != std::string_view::npos;
             at = text.find("\nKERNEL void ", at + 1)) {
            const std::size_t begin = at + 13, end = text.find('(', begin);
            EXPECT_NE(image.find(text.substr(begin, end - begin)), std::string_view::npos)
                << text.substr(begin, end - begin);
            ++kernels;
        }
        EXPECT_GT(kernels, 0) << source.name;
    }
}

}  // namespace calot::gpu
