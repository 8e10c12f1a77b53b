// Task files, scores and limits.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "calot/base/error.h"
#include "calot/training/result.h"
#include "setups.h"
#include "support/paths.h"

namespace calot::training {
namespace {

std::string complaint(const std::string& text) {
    try {
        parse_task(text, "test.toml");
    } catch (const InputError& error) {
        return error.describe();
    }
    return "";
}

TEST(Task, ReadsWhatItSaysInTheUnitsShown) {
    const Task task = parse_task(test::kTaskText, "folder/test.toml");
    EXPECT_EQ(task.name, "test");
    EXPECT_EQ(task.scene, "folder/coarse.toml");
    ASSERT_EQ(task.score.size(), 2u);
    EXPECT_DOUBLE_EQ(task.score[0].best, 20e-9);
    ASSERT_EQ(task.targets.size(), 1u);
    EXPECT_DOUBLE_EQ(task.targets[0].radius_m, 0.02);
    ASSERT_EQ(task.limits.size(), 1u);
    EXPECT_DOUBLE_EQ(*task.limits[0].bound.at_most, 0.5);
}

TEST(Task, TellsMistakesWithLineAndMend) {
    const std::string head = "[task]\ntitle = \"t\"\ngoal = \"g\"\nscene = \"s.toml\"\n";
    const std::string score = "[[score]]\nmetric = \"time_s\"\nweight = 1\nworst = 9\nbest = 1\n";
    EXPECT_EQ(complaint(head + score), "");
    EXPECT_NE(complaint(head).find("scores nothing"), std::string::npos);
    EXPECT_NE(complaint(score).find("no table [task]"), std::string::npos);
    EXPECT_NE(complaint("[task]\ntitel = \"t\"\ngoal = \"g\"\nscene = \"s\"\n" + score).find("did you mean 'title'?"),
              std::string::npos);
    const std::string metric =
        complaint(head + "[[score]]\nmetric = \"duct_exposd\"\nweight = 1\nworst = 0\nbest = 1\n");
    EXPECT_NE(metric.find("test.toml:6"), std::string::npos) << metric;
    EXPECT_NE(metric.find("did you mean 'duct_exposed'?"), std::string::npos) << metric;
    EXPECT_NE(complaint(head + "[[score]]\nmetric = \"time_s\"\nweight = 1\nworst = 1\nbest = 1\n").find("the same"),
              std::string::npos);
    EXPECT_NE(complaint(head + score + "[[limit]]\nmetric = \"time_s\"\nmessage = \"m\"\n").find("at_least"),
              std::string::npos);
    EXPECT_NE(complaint("[task\n").find("not TOML"), std::string::npos);
}

TEST(Task, AllThatComeWithCalotAreGood) {
    const std::vector<std::string> paths = list_tasks({CALOT_SOURCE_DIR "/scenes/tasks"});
    EXPECT_GE(paths.size(), 4u);
    for (const std::string& path : paths) {
        const Task task = load_task(path);
        EXPECT_FALSE(task.hints.empty()) << path;
        EXPECT_TRUE(std::filesystem::exists(task.scene)) << path;
        for (const ScoreItem& item : task.score) EXPECT_FALSE(item.tip.empty()) << path << " " << item.metric;
    }
    EXPECT_THROW(find_task("disect", {CALOT_SOURCE_DIR "/scenes/tasks"}), InputError);
}

TEST(Score, IsLinearBetweenWorstAndBestAndCappedByLimits) {
    const Task task = parse_task(test::kTaskText, "test.toml");
    // 10 of 20 mm3 at weight 3, 0.5 of 2..0 s at weight 1: 100 (3 * 0.5 + 0.75) / 4.
    Metrics metrics{{"fat_removed_m3", 10e-9}, {"activation_s", 0.5}};
    Score result = score(task, metrics);
    EXPECT_NEAR(result.points, 56.25, 1e-9);
    EXPECT_NEAR(result.parts[0].weight, 75.0, 1e-9);
    EXPECT_TRUE(result.broken.empty());
    EXPECT_FALSE(result.completed);
    metrics = {{"fat_removed_m3", 40e-9}, {"activation_s", 1.0}};
    result = score(task, metrics);
    EXPECT_NEAR(result.before_caps, 87.5, 1e-9);
    EXPECT_NEAR(result.points, 60.0, 1e-9);
    ASSERT_EQ(result.broken.size(), 1u);
    EXPECT_EQ(result.broken[0].message, "too long");
}

TEST(Score, SharesTheWeightOfWhatTheSceneHasNot) {
    const Task task = parse_task(test::kTaskText, "test.toml");
    const Score result = score(task, {{"fat_removed_m3", 5e-9}});
    EXPECT_NEAR(result.points, 25.0, 1e-9);
    EXPECT_FALSE(result.parts[1].known);
    EXPECT_TRUE(result.broken.empty());
}

TEST(Metrics, AreAllDocumented) {
    std::ifstream stream(CALOT_SOURCE_DIR "/docs/scoring.md");
    std::ostringstream text;
    text << stream.rdbuf();
    for (const Metric& metric : metric_table()) {
        EXPECT_NE(text.str().find("`" + std::string(metric.name) + "`"), std::string::npos) << metric.name;
        EXPECT_GT(std::string(metric.formula).size(), 5u) << metric.name;
    }
}

TEST(Metrics, SurviveJson) {
    const Metrics metrics{{"time_s", 12.5}, {"hook_smoothness", std::nan("")}};
    const Metrics back = metrics_from_json(metrics_json(metrics));
    EXPECT_DOUBLE_EQ(back.at("time_s"), 12.5);
    EXPECT_TRUE(std::isnan(back.at("hook_smoothness")));
}

}  // namespace
}  // namespace calot::training
