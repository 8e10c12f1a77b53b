// Tasks, scores, sessions, debriefs and studies as people use them: the real program, killed for real.

#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "calot/simulation/recording.h"

namespace calot::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kTask = R"([task]
title = "Tiny task"
goal = "Burn."
scene = "tiny.toml"
[[score]]
metric = "fat_removed_m3"
weight = 3
worst = 0
best = 50
tip = "burn more"
[[score]]
metric = "activation_s"
weight = 1
worst = 0.2
best = 0
tip = "burn less"
[[score]]
metric = "duct_exposed"
weight = 1
worst = 0
best = 100
)";

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

struct Desk {
    explicit Desk(const std::string& name) : folder(name) {
        scene = folder.write("tiny.toml", kTinyScene);
        task = folder.write("task.toml", kTask);
        data = folder / "data";
    }
    Folder folder;
    std::string scene, task, data;
};

TEST(Training, TasksAndMetricsAreListed) {
    const Outcome tasks = run({"tasks"});
    EXPECT_EQ(tasks.code, 0);
    EXPECT_TRUE(contains(tasks.output, "Dissect Calot's triangle"));
    const Outcome metrics = run({"tasks", "--metrics"});
    EXPECT_EQ(metrics.code, 0);
    EXPECT_TRUE(contains(metrics.output, "hook_smoothness"));
    EXPECT_TRUE(contains(metrics.output, "spectral arc length"));
}

TEST(Training, AScriptAndItsRecordingScoreAlike) {
    const Desk desk("score");
    const Outcome simulated =
        run({"simulate", desk.scene, "--task", desk.task, "--frames", "none", "--out", desk.folder / "out"});
    ASSERT_EQ(simulated.code, 0) << simulated.output;
    EXPECT_TRUE(contains(simulated.output, "Tiny task: "));
    EXPECT_TRUE(contains(simulated.output, "not in this scene"));
    const Json summary = Json::parse(read_file(desk.folder / "out/summary.json"));
    const Outcome scored = run({"score", desk.folder / "out/recording.calot", "--task", desk.task, "--json"});
    ASSERT_EQ(scored.code, 0) << scored.output;
    EXPECT_EQ(Json::parse(scored.output), summary["score"]);
    EXPECT_GT(summary["score"]["points"].get<double>(), 0.0);
    EXPECT_GT(summary["score"]["metrics"]["fat_removed_m3"]["value"].get<double>(), 0.0);
    EXPECT_TRUE(contains(read_file(desk.folder / "out/report.html"), "Tiny task"));
}

