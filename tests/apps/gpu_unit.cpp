// The program with ticks on a device: PoCL, which comes with the project's packages.

#include <cmath>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.h"

namespace calot::test {
namespace {

using Json = nlohmann::json;

std::vector<std::string> simulate(const std::string& scene, const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> words{"simulate", scene, "--out", out, "--frames", "png", "--progress", "plain"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST(Gpu, DevicesAreListed) {
    const Outcome outcome = run({"inspect", "--devices", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const Json list = Json::parse(outcome.output);
    ASSERT_FALSE(list.empty()) << "is pocl-opencl-icd installed?";
    for (const Json& device : list)
        for (const char* key :
             {"device", "api", "name", "vendor", "version", "memory_bytes", "compute_units", "is_gpu"})
            EXPECT_TRUE(device.contains(key)) << key;
    const Outcome text = run({"inspect", "--devices"});
    EXPECT_NE(text.output.find(list[0]["name"].get<std::string>()), std::string::npos) << text.output;
}

TEST(Gpu, ARunOnADeviceComesToTheSame) {
    const Folder folder("gpu");
    const std::string scene = folder.write("tiny.toml", kTinyScene);
    const Outcome on_cpu = run(simulate(scene, folder / "cpu", {}));
    ASSERT_EQ(on_cpu.code, 0) << on_cpu.output;
    EXPECT_EQ(on_cpu.output.find("backend"), std::string::npos) << "nothing was wished, nothing is said";
    const Outcome on_gpu = run(simulate(scene, folder / "gpu", {"--backend", "gpu"}));
    ASSERT_EQ(on_gpu.code, 0) << on_gpu.output;
    EXPECT_NE(on_gpu.output.find("calot: backend: GPU: "), std::string::npos) << on_gpu.output;
    const Json a = Json::parse(read_file(folder / "cpu/summary.json")),
               b = Json::parse(read_file(folder / "gpu/summary.json"));
    EXPECT_EQ(a["backend"], "CPU");
    EXPECT_NE(b["backend"].get<std::string>().find("OpenCL"), std::string::npos) << b["backend"];
    EXPECT_EQ(a["ticks"], b["ticks"]);
    EXPECT_LT(std::abs(b["energy_imbalance"].get<double>()), 1e-3);
    EXPECT_TRUE(b["surface"]["closed"].get<bool>());

    // Its recording is one of inputs: it runs anywhere, but is compared bit for bit on the CPU alone.
    EXPECT_EQ(run({"replay", folder / "gpu/recording.calot", "--progress", "none"}).code, 0);
    const Outcome refused = run({"replay", folder / "cpu/recording.calot", "--verify", "--backend", "gpu"});
    EXPECT_EQ(refused.code, 2) << refused.output;
}

TEST(Gpu, AutoSaysWhatItTookAndWhy) {
    const Folder folder("gpu-auto");
    const std::string scene = folder.write("tiny.toml", kTinyScene);
    const Outcome outcome = run(simulate(scene, folder / "out", {"--backend", "auto"}));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const bool says_why = outcome.output.find("backend: CPU: there is no GPU") != std::string::npos ||
                          outcome.output.find("too small for a GPU") != std::string::npos;
    EXPECT_TRUE(says_why) << outcome.output;
    EXPECT_EQ(run({"simulate", scene, "--backend", "gpu", "--device", "1000"}).code, 2);
}

TEST(Gpu, BenchTellsLaunchesAndTransfersApart) {
    const Folder folder("gpu-bench");
    const Outcome outcome = run({"bench", "--backend", "gpu", "--quick", "--suite", "kernels", "--threads", "1",
                                 "--progress", "none", "--json", folder / "b.json", "--html", folder / "b.html"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const Json device = Json::parse(read_file(folder / "b.json"))["device"];
    for (const char* key : {"launch_us", "round_trip_us", "up_GB_per_s", "down_GB_per_s", "copy_GB_per_s"})
        EXPECT_GT(device[key].get<double>(), 0.0) << key;
    ASSERT_GE(device["costs"].size(), 5u);
    for (const Json& cost : device["costs"]) {
        EXPECT_GT(cost["kernels_us"].get<double>(), 0.0) << cost["name"];
        EXPECT_GT(cost["launches"].get<double>(), 0.0) << cost["name"];
        EXPECT_FALSE(cost["by_kernel_us"].empty()) << cost["name"];
    }
    EXPECT_NE(read_file(folder / "b.html").find("On the device"), std::string::npos);
    EXPECT_EQ(run({"bench", "--backend", "gpu", "--suite", "paper"}).code, 2) << "that is the CPU's";
}

}  // namespace
}  // namespace calot::test
