// `calot validate`: what it says, what it writes, what it refuses.

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "program.h"

namespace calot::test {

namespace {

using Json = nlohmann::json;

/// What is known to fall short of what is asked, and how far it may; docs/validation.md tells why.
const std::map<std::string, double> kShort{
    {"cantilever", 0.06},
    {"torsion of a square bar", 0.075},
    {"indentation by a rigid ball", 0.1},
};

const std::string kScenes = CALOT_SOURCE_DIR "/scenes/validation";

}  // namespace

TEST(Validate, TheShortFormPasses) {
    const Folder folder("validate");
    const Outcome outcome =
        run({"validate", "--quick", "--progress", "none", "--scenes", kScenes, "--json", folder / "v.json"});
    const Json json = Json::parse(read_file(folder / "v.json"));
    std::set<std::string> suites;
    int failed = 0;
    for (const Json& c : json.at("cases")) {
        const auto name = c.at("name").get<std::string>(), verdict = c.at("verdict").get<std::string>();
        suites.insert(c.at("suite").get<std::string>());
        for (const char* key : {"value", "expected", "error", "tolerance"}) EXPECT_TRUE(c.at(key).is_number()) << name;
        for (const char* key : {"unit", "source", "kind"}) EXPECT_TRUE(c.at(key).is_string()) << name;
        EXPECT_TRUE(c.at("order").is_null() || c.at("order").is_number()) << name;
        EXPECT_TRUE(c.at("kind") == "analytic" || c.at("kind") == "trend") << "experiments are in the complete form";
        failed += verdict == "fail";
        const auto known = kShort.find(name);
        if (known != kShort.end())
            EXPECT_LT(c.at("error").get<double>(), known->second) << name;
        else
            EXPECT_EQ(verdict, "pass") << name << ": " << c.at("error") << ", order " << c.at("order");
    }
    EXPECT_EQ(suites, (std::set<std::string>{"deformation", "heat", "electric", "phase", "surface", "coupled"}));
    EXPECT_EQ(json.at("failed").get<int>(), failed);
    EXPECT_EQ(outcome.code, failed > 0 ? 1 : 0) << outcome.output;
    EXPECT_NE(outcome.output.find("cantilever"), std::string::npos);
}

TEST(Validate, ABrokenParameterFails) {
    const Outcome outcome =
        run({"validate", "--quick", "--suite", "heat", "--spoil", "thermal_conductivity=2", "--scenes", kScenes});
    EXPECT_EQ(outcome.code, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("fail"), std::string::npos);
}

TEST(Validate, WritesAPageThatOpensOffline) {
    const Folder folder("validate_page");
    const std::vector<std::string> arguments{"validate", "--quick", "--suite",  "surface",
                                             "--scenes", kScenes,   "--report", folder / "page"};
    EXPECT_EQ(run(arguments).code, 0);
    const std::string page = read_file(folder / "page/report.html");
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_NE(page.find("</html>"), std::string::npos);
    for (const char* outside : {"src=", "http:", "https:", "<script", "@import"})
        EXPECT_EQ(page.find(outside), std::string::npos) << outside;
    EXPECT_EQ(page.find("nan"), std::string::npos);
    EXPECT_TRUE(Json::parse(read_file(folder / "page/validation.json")).at("cases").is_array());
    EXPECT_EQ(run(arguments).code, 2) << "it does not overwrite";
    auto again = arguments;
    again.push_back("--force");
    EXPECT_EQ(run(again).code, 0);
}

TEST(Validate, RefusesWhatItCannotDo) {
    const Folder folder("validate_bad");
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"validate", "--suite", "colours"},
          {"validate", "--suite", "surface", "--spoil", "colour=2"},
          {"validate", "--suite", "surface", "--spoil", "water"},
          {"validate", "--suite", "surface", "--spoil", "water=nan"},
          {"validate", "--suite", "surface", "--json", folder / "none/v.json"},
          {"validate", "--suite", "surface", "--scenes", folder / "none"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << outcome.output;
        EXPECT_NE(outcome.output.find("hint"), std::string::npos) << outcome.output;
    }
}

}  // namespace calot::test
