// `calot bench`: what it writes, how it compares, what it refuses.

#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "support/paths.h"

namespace calot::test {
namespace {

using Json = nlohmann::json;

/// A quick run of some suites from the project's own directory, where its scenes are.
Outcome quick_bench(const std::vector<std::string>& more) {
    std::vector<std::string> words{"bench", "--quick", "--threads", "1", "--progress", "plain"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, CALOT_SOURCE_DIR);
}

void expect_keys(const Json& object, const std::vector<const char*>& keys, const char* what) {
    for (const char* key : keys) EXPECT_TRUE(object.contains(key)) << what << ": " << key;
}

/// Times are positive, and what is not measured is null.
void expect_time(const Json& value, bool may_be_missing = false) {
    if (may_be_missing && value.is_null()) return;
    ASSERT_TRUE(value.is_number());
    EXPECT_GT(value.get<double>(), 0.0);
}

TEST(Bench, WritesFiguresAndAPage) {
    const Folder folder("bench");
    const Outcome outcome = quick_bench({"--json", folder / "b.json", "--html", folder / "b.html", "--seconds", "1.7",
                                         "--passes", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const Json j = Json::parse(read_file(folder / "b.json"));
    expect_keys(j, {"machine", "ceilings", "kernels", "tick", "paper", "scale", "samples"}, "file");
    expect_keys(j["machine"], {"processor", "instruction_set", "cores", "compiler", "scheduling"}, "machine");
    ASSERT_FALSE(j["ceilings"]["bandwidth"].empty());
    expect_time(j["ceilings"]["bandwidth"][0]["read_GB_per_s"]);
    expect_time(j["ceilings"]["arithmetic"][0]["multiply_add_GFlop_per_s"]);

    ASSERT_GT(j["kernels"].size(), 6u);
    for (const Json& kernel : j["kernels"]) {
        expect_keys(kernel, {"name", "size", "threads", "us", "reference_us", "floor_us"}, "kernel");
        expect_time(kernel["us"]);
        expect_time(kernel["reference_us"], true);
        expect_time(kernel["floor_us"], true);
    }
    ASSERT_GE(j["tick"].size(), 2u);
    for (const Json& tick : j["tick"]) {
        expect_keys(tick,
                    {"scene", "phyxels", "hexels", "threads", "simulated_s", "median_us", "p99_us", "p999_us", "max_us",
                     "late", "stages_us", "worst", "histogram", "passes", "least_us"},
                    "tick");
        EXPECT_LE(tick["median_us"], tick["p99_us"]);
        EXPECT_LE(tick["p99_us"], tick["p999_us"]);
        EXPECT_LE(tick["p999_us"], tick["max_us"]);
        EXPECT_EQ(tick["passes"], 2);  // of every tick the shortest counts
        EXPECT_LE(tick["least_us"]["median"], tick["median_us"]);
        EXPECT_LE(tick["least_us"]["p99"], tick["p99_us"]);
        EXPECT_LE(tick["least_us"]["max"], tick["max_us"]);
        EXPECT_NEAR(tick["worst"][0]["us"].get<double>(), tick["max_us"].get<double>(), 0.1);  // single precision
        EXPECT_FALSE(tick["worst"][0]["cause"].get<std::string>().empty());
        std::int64_t in_bins = 0;
        for (const Json& count : tick["histogram"]["tick"]) in_bins += count.get<std::int64_t>();
        EXPECT_EQ(in_bins, std::lround(1000.0 * tick["simulated_s"].get<double>()));
        EXPECT_GT(tick["removed"], 0);
    }
    for (const Json& row : j["paper"]) expect_keys(row, {"table", "size", "stage", "ours_ms", "published_ms"}, "paper");
    const auto published = [&](std::int64_t size) {
        for (const Json& row : j["paper"])
            if (row["size"] == size && row["stage"] == "deformation step") return row["published_ms"].get<double>();
        return 0.0;
    };
    EXPECT_EQ(published(1593), 1.88);
    EXPECT_EQ(published(2447), 2.01);
    EXPECT_EQ(published(3041), 2.62);
    EXPECT_EQ(published(4510), 3.07);
    expect_keys(j["scale"], {"sizes", "us", "exponent"}, "scale");
    EXPECT_EQ(j["scale"]["sizes"], Json({3041, 20291, 147233}));

    const std::string page = read_file(folder / "b.html");
    for (const char* part : {"Whole ticks", "Kernels", "Growth", "Table 1", "Table 2", "Fig. 16", "</html>"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    for (const char* elsewhere : {"src=\"http", "href=\"http", "url(http"})
        EXPECT_EQ(page.find(elsewhere), std::string::npos) << elsewhere;
}

TEST(Bench, ComparesWithAnEarlierRun) {
    const Folder folder("bench-compare");
    ASSERT_EQ(quick_bench({"--suite", "surface", "--json", folder / "now.json"}).code, 0);
    // An earlier run that took far longer, and far less: more than any noise of a busy machine.
    const auto with_factor = [&](double factor) {
        Json j = Json::parse(read_file(folder / "now.json"));
        for (Json& samples : j["samples"])
            for (Json& us : samples["us"]) us = us.get<double>() * factor;
        return folder.write("earlier.json", j.dump());
    };
    const auto verdicts = [&](const char* word) {
        const Outcome outcome =
            quick_bench({"--suite", "surface", "--json", folder / "again.json", "--compare", folder / "earlier.json"});
        EXPECT_EQ(outcome.code, 0) << outcome.output;
        EXPECT_NE(outcome.output.find("95 % interval"), std::string::npos);
        std::size_t count = 0;
        for (std::size_t at = 0; (at = outcome.output.find(word, at + 1)) != std::string::npos;) ++count;
        return count;
    };
    with_factor(1e5);
    EXPECT_EQ(verdicts("faster\n"), 3u);
    with_factor(1e-5);
    EXPECT_EQ(verdicts("slower\n"), 3u);
}

TEST(Bench, RefusesWhatItCannotUse) {
    const Folder folder("bench-bad");
    const auto refused = [&](const std::vector<std::string>& words, const char* says) {
        const Outcome outcome = quick_bench(words);
        EXPECT_EQ(outcome.code, 2) << outcome.output;
        EXPECT_NE(outcome.output.find(says), std::string::npos) << outcome.output;
    };
    refused({"--suite", "speed"}, "speed");
    refused({"--compare", folder / "none.json"}, "cannot read");
    refused({"--compare", folder.write("text.json", "hello")}, "no result of a benchmark");
    refused({"--compare", folder.write("other.json", "{}")}, "no result of a benchmark");
    refused({"--json", folder / "no/such/folder.json"}, "does not exist");
    refused({"--seconds", "nan"}, "nan");
}

TEST(Inspect, MemoryStaysWithinItsBounds) {
    const Outcome outcome = run({"inspect", CALOT_SOURCE_DIR "/scenes/calot.toml", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const Json memory = Json::parse(outcome.output)["memory_bytes"];
    EXPECT_LT(memory["per_hexel_cell"], 64.0);  // the bounds of the specification
    EXPECT_LT(memory["per_phyxel_cell"], 400.0);
    // Nothing is left out: a cell of hexels has six numbers of four bytes, one of phyxels some fifty.
    EXPECT_GT(memory["per_hexel_cell"], 24.0);
    EXPECT_GT(memory["per_phyxel_cell"], 200.0);
    std::int64_t work = 0;
    for (const Json& room : memory["work"]) work += room.get<std::int64_t>();
    EXPECT_EQ(memory["all"].get<std::int64_t>(),
              memory["model"].get<std::int64_t>() + memory["state"].get<std::int64_t>() + work);
}

}  // namespace
}  // namespace calot::test
