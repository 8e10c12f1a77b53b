// The device layer: memory, transfers, errors, and prefix sums as the first kernels.

#include <random>

#include "calot/gpu/arrays.h"
#include "calot/gpu/scan.h"
#include "gpu/rig.h"

namespace calot::gpu {
namespace {

TEST(Device, DescribesItself) {
    const auto device = test_device();
    EXPECT_FALSE(device->info().name.empty());
    EXPECT_FALSE(device->info().version.empty());
    EXPECT_GT(device->info().memory_bytes, std::uint64_t{1} << 28);
    EXPECT_GE(device->info().compute_units, 1);
}

TEST(Device, KeepsWhatIsWritten) {
    const auto device = test_device();
    DeviceArray<std::int32_t> a(*device, 1000), b(*device, 1000);
    for (const std::int32_t x : a.download(*device)) EXPECT_EQ(x, 0);
    std::vector<std::int32_t> numbers(1000);
    for (int k = 0; k < 1000; ++k) numbers[static_cast<std::size_t>(k)] = 7 * k - 3000;
    std::vector<std::int32_t> given = numbers;
    a.upload(*device, std::span<const std::int32_t>(given));
    given.assign(1000, -1);  // a write has taken its data when it returns
    device->copy(a.buffer(), b.buffer(), 500 * 4, 0, 500 * 4);
    EXPECT_EQ(a.download(*device), numbers);
    const std::vector<std::int32_t> moved = b.download(*device);
    for (std::size_t k = 0; k < 1000; ++k) EXPECT_EQ(moved[k], k < 500 ? 0 : numbers[k - 500]);
    device->fill_zero(b.buffer());
    for (const std::int32_t x : b.download(*device)) EXPECT_EQ(x, 0);
    const Counters& counters = device->counters();
    EXPECT_EQ(counters.bytes_up, 4000u);
    EXPECT_EQ(counters.bytes_down, 4u * 4000u);
    EXPECT_EQ(counters.launches, 1u);
}

TEST(Device, SaysWhatIsWrong) {
    const auto device = test_device();
    EXPECT_THROW(device->kernel("no such source", "f"), DeviceError);
    EXPECT_THROW(device->kernel("scan", "no_such_kernel"), DeviceError);
    DeviceArray<std::int32_t> small(*device, 4);
    std::array<std::int32_t, 8> numbers{};
    EXPECT_THROW(small.upload(*device, std::span<const std::int32_t>(numbers)), DeviceError);
    EXPECT_THROW(small.download(*device, std::span<std::int32_t>(numbers)), DeviceError);
    EXPECT_THROW(device->make_buffer(std::size_t{1} << 50), DeviceError);  // a petabyte
}

TEST(Device, BuildsEverySource) {
    const auto device = test_device();
    ASSERT_GE(kernel_sources().size(), 1u);
    for (const KernelSource& source : kernel_sources()) {
        // A name that no source has: the source is built all the same, and a failure to build says so.
        try {
            device->kernel(source.name, "no_such_kernel");
        } catch (const DeviceError& error) {
            EXPECT_NE(std::string(error.what()).find("no such kernel"), std::string::npos) << error.what();
        }
    }
}

TEST(Device, TakesTimes) {
    const auto device = test_device();
    device->measure(true);
    Scan scan(device, 4096);
    DeviceArray<std::int32_t> numbers(*device, 4096), total(*device, 1);
    scan.exclusive(numbers, 4096, total);
    device->finish();
    EXPECT_GT(device->counters().kernel_s, 0.0);
    EXPECT_EQ(device->counters().kernel_s_of.count("scan_sums"), 1u);
    EXPECT_EQ(device->counters().launches, 3u);
}

TEST(Scan, AddsWhatLiesBefore) {
    const auto device = test_device();
    for (const std::int64_t count : {1, 255, 256, 257, 70000}) {
        std::mt19937 random(7);
        std::vector<std::int32_t> numbers(static_cast<std::size_t>(count)), expected(numbers.size());
        std::int32_t sum = 0;
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            numbers[k] = static_cast<std::int32_t>(random() % 13);
            expected[k] = sum;
            sum += numbers[k];
        }
        Scan scan(device, count);
        DeviceArray<std::int32_t> on_device(*device, count), total(*device, 1);
        on_device.upload(*device, std::span<const std::int32_t>(numbers));
        scan.exclusive(on_device, count, total);
        EXPECT_EQ(on_device.download(*device), expected) << count;
        EXPECT_EQ(total.download(*device)[0], sum) << count;
    }
}

TEST(Scan, ListsBits) {
    const auto device = test_device();
    BitArray bits(50000);
    std::vector<std::int32_t> expected;
    std::mt19937 random(11);
    for (std::int32_t k = 0; k < 50000; ++k)
        if (random() % 9 == 0 || k == 49999) {
            bits.set(k);
            expected.push_back(k);
        }
    DeviceArray<std::uint32_t> words(*device, words_of(bits.size()));
    words.upload(*device, words_of(static_cast<const BitArray&>(bits)));
    Scan scan(device, words.size());
    for (const std::size_t room : {expected.size() + 5, std::size_t{100}}) {
        DeviceArray<std::int32_t> list(*device, static_cast<std::int64_t>(room)), total(*device, 1);
        scan.list_bits(words, words.size(), list, total);
        EXPECT_EQ(total.download(*device)[0], static_cast<std::int32_t>(expected.size()));
        const std::vector<std::int32_t> got = list.download(*device);
        for (std::size_t k = 0; k < std::min(room, expected.size()); ++k) ASSERT_EQ(got[k], expected[k]) << k;
    }
}

}  // namespace
}  // namespace calot::gpu
