// Broken scenes, recordings and command lines: each is refused with exit code 2 and a message that helps. Nothing
// crashes, nothing is left behind.

#include <gtest/gtest.h>

#include <functional>

#include "apps/program.h"

namespace calot::test {
namespace {

/// A broken scene: what is said about it.
struct BrokenScene {
    const char* name;
    std::string text;   ///< of the scene file
    const char* says;   ///< fragment of the message
    const char* where;  ///< ":line:column" in the message, or ""
};

std::string block(const std::string& more) {
    return "anatomy.kind = \"block\"\n" + more;
}

const std::vector<BrokenScene> kBrokenScenes{
    {"no_toml", "this is not toml", "this is not TOML", ":1:"},
    {"unclosed_string", "[scene]\nname = \"x\n", "this is not TOML", ":2:"},
    {"binary", std::string("\0\1\2\377\376", 5), "this is not TOML", ":1:"},
    {"table_twice", "[run]\nduration_s = 1\n[run]\n", "this is not TOML", ":3:"},
    {"key_twice", "[run]\nduration_s = 1\nduration_s = 2\n", "this is not TOML", ":3:"},
    {"unknown_key", block("[run]\nduration = 3\n"), "did you mean 'duration_s'?", ":3:1"},
    {"unknown_table", block("[runs]\nduration_s = 3\n"), "did you mean 'run'?", ":2:2"},
    {"unknown_top_key", block("duration_s = 3\n"), "'duration_s' belongs into [run]", ":2:1"},
    {"far_off_key", block("[contact]\nxyzzy = 3\n"), "[contact] knows stiffness_N_per_m, friction", ":3:1"},
    {"text_for_number", block("[run]\nduration_s = \"3\"\n"), "'run.duration_s' is text", ":3:14"},
    {"number_for_text", "[scene]\nname = 3\n", "'scene.name' is a whole number", ":2:8"},
    {"fraction_for_whole", block("[picture]\nwidth = 640.5\n"), "give a whole number from 64 to 4096 pixels", ":3:9"},
    {"number_for_flag", block("[block]\nheld_below = 1\n"), "give true or false", ":3:14"},
    {"date_for_number", block("[run]\nduration_s = 2024-01-01\n"), "is a date or time", ":3:14"},
    {"value_for_table", block("run = 3\n"), "'run' is a whole number, not a table", ":2:7"},
    {"table_for_value", block("[run.duration_s]\nx = 1\n"), "'run.duration_s' is a table", ":2:"},
    {"negative_duration", block("[run]\nduration_s = -3\n"), "out of range", ":3:14"},
    {"infinite_duration", block("[run]\nduration_s = inf\n"), "is not finite", ":3:14"},
    {"nan_stiffness", block("[materials.fat]\nyoungs_modulus_kPa = nan\n"), "is not finite", ":3:22"},
    {"incompressible", block("[materials.fat]\npoisson_ratio = 0.5\n"), "out of range", ":3:17"},
    {"absurd_number", block("[materials.fat]\ndensity_kg_per_m3 = 1e300\n"), "out of range", ":3:21"},
    {"huge_integer", block("[anatomy]\nseed = 99999999999999999999\n"), "this is not TOML", ":"},
    {"wrong_word", "[anatomy]\nkind = \"blocks\"\n", "did you mean \"block\"?", ":2:8"},
    {"short_vector", block("[block]\nsize_mm = [1, 2]\n"), "has 2 elements", ":3:11"},
    {"text_in_vector", block("[block]\nsize_mm = [1, 2, \"3\"]\n"), "holds text", ":3:11"},
    {"zero_thickness", block("[block]\nsize_mm = [10, 10, 0]\n"), "out of range", ":3:11"},
    {"thinner_than_a_hexel", block("[block]\nsize_mm = [10, 10, 0.3]\n"), "thinner than a hexel", ""},
    {"too_many_hexels", block("block.size_mm = [300, 300, 300]\nsampling.hexel_spacing_mm = 0.1\n"),
     "raise run.max_memory_GB", ""},
    {"three_hexels_an_edge", block("sampling.hexels_per_edge = 3\n"), "use 1, 2 or 4", ""},
    {"unknown_material", block("block.material = \"fatt\"\n"), "did you mean \"fat\"?", ""},
    {"new_material_like_nothing", block("[materials.tumour]\ndensity_kg_per_m3 = 1000\n"), "a new material needs like",
     ":2:12"},
    {"material_like_itself", block("[materials.tumour]\nlike = \"tumour\"\n"), "cannot be like 'tumour'", ":3:8"},
    {"built_in_material_like_another", block("[materials.fat]\nlike = \"liver\"\n"), "is built in", ":3:8"},
    {"no_script", block("script.key = []\n"), "has no [[script.key]]", ""},
    {"script_is_a_table", block("[script.key]\nt = 1\n"), "write [[script.key]]", ":2:"},
    {"key_without_time", block("[[script.key]]\noffset_mm = [0, 0, 1]\n"), "[[script.key]] has no 't'", ":2:1"},
    {"times_not_increasing", block("[[script.key]]\nt = 1\n[[script.key]]\nt = 1\n"), "times must increase", ":4:1"},
    {"times_too_close", block("[[script.key]]\nt = 1\n[[script.key]]\nt = 1.0001\n"), "less than a tick", ":4:1"},
    {"unknown_landmark", block("[[script.key]]\nt = 0\nat = \"tpo\"\n"),
     "did you mean \"top\"? this anatomy has centre, top, trocar", ":2:1"},
    {"unknown_camera_landmark", block("camera.eye = \"nowhere\"\n"), "[camera] eye names the unknown landmark", ""},
    {"tip_at_the_trocar",
     block("hook.trocar = \"trocar\"\nhook.trocar_offset_mm = [0, 0, 0]\n[[script.key]]\nt = 0\nat = \"trocar\"\n"),
     "within 20 mm of its trocar", ":4:1"},
    {"burst_backwards", block("[[script.burst]]\nfrom = 2\nto = 1\n"), "must end after it begins", ":2:1"},
    {"bursts_overlap", block("[[script.burst]]\nfrom = 1\nto = 3\n[[script.burst]]\nfrom = 2\nto = 4\n"),
     "must not overlap", ":5:1"},
    {"burst_without_end", block("[[script.burst]]\nfrom = 1\n"), "has no 'to'", ":2:1"},
    {"burst_of_a_megawatt", block("[[script.burst]]\nfrom = 1\nto = 2\npower_W = 1e6\n"),
     "give a number from 0.1 to 300 W", ":5:11"},
    {"unknown_mode", block("[[script.burst]]\nfrom = 1\nto = 2\nmode = \"fulgurate\"\n"),
     "\"cut\", \"blend\", \"coag\"", ":5:8"},
    {"odd_picture", block("picture.width = 641\n"), "must be even", ""},
    {"heel_too_short", block("hook.heel_length_mm = 2\n"), "hook.insulated_heel_mm is longer", ""},
    {"mesh_without_kind", block("[[mesh]]\nfile = \"a.stl\"\n"), "anatomy.kind is not \"meshes\"", ":2:1"},
    {"kind_without_mesh", "anatomy.kind = \"meshes\"\n", "no [[mesh]] has the role \"tissue\"", ""},
    {"mesh_without_file", "anatomy.kind = \"meshes\"\n[[mesh]]\nname = \"a\"\n", "[[mesh]] has no 'file'", ":2:1"},
    {"missing_base", "scene.base = \"nowhere.toml\"\n", "there is no such scene file", ":1:"},
    {"own_base", "scene.base = \"scene.toml\"\n", "cannot be its own base", ":1:"},
    {"base_is_no_text", "scene.base = 3\n", "'scene.base' is no text", ":1:"},
    {"duct_too_long", "[triangle]\nduct_length_mm = 400\n", "give a number from 20 to 40 mm", ":2:18"},
    {"deep_nesting", std::string(5000, '['), "this is not TOML", ":1:"},
};

class BadScene : public ::testing::TestWithParam<BrokenScene> {};

TEST_P(BadScene, IsRefused) {
    const BrokenScene& broken = GetParam();
    const Folder folder(std::string("bad_") + broken.name);
    const std::string scene = folder.write("scene.toml", broken.text);
    const Outcome outcome = run({"simulate", scene, "--out", folder / "out", "--frames", "none"});
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(broken.says), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("scene.toml" + std::string(broken.where)), std::string::npos) << outcome.output;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "something was left behind";
}

template <class T>
std::string name_of(const ::testing::TestParamInfo<T>& info) {
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Table, BadScene, ::testing::ValuesIn(kBrokenScenes), name_of<BrokenScene>);

/// A wrong command line. "SCENE" stands for a good scene, "OUT" for a free output directory.
struct WrongCommand {
    const char* name;
    std::vector<std::string> arguments;
    const char* says;
    int code = 2;
};

const std::vector<WrongCommand> kWrongCommands{
    {"nothing", {}, "subcommand is required"},
    {"unknown_command", {"simulat", "SCENE"}, "--help"},
    {"no_scene", {"simulate"}, "scene is required"},
    {"unknown_option", {"simulate", "SCENE", "--fast"}, "--fast"},
    {"two_scenes", {"inspect", "SCENE", "SCENE"}, "--help"},
    {"missing_scene", {"simulate", "nowhere.toml"}, "there is no such scene file"},
    {"misspelt_scene", {"simulate", "FOLDER/tinny.toml"}, "did you mean"},
    {"scene_is_a_directory", {"inspect", "FOLDER"}, "this is a directory"},
    {"scene_without_end", {"inspect", "/dev/zero"}, "too large for a scene file"},
    {"duration_is_a_word", {"simulate", "SCENE", "--duration", "long"}, "--duration"},
    {"duration_negative", {"simulate", "SCENE", "--duration", "-1"}, "--duration"},
    {"duration_nan", {"simulate", "SCENE", "--duration", "nan"}, "--duration"},
    {"seed_negative", {"simulate", "SCENE", "--seed", "-1"}, "--seed"},
    {"seed_fraction", {"simulate", "SCENE", "--seed", "1.5"}, "--seed"},
    {"threads_too_many", {"simulate", "SCENE", "--threads", "100000"}, "--threads"},
    {"frames_of_what", {"simulate", "SCENE", "--frames", "gif"}, "--frames"},
    {"progress_of_what", {"simulate", "SCENE", "--progress", "loud"}, "--progress"},
    {"export_backwards", {"simulate", "SCENE", "--export-every", "-1"}, "--export-every"},
    {"set_nothing", {"simulate", "SCENE", "--set", "nothing"}, "--set key.path=value"},
    {"set_unknown", {"simulate", "SCENE", "--set", "run.duration=3"}, "did you mean 'run.duration_s'?"},
    {"set_wrong_type",
     {"simulate", "SCENE", "--set", "run.duration_s=[1]"},
     "--set run.duration_s=[1]: 'run.duration_s' is an array"},
    {"set_out_of_range", {"simulate", "SCENE", "--set", "contact.friction=9"}, "out of range"},
    {"set_injection", {"simulate", "SCENE", "--set", "run.duration_s=1\nx=2"}, "is not a value"},
    {"set_beyond_the_array", {"simulate", "SCENE", "--set", "script.key[9].t=1"}, "has only 2 tables [[script.key]]"},
    {"set_breaks_the_order", {"simulate", "SCENE", "--set", "script.key[1].t=0"}, "times must increase"},
    {"scene_without_question", {"scene"}, "--defaults"},
    {"out_is_empty", {"simulate", "SCENE", "--out", ""}, "cannot be an output directory"},
    {"out_is_the_root", {"simulate", "SCENE", "--out", "/"}, "cannot be an output directory"},
    {"out_is_a_file", {"simulate", "SCENE", "--out", "SCENE", "--force"}, "is not a directory"},
    {"out_exists", {"simulate", "SCENE", "--out", "FOLDER"}, "--force replaces it"},
    {"out_below_a_file", {"simulate", "SCENE", "--out", "SCENE/out"}, "cannot create the directory"},
    {"out_cannot_be_written", {"simulate", "SCENE", "--out", "/proc/calot/out"}, "cannot create the directory"},
    {"replay_nothing", {"replay"}, "recording is required"},
    {"replay_missing", {"replay", "nowhere.calot"}, "cannot open the recording"},
    {"replay_a_directory", {"replay", "FOLDER"}, "recording"},
    {"replay_a_scene", {"replay", "SCENE"}, "this is not a recording of Calot"},
};

class BadCommand : public ::testing::TestWithParam<WrongCommand> {};

TEST_P(BadCommand, IsRefused) {
    const WrongCommand& wrong = GetParam();
    const Folder folder(std::string("command_") + wrong.name);
    const std::string scene = folder.write("tiny.toml", kTinyScene);
    std::vector<std::string> arguments = wrong.arguments;
    for (std::string& argument : arguments) {
        if (argument.rfind("SCENE", 0) == 0) argument = scene + argument.substr(5);
        if (argument.rfind("FOLDER", 0) == 0) argument = folder.path().string() + argument.substr(6);
    }
    const bool has_out = std::find(arguments.begin(), arguments.end(), "--out") != arguments.end();
    if (!arguments.empty() && arguments[0] == "simulate" && !has_out)
        arguments.insert(arguments.end(), {"--out", folder / "out"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, wrong.code) << outcome.output;
    EXPECT_NE(outcome.output.find(wrong.says), std::string::npos) << outcome.output;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "something was left behind";
}

INSTANTIATE_TEST_SUITE_P(Table, BadCommand, ::testing::ValuesIn(kWrongCommands), name_of<WrongCommand>);

/// A recording, damaged.
struct DamagedRecording {
    const char* name;
    std::function<std::string(std::string)> damage;  ///< of the file's bytes
    int code;
    const char* says;
};

const std::vector<DamagedRecording> kDamagedRecordings{
    {"empty", [](const std::string&) { return std::string(); }, 2, "this is not a recording of Calot"},
    {"other_magic", [](std::string b) { return b.replace(0, 8, "RIFFWAVE"); }, 2, "this is not a recording of Calot"},
    {"magic_only", [](const std::string& b) { return b.substr(0, 8); }, 2, "before its scene"},
    {"cut_in_the_header", [](const std::string& b) { return b.substr(0, 20); }, 2, "before its scene"},
    {"cut_in_the_scene", [](const std::string& b) { return b.substr(0, 300); }, 2, "before its scene"},
    {"scene_changed", [](std::string b) { return b[200] = static_cast<char>(b[200] ^ 1), b; }, 2, "before its scene"},
    {"absurd_length", [](std::string b) { return b.replace(12, 8, 8, '\xff'); }, 2, "before its scene"},
    {"cut_at_the_end", [](const std::string& b) { return b.substr(0, b.size() - 10); }, 0, "was cut off"},
    {"tail_changed", [](std::string b) { return b.replace(b.size() - 40, 8, 8, '\xff'); }, 0, "was cut off"},
    {"more_behind_the_end", [](const std::string& b) { return b + "more"; }, 0, "s simulated"},
};

class BadRecording : public ::testing::TestWithParam<DamagedRecording> {
  protected:
    static void SetUpTestSuite() {
        const Folder folder("recording");
        const Outcome made = run({"simulate", folder.write("tiny.toml", kTinyScene), "--out", folder / "out",
                                  "--frames", "none", "--export-every", "0", "--progress", "none"});
        ASSERT_EQ(made.code, 0) << made.output;
        good_ = read_file(folder / "out/recording.calot");
    }
    static std::string good_;
};
std::string BadRecording::good_;

TEST_P(BadRecording, IsToldAndNothingCrashes) {
    const DamagedRecording& damaged = GetParam();
    ASSERT_GT(good_.size(), 1000u);
    const Folder folder(std::string("recording_") + damaged.name);
    const Outcome outcome =
        run({"replay", folder.write("damaged.calot", damaged.damage(good_)), "--progress", "plain"});
    EXPECT_EQ(outcome.code, damaged.code) << outcome.output;
    EXPECT_NE(outcome.output.find(damaged.says), std::string::npos) << outcome.output;
}

INSTANTIATE_TEST_SUITE_P(Table, BadRecording, ::testing::ValuesIn(kDamagedRecordings), name_of<DamagedRecording>);

TEST_F(BadRecording, NoChangedByteCrashes) {
    // Bytes from a fixed sequence; whatever they hit, the program ends in order.
    const Folder folder("recording_bytes");
    std::uint64_t seed = 1;
    for (int trial = 0; trial < 40; ++trial) {
        std::string bytes = good_;
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        bytes[(seed >> 33) % bytes.size()] = static_cast<char>(seed >> 25);
        const Outcome outcome = run({"replay", folder.write("damaged.calot", bytes), "--progress", "none"});
        EXPECT_TRUE(outcome.code == 0 || outcome.code == 2) << outcome.code << " " << outcome.output;
    }
}

TEST(Help, ShowsExamplesForEveryCommand) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"--help"}, {"simulate", "--help"}, {"inspect", "--help"}, {"replay", "--help"}, {"scene", "--help"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0);
        EXPECT_NE(outcome.output.find("Examples:"), std::string::npos) << outcome.output;
    }
    EXPECT_EQ(run({"version"}).output.rfind("calot 0.", 0), 0u);
    EXPECT_EQ(run({"--version"}).code, 0);
}

TEST(Help, PrintedDefaultsAreAScene) {
    const Folder folder("defaults");
    const std::string scene = folder.write("defaults.toml", run({"scene", "--defaults"}).output);
    const Outcome outcome = run({"inspect", scene, "--set", "anatomy.kind=block", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.output;
}

}  // namespace
}  // namespace calot::test
