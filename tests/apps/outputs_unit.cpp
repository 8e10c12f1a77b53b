// What a run writes: complete, readable, and never at the cost of what was there.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "support/paths.h"

namespace calot::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> quick(const std::string& scene, const std::string& out) {
    return {"simulate", scene, "--out", out, "--frames", "none", "--progress", "plain", "--threads", "1"};
}

TEST(Outputs, SummaryHoldsWhatItPromises) {
    const Folder folder("summary");
    const Outcome outcome = run(quick(folder.write("tiny.toml", kTinyScene), folder / "out"));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const auto j = nlohmann::json::parse(read_file(folder / "out/summary.json"));
    for (const char* key : {"scene",
                            "version",
                            "seed",
                            "duration_s",
                            "ticks",
                            "threads",
                            "phyxels_initial",
                            "phyxels_removed",
                            "hexels_initial",
                            "hexels_removed",
                            "links_severed",
                            "volume_removed_m3",
                            "max_temperature_K",
                            "energy_J",
                            "energy_imbalance",
                            "force_N",
                            "surface",
                            "injuries",
                            "state_hash",
                            "wall_s",
                            "realtime_factor",
                            "tick_us",
                            "stages_us"})
        EXPECT_TRUE(j.contains(key)) << key;
    for (const char* key : {"delivered", "stored", "latent", "gas", "surface", "perfusion", "outflow"})
        EXPECT_TRUE(j["energy_J"].contains(key)) << key;
    EXPECT_EQ(j["ticks"], 60);
    EXPECT_GT(j["hexels_removed"], 0);
    EXPECT_TRUE(j["surface"]["closed"]);
    constexpr double kHexel_m3 = 0.6e-3 * 0.6e-3 * 0.6e-3, kRounding = 1e-15;
    EXPECT_NEAR(j["volume_removed_m3"].get<double>(), j["hexels_removed"].get<double>() * kHexel_m3, kRounding);
    constexpr double kBudget = 1e-3;  // of the energy delivered
    EXPECT_LT(std::abs(j["energy_imbalance"].get<double>()), kBudget);
}

TEST(Outputs, TimelineIsATable) {
    const Folder folder("timeline");
    ASSERT_EQ(run(quick(folder.write("tiny.toml", kTinyScene), folder / "out")).code, 0);
    std::istringstream lines(read_file(folder / "out/timeline.csv"));
    const auto columns = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    std::string header, line;
    std::getline(lines, header);
    EXPECT_EQ(header.rfind("time_s,tip_x_m", 0), 0u);
    int rows = 0;
    for (; std::getline(lines, line); ++rows) EXPECT_EQ(columns(line), columns(header)) << line;
    EXPECT_EQ(rows, 7);  // every 10 ms, and the end
}

TEST(Outputs, ReportStandsAlone) {
    const Folder folder("report");
    ASSERT_EQ(run(quick(folder.write("tiny.toml", kTinyScene), folder / "out")).code, 0);
    const std::string report = read_file(folder / "out/report.html");
    for (const char* word : {"<svg", "What Calot is", "Force on the hook", "</html>", "summary.json"})
        EXPECT_NE(report.find(word), std::string::npos) << word;
    for (const char* word : {"src=\"http", "<script", "nan", "inf\""})
        EXPECT_EQ(report.find(word), std::string::npos) << word;
    EXPECT_TRUE(fs::exists(folder / "out/surface.pvd"));
    EXPECT_FALSE(fs::is_empty(folder / "out/surface"));
}

