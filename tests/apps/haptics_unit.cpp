// calot haptics as people call it: on a virtual clock, so that nothing depends on how busy the machine is.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.h"

namespace calot::test {
namespace {

std::vector<std::string> trial(std::vector<std::string> more) {
    std::vector<std::string> words{"haptics", "--device", "simulated", "--virtual", "--seconds", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST(Haptics, ListsDevices) {
    const Outcome outcome = run({"haptics", "--list"});
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    for (const char* kind : {"openhaptics", "simulated", "network"})
        EXPECT_NE(outcome.output.find(kind), std::string::npos) << kind;
}

TEST(Haptics, PressesIntoFatAndReports) {
    const Folder folder("haptics");
    const Outcome outcome = run(trial({"--report", folder / "report", "--json", folder / "trial.json"}));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("passive: energy was never generated"), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("* pressing"), std::string::npos) << outcome.output;
    const auto json = nlohmann::json::parse(read_file(folder / "trial.json"));
    EXPECT_TRUE(json["passivity"]["passive"].get<bool>());
    EXPECT_TRUE(json["rate_Hz"].is_null()) << "a virtual clock measures nothing";
    EXPECT_GT(json["force"]["at_5mm_N"].get<double>(), 0.06);
    EXPECT_LT(json["force"]["at_10mm_N"].get<double>(), 0.3);
    for (const auto& [fault, count] : json["faults"].items()) EXPECT_EQ(count.get<int>(), 0) << fault;
    for (const char* file : {"report.html", "summary.json", "force-depth.svg", "trace.csv"})
        EXPECT_GT(read_file(folder / ("report/" + std::string(file))).size(), 1000u) << file;
    EXPECT_EQ(read_file(folder / "report/summary.json"), read_file(folder / "trial.json"));
    // The same figures every time.
    ASSERT_EQ(run(trial({"--json", folder / "again.json"})).code, 0);
    EXPECT_EQ(read_file(folder / "again.json"), read_file(folder / "trial.json"));
}

TEST(Haptics, SaysWhatIsWrong) {
    const Folder folder("haptics_wrong");
    folder.write("occupied", "");
    for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, const char*>>{
             {{"haptics", "--device", "openhaptics", "--openhaptics-library", folder / "none.so"}, "none.so"},
             {{"haptics", "--device", "spoon"}, "spoon"},
             {{"haptics", "--device", "network", "--virtual"}, "--virtual needs the simulated device"},
             {{"haptics", "--device", "simulated", "--scene", folder / "none.toml"}, "none.toml"},
             {trial({"--report", folder / "occupied"}), "not a directory"}}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2) << outcome.output;
        EXPECT_NE(outcome.output.find(said), std::string::npos) << outcome.output;
    }
}

}  // namespace
}  // namespace calot::test
