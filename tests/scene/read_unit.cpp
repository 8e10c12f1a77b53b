// Reading scenes: values, units, bases, overrides, and what is said about mistakes.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "calot/base/error.h"
#include "calot/scene/keys.h"
#include "calot/scene/scene.h"
#include "support/paths.h"

namespace calot::scene {
namespace {

constexpr const char* kBlock = "anatomy.kind = \"block\"\n";

Scene read(const std::string& text) {
    return parse(text, "test.toml", ".");
}

/// What is told about a scene, or "" when it is accepted.
std::string complaint(const std::string& text) {
    try {
        build(read(text));
    } catch (const InputError& error) {
        return error.describe();
    }
    return "";
}

TEST(Read, ConvertsUnits) {
    const Scene scene = read(
        "[sampling]\nhexel_spacing_mm = 0.6\n[thermal]\nbody_temperature_C = 37\n"
        "[materials.fat]\nyoungs_modulus_kPa = 5\nperfusion_ml_per_min_kg = 60\n"
        "[[script.key]]\nt = 0\nroll_deg = 180\noffset_mm = [1, 2, 3]\n");
    EXPECT_DOUBLE_EQ(scene.sampling.hexel_spacing_m, 0.6e-3);
    EXPECT_DOUBLE_EQ(scene.thermal.body_temperature_K, 310.15);
    EXPECT_DOUBLE_EQ(scene.materials[1].youngs_modulus_Pa, 5e3);
    EXPECT_DOUBLE_EQ(scene.materials[1].perfusion_m3_per_s_kg, 1e-6);
    EXPECT_DOUBLE_EQ(scene.script[0].roll_rad, 3.14159265358979323846);
    EXPECT_DOUBLE_EQ(scene.script[0].tip.offset_m.z, 3e-3);
}

TEST(Read, DefaultsKeepTheValuesOfTheRooms) {
    const Scene scene;
    constexpr double kRounding = 1e-12;  // of a unit there and back
    EXPECT_NEAR(scene.sampling.hexel_spacing_m, tissue::SamplingParameters().hexel_spacing_m, kRounding);
    EXPECT_NEAR(scene.thermal.body_temperature_K, tissue::ThermalParameters().body_temperature_K, 1e3 * kRounding);
    const auto built_in = tissue::default_materials();
    for (std::size_t k = 1; k < built_in.size(); ++k) {
        EXPECT_NEAR(scene.materials[k].perfusion_m3_per_s_kg, built_in[k].perfusion_m3_per_s_kg, kRounding);
        EXPECT_NEAR(scene.materials[k].arrhenius_frequency_per_s / built_in[k].arrhenius_frequency_per_s, 1.0,
                    kRounding);
    }
}

TEST(Read, PrintedDefaultsAreTheDefaultScene) {
    const std::string printed = defaults_text();
    EXPECT_EQ(text(read(printed)), text(Scene()));
    for (const Group& group : groups(Scene()))
        for (const Key& key : group.keys)
            EXPECT_NE(printed.find("\n" + key.name + " = "), printed.find("\n# " + key.name + " = ")) << key.name;
    for (const char* key :
         {"hexel_spacing_mm = 0.6", "body_temperature_C = 37", "# file = ", "# from = ", "[materials.liver]"})
        EXPECT_NE(printed.find(key), std::string::npos) << key;
}

TEST(Read, CanonicalTextBuildsTheSameSceneToTheLastBit) {
    Scene scene =
        read(std::string(kBlock) +
             "scene.name = \"quotes \\\" and \\\\ and \\t\"\n"
             "[block]\nsize_mm = [7.1, 8.3, 2.7000000000000006]\n"
             "[thermal]\nbody_temperature_C = 36.7\ngas_temperature_C = 0.1\n"
             "[materials.zz_tumour]\nlike = \"fat\"\nyoungs_modulus_kPa = 11.3\nperfusion_ml_per_min_kg = 17.7\n"
             "[materials.another]\nlike = \"zz_tumour\"\npoisson_ratio = 0.33\n"
             "[[script.key]]\nt = 0.1\nroll_deg = 33.3\noffset_mm = [0.1, 0.2, 30.3]\n"
             "[[script.burst]]\nfrom = 0.3\nto = 0.7\npower_W = 12.34\nmode = \"coag\"\n"
             "[[script.burst]]\nfrom = 0.8\nto = 0.9\npreset = \"coag 55\"\n"
             "[[script.burst]]\nfrom = 0.91\nto = 0.95\npower_W = 20.0\npreset = \"blend 35\"\n");
    const std::string first = text(scene);
    const Scene again = read(first);
    EXPECT_EQ(text(again), first);
    EXPECT_EQ(again.block.size_m, scene.block.size_m);
    EXPECT_EQ(again.thermal.gas_temperature_K, scene.thermal.gas_temperature_K);
    EXPECT_EQ(again.script[0].roll_rad, scene.script[0].roll_rad);
    EXPECT_EQ(again.script[0].tip.offset_m, scene.script[0].tip.offset_m);
    const auto tumour = tissue::find_material(again.materials, "zz_tumour");
    ASSERT_NE(tumour, tissue::kNoMaterial);
    EXPECT_EQ(again.materials[tumour].perfusion_m3_per_s_kg, scene.materials[tumour].perfusion_m3_per_s_kg);
    EXPECT_EQ(again.materials[tumour].electric_conductivity_S_per_m, scene.materials[1].electric_conductivity_S_per_m);
    EXPECT_EQ(again.bursts[0].burst.mode, tissue::GeneratorMode::coag);
    EXPECT_EQ(again.bursts[1].burst.mode, tissue::GeneratorMode::coag);
    EXPECT_EQ(again.bursts[1].burst.power_W, 55.0);
    EXPECT_EQ(again.bursts[2].burst.mode, tissue::GeneratorMode::blend) << "the preset's";
    EXPECT_EQ(again.bursts[2].burst.power_W, 20.0) << "overrides the preset's";
}

TEST(Read, TellsEveryMistakeWithItsLine) {
    const std::string told = complaint(std::string(kBlock) +
                                       "[deformation]\ndampin_per_s = 3\n"
                                       "hourglass_alpha = 7\n"
                                       "law = \"stable_neohookean\"\n");
    EXPECT_NE(told.find("test.toml:3:1: unknown key 'deformation.dampin_per_s'\n  hint: did you mean 'damping_per_s'?"),
              std::string::npos)
        << told;
    EXPECT_NE(told.find("test.toml:4:19: 'deformation.hourglass_alpha' is 7, out of range"), std::string::npos) << told;
    EXPECT_NE(told.find("test.toml:5:7: 'deformation.law' is \"stable_neohookean\""), std::string::npos) << told;
    EXPECT_NE(told.find("did you mean \"stable_neo_hookean\"?"), std::string::npos) << told;
}

TEST(Read, ListsThePatientsLandmarks) {
    const std::string told = complaint(std::string(kBlock) + "[[script.key]]\nt = 0\nat = \"topp\"\n");
    EXPECT_NE(told.find("unknown landmark \"topp\""), std::string::npos) << told;
    EXPECT_NE(told.find("did you mean \"top\"? this anatomy has centre, top, trocar"), std::string::npos) << told;
}

TEST(Read, SendsAKeyWhereItBelongs) {
    EXPECT_NE(complaint(std::string(kBlock) + "[run]\nfoot_length_mm = 4\n").find("belongs into [hook]"),
              std::string::npos);
}

TEST(Read, RefusesWhatWouldFillTheMachine) {
    const std::string told =
        complaint(std::string(kBlock) + "block.size_mm = [400, 400, 400]\nsampling.hexel_spacing_mm = 0.05\n");
    EXPECT_NE(told.find("GB"), std::string::npos) << told;
}

TEST(Override, SetsAndValidates) {
    Scene scene = read(kBlock);
    override_value(scene, "deformation.damping_per_s=60");
    override_value(scene, "script.key[0].offset_mm=[1, 2, 3]");
    override_value(scene, "deformation.law=saint_venant_kirchhoff");
    override_value(scene, "scene.name=a plain = sign");
    override_value(scene, "materials.fat.youngs_modulus_kPa=7");
    EXPECT_EQ(scene.deformation.damping_per_s, 60.0);
    EXPECT_DOUBLE_EQ(scene.script[0].tip.offset_m.y, 2e-3);
    EXPECT_EQ(scene.deformation.law, tissue::ElasticLaw::saint_venant_kirchhoff);
    EXPECT_EQ(scene.name, "a plain = sign");
    EXPECT_EQ(scene.materials[1].youngs_modulus_Pa, 7e3);
    for (const char* wrong : {"nothing", "=3", "deformation.damping=60", "script.key[4].t=1", "script.key.t=1",
                              "run[0].duration_s=1", "run.duration_s=long", "run.duration_s=", "run.duration_s=-1",
                              "run.duration_s=1\nrun.duration_s=2", "block.size_mm=[1,2]"})
        EXPECT_THROW(override_value(scene, wrong), InputError) << wrong;
    try {
        override_value(scene, "deformation.damping=60");
    } catch (const InputError& error) {
        EXPECT_NE(error.describe().find("--set deformation.damping=60: unknown key"), std::string::npos);
        EXPECT_NE(error.hint.find("deformation.damping_per_s"), std::string::npos);
    }
}

class Files : public ::testing::Test {
  protected:
    Files() : folder_(std::filesystem::temp_directory_path() / ("calotcene_test." + std::to_string(::getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~Files() override { std::filesystem::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    std::filesystem::path folder_;
};

TEST_F(Files, StartsFromABase) {
    write("base.toml", std::string(kBlock) + "scene.name = \"base\"\n[run]\nduration_s = 4\n[[script.key]]\nt = 1\n");
    const Scene scene = load(write("top.toml", "scene.base = \"base.toml\"\nscene.name = \"top\"\n"));
    EXPECT_EQ(scene.name, "top");
    EXPECT_EQ(scene.duration_s, 4.0);
    EXPECT_EQ(scene.script.at(0).time_s, 1.0);
}

TEST_F(Files, PointsIntoTheBase) {
    write("base.toml", "\n[run]\nduration_s = true\n");
    try {
        load(write("top.toml", "scene.base = \"base.toml\"\n"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(error.describe().find("base.toml:3:14: 'run.duration_s' is true or false"), std::string::npos)
            << error.describe();
    }
}

TEST_F(Files, RefusesACircleOfBases) {
    write("b.toml", "scene.base = \"a.toml\"\n");
    try {
        load(write("a.toml", "scene.base = \"b.toml\"\n"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(error.describe().find("its own base: a.toml -> b.toml -> a.toml"), std::string::npos)
            << error.describe();
    }
}

TEST(Scenes, AllThatComeWithCalotAreValid) {
    for (const auto& entry : std::filesystem::directory_iterator(std::string(CALOT_SOURCE_DIR) + "/scenes"))
        if (entry.path().extension() == ".toml") {
            EXPECT_NO_THROW(load(entry.path().string())) << entry.path();
        }
}

}  // namespace
}  // namespace calot::scene