TEST(Outputs, StillsAndVideo) {
    const Folder folder("frames");
    const Outcome outcome =
        run({"simulate", folder.write("tiny.toml", kTinyScene), "--out", folder / "out", "--frames", "video"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const auto j = nlohmann::json::parse(read_file(folder / "out/summary.json"));
    if (j["stills"].empty()) GTEST_SKIP() << "no OpenGL here: " << j["notes"];
    EXPECT_EQ(j["stills"].size(), 2u);
    for (const auto& still : j["stills"])
        EXPECT_EQ(read_file(folder / ("out/" + still.get<std::string>())).substr(1, 3), "PNG");
    EXPECT_NE(read_file(folder / "out/report.html").find("data:image/png;base64,iVBOR"), std::string::npos);
    if (j["video"] != "") {
        EXPECT_EQ(read_file(folder / "out/dissection.mp4").substr(4, 4), "ftyp");
    }
}

TEST(Outputs, WithoutFfmpegThereIsANoteAndNoVideo) {
    const Folder folder("no_ffmpeg");
    const std::string scene = folder.write("tiny.toml", kTinyScene);
    const std::string path = std::getenv("PATH") ? std::getenv("PATH") : "";
    ::setenv("PATH", folder.path().c_str(), 1);
    const Outcome outcome = run({"simulate", scene, "--out", folder / "out", "--frames", "video"});
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("there is no ffmpeg"), std::string::npos) << outcome.output;
    EXPECT_FALSE(fs::exists(folder / "out/dissection.mp4"));
}

TEST(Outputs, AreNotReplacedUnasked) {
    const Folder folder("force");
    const std::string scene = folder.write("tiny.toml", kTinyScene), out = folder / "out";
    ASSERT_EQ(run(quick(scene, out)).code, 0);
    std::ofstream(out + "/mark") << "old";
    const Outcome refused = run(quick(scene, out));
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.output.find("--force replaces it"), std::string::npos) << refused.output;
    EXPECT_TRUE(fs::exists(out + "/mark"));
    auto forced = quick(scene, out);
    forced.push_back("--force");
    EXPECT_EQ(run(forced).code, 0);
    EXPECT_FALSE(fs::exists(out + "/mark"));
    const auto entries = std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
    EXPECT_EQ(entries, 2) << "something temporary is left beside the output";
}

TEST(Outputs, ForceReplacesOnlyWhatCalotWrote) {
    const Folder folder("foreign");
    fs::create_directories(folder / "thesis");
    std::ofstream(folder / "thesis/chapter1.txt") << "precious";
    auto arguments = quick(folder.write("tiny.toml", kTinyScene), folder / "thesis");
    arguments.push_back("--force");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.output.find("not an output of Calot"), std::string::npos) << outcome.output;
    EXPECT_EQ(read_file(folder / "thesis/chapter1.txt"), "precious");
}

TEST(Outputs, AFullDeviceIsTold) {
    if (!fs::exists("/dev/full")) GTEST_SKIP();
    const Folder folder("full");
    const std::string command = std::string(CALOT_PROGRAM) + " scene --defaults >/dev/full 2>" + folder / "error";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
    EXPECT_NE(read_file(folder / "error").find("cannot write"), std::string::npos);
}

/// Waits until a run has written so much of its timeline.
void wait_for_rows(const Folder& folder, std::uintmax_t bytes) {
    for (int wait = 0; wait < 2000; ++wait) {
        for (const auto& entry : fs::directory_iterator(folder.path())) {
            std::error_code error;
            if (fs::file_size(entry.path() / "timeline.csv", error) > bytes && !error) return;
        }
        ::usleep(5000);
    }
}

TEST(Interrupt, KeepsWhatWasWritten) {
    for (int number : {SIGINT, SIGTERM}) {
        const Folder folder("interrupt");
        auto arguments = quick(folder.write("tiny.toml", kTinyScene), folder / "out");
        arguments.insert(arguments.end(), {"--duration", "3000"});
        Program program(arguments);
        wait_for_rows(folder, 2000);
        program.signal(number);
        const Outcome outcome = program.wait();
        EXPECT_EQ(outcome.code, 130) << outcome.output;
        EXPECT_NE(outcome.output.find("interrupted after"), std::string::npos) << outcome.output;
        const auto j = nlohmann::json::parse(read_file(folder / "out/summary.json"));
        EXPECT_TRUE(j["interrupted"]);
        EXPECT_GT(j["ticks"], 0);
        const Outcome replayed = run({"replay", folder / "out/recording.calot", "--verify", "--progress", "none"});
        EXPECT_EQ(replayed.code, 0) << replayed.output;
    }
}

TEST(Interrupt, ARecordingSurvivesAKill) {
    const Folder folder("kill");
    auto arguments = quick(folder.write("tiny.toml", kTinyScene), folder / "out");
    arguments.insert(arguments.end(), {"--duration", "3000"});
    Program program(arguments);
    wait_for_rows(folder, 30000);  // more than a second's rows
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait().code, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(folder / "out"));
    std::string recording;
    for (const auto& entry : fs::directory_iterator(folder.path()))
        if (entry.is_directory()) recording = (entry.path() / "recording.calot").string();
    const Outcome replayed = run({"replay", recording, "--verify"});
    EXPECT_EQ(replayed.code, 0) << replayed.output;
    EXPECT_NE(replayed.output.find("was cut off"), std::string::npos) << replayed.output;
}

}  // namespace
}  // namespace calot::test