TEST(Training, ASessionFromStartToStudy) {
    const Desk desk("session");
    const Outcome first = run({"simulate", desk.scene, "--session", "--task", desk.task, "--trainee", "A", "--data",
                               desk.data, "--frames", "png", "--progress", "plain"});
    ASSERT_EQ(first.code, 0) << first.output;
    EXPECT_TRUE(contains(first.output, "session 1 is stored"));
    const std::string page = read_file(desk.data + "/sessions/000001/debrief.html");
    EXPECT_TRUE(contains(page, "Tiny task"));
    EXPECT_TRUE(contains(page, "burn more"));
    EXPECT_TRUE(contains(page, "data:image/jpeg;base64,"));
    EXPECT_TRUE(contains(page, "var frames=["));
    EXPECT_FALSE(contains(page, "http://"));
    ASSERT_EQ(run({"simulate", desk.scene, "--session", "--task", desk.task, "--trainee", "B <b>", "--data", desk.data,
                   "--frames", "none", "--progress", "none"})
                  .code,
              0);

    const Outcome listed = run({"sessions", "--data", desk.data});
    EXPECT_TRUE(contains(listed.output, "B <b>")) << listed.output;
    EXPECT_EQ(run({"questionnaire", "2", "--data", desk.data, "--answers", "1,2,3,4,5,-,1,2,3,4,5,5", "--remark",
                   "a \"remark\""})
                  .code,
              0);
    const Outcome refused = run({"questionnaire", "2", "--data", desk.data, "--answers", "1,2,6"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(contains(refused.output, "from 1 to 5")) << refused.output;

    const Outcome studied =
        run({"study", "--data", desk.data, "--csv", desk.folder / "s.csv", "--html", desk.folder / "s.html"});
    ASSERT_EQ(studied.code, 0) << studied.output;
    EXPECT_TRUE(contains(studied.output, "2 sessions, 1 with a questionnaire"));
    const std::string csv = read_file(desk.folder / "s.csv");
    EXPECT_TRUE(contains(csv, ",\"a \"\"remark\"\"\"\r\n")) << csv;
    const std::string html = read_file(desk.folder / "s.html");
    EXPECT_TRUE(contains(html, "B &lt;b&gt;"));
    EXPECT_FALSE(contains(html, "<b>\xC2\xB7"));
    // The answers show in the debrief that is written anew.
    ASSERT_EQ(run({"debrief", "2", "--data", desk.data, "--frames", "0", "--quiet"}).code, 0);
    EXPECT_TRUE(contains(read_file(desk.data + "/sessions/000002/debrief.html"), "a &quot;remark&quot;"));
}

TEST(Training, ASessionGoesOnFromAMoment) {
    const Desk desk("continue");
    ASSERT_EQ(
        run({"simulate", desk.scene, "--session", "--task", desk.task, "--data", desk.data, "--frames", "none"}).code,
        0);
    const Outcome more = run({"continue", "1", "--from", "0.03", "--data", desk.data, "--frames", "0"});
    ASSERT_EQ(more.code, 0) << more.output;
    const std::string one = desk.data + "/sessions/000001/", two = desk.data + "/sessions/000002/";
    // The script goes on as it did: the same inputs, the same score.
    EXPECT_EQ(Json::parse(read_file(one + "score.json")), Json::parse(read_file(two + "score.json")));
    EXPECT_EQ(run({"replay", two + "recording.calot", "--verify"}).code, 0);
    // Run again from a moment, with pictures' worth of output: a recording that stands on its own.
    const std::string late = desk.folder / "late";
    const Outcome replayed = run({"replay", one + "recording.calot", "--from", "0.03", "--verify", "--frames", "none",
                                  "--out", late});
    EXPECT_EQ(replayed.code, 0) << replayed.output;
    EXPECT_TRUE(contains(replayed.output, "verified")) << replayed.output;
    EXPECT_EQ(run({"replay", late + "/recording.calot", "--verify"}).code, 0);
    EXPECT_EQ(run({"replay", one + "recording.calot", "--from", "7"}).code, 2);
    const Outcome listed = run({"sessions", "--data", desk.data});
    EXPECT_TRUE(contains(listed.output, "continues 1 from 0.0 s")) << listed.output;
    EXPECT_EQ(run({"continue", "1", "--from", "7", "--data", desk.data}).code, 2);
}

TEST(Training, KilledInMidSessionItLosesLessThanASecond) {
    const Desk desk("kill");
    Program program({"simulate", desk.scene, "--session", "--task", desk.task, "--data", desk.data, "--duration",
                     "3000", "--frames", "none", "--progress", "none"});
    const std::string recording = desk.data + "/sessions/000001/recording.calot";
    const auto begun = std::chrono::steady_clock::now();
    std::error_code error;
    while (!(fs::file_size(recording, error) > 20'000 && !error)) {
        ASSERT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(100));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    program.signal(SIGKILL);
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    ASSERT_EQ(program.wait().code, 128 + SIGKILL);
    struct stat status {};
    ASSERT_EQ(::stat(recording.c_str(), &status), 0);
    const double silent_s = static_cast<double>(now.tv_sec - status.st_mtim.tv_sec) +
                            1e-9 * static_cast<double>(now.tv_nsec - status.st_mtim.tv_nsec);
    EXPECT_LT(silent_s, 1.0);  // what was not yet written is younger than this

    const std::int64_t kept = static_cast<std::int64_t>(simulation::read_recording(recording).inputs.size());
    EXPECT_GT(kept, 500);
    const Outcome listed = run({"sessions", "--data", desk.data});
    ASSERT_EQ(listed.code, 0);
    EXPECT_TRUE(contains(listed.output, "session 1 had been cut off")) << listed.output;
    EXPECT_TRUE(contains(listed.output, "recovered")) << listed.output;
    EXPECT_FALSE(contains(run({"sessions", "--data", desk.data}).output, "had been cut off"));
    const Outcome replayed = run({"replay", recording, "--verify"});
    EXPECT_EQ(replayed.code, 0) << replayed.output;
    // Its debrief tells how far it came, and enters its points.
    ASSERT_EQ(run({"debrief", "1", "--data", desk.data, "--frames", "0", "--quiet"}).code, 0);
    EXPECT_TRUE(contains(read_file(desk.data + "/sessions/000001/debrief.html"), "was cut off"));
}

TEST(Training, MistakesAreToldWithTheirMend) {
    const Desk desk("mistakes");
    const auto complains = [](const std::vector<std::string>& arguments, const std::string& part) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << outcome.output;
        EXPECT_TRUE(contains(outcome.output, part)) << outcome.output;
    };
    complains({"simulate", desk.scene, "--task", "disect", "--out", desk.folder / "o"}, "did you mean 'dissect'?");
    EXPECT_FALSE(fs::exists(desk.folder / "o"));
    complains({"simulate", desk.scene, "--task", desk.scene, "--out", desk.folder / "o"}, "no table [task]");
    complains({"sessions", "--data", "/proc/calot"}, "--data");
    complains({"debrief", "9", "--data", desk.data}, "there is no session 9");
    complains({"debrief", desk.folder / "none.calot"}, "cannot open the recording");
    complains({"score", desk.scene, "--task", desk.task}, "not a recording");
    complains({"simulate", desk.scene, "--trainee", "A"}, "--session");
    const std::string broken = desk.folder.write("calot.sqlite", std::string(3000, 'x'));
    complains({"study", "--data", desk.folder.path().string()}, "not a database");
    const Outcome empty = run({"study", "--data", desk.data});
    EXPECT_EQ(empty.code, 0);
    EXPECT_TRUE(contains(empty.output, "0 sessions"));
    EXPECT_TRUE(contains(run({"sessions", "--data", desk.data}).output, "no sessions"));
}

}  // namespace
}  // namespace calot::test
