#include "calot/simulation/recording.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "calot/anatomy/block.h"
#include "calot/base/error.h"
#include "calot/tissue/sampling.h"

namespace calot::simulation {

namespace {

class RecordingFile : public ::testing::Test {
  protected:
    void SetUp() override {
        path = (std::filesystem::temp_directory_path() /
                ("calot-recording-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
                 ".calot"))
                   .string();
        model = tissue::sample(anatomy::make_block({.size_m = Vec3(0.0048)}), {});
        state = tissue::State::make(model);
    }
    void TearDown() override { std::filesystem::remove(path); }

    /// 2500 ticks: two whole seconds and a half.
    void write(bool finish) {
        RecordingWriter writer(path, "1.2.3", "[scene]\nname = 'x'\n", state);
        for (int k = 0; k < 2500; ++k) {
            tissue::Input input;
            input.hook.position_m = Vec3(0.001 * k, 1.0 / (k + 1), -k);
            input.hook.orientation = Quat(0.5, 0.5, -0.5, 0.5);
            input.pedal = k % 3 == 0;
            input.mode = tissue::GeneratorMode::blend;
            input.power_setting_W = k;
            input.wipe_tip = k % 5 == 0;
            input.suction = k % 7 == 0;
            input.irrigation = k % 11 == 0;
            input.grasper = {k % 2 == 0, {Vec3(-k, 0.5 * k, 7.0), Quat(0.5, 0.5, 0.5, -0.5)}, 1.0 / (k + 1)};
            ++state.tick;
            writer.add(input, state);
        }
        if (finish) writer.finish(state);
    }

    std::string path;
    tissue::Model model;
    tissue::State state;
};

}  // namespace

TEST_F(RecordingFile, ReadsBackWhatWasWritten) {
    write(true);
    const Recording recording = read_recording(path);
    EXPECT_TRUE(recording.complete);
    EXPECT_EQ(recording.program_version, "1.2.3");
    EXPECT_EQ(recording.scene_text, "[scene]\nname = 'x'\n");
    ASSERT_EQ(recording.inputs.size(), 2500u);
    EXPECT_EQ(recording.inputs[77].hook.position_m, Vec3(0.001 * 77, 1.0 / 78, -77));
    EXPECT_EQ(recording.inputs[77].hook.orientation, Quat(0.5, 0.5, -0.5, 0.5));
    EXPECT_TRUE(recording.inputs[78].pedal);
    EXPECT_FALSE(recording.inputs[79].pedal);
    EXPECT_EQ(recording.inputs[79].mode, tissue::GeneratorMode::blend);
    EXPECT_EQ(recording.inputs[79].power_setting_W, 79.0);
    for (const int k : {0, 5, 77, 1001}) {
        EXPECT_EQ(recording.inputs[k].wipe_tip, k % 5 == 0) << k;
        EXPECT_EQ(recording.inputs[k].suction, k % 7 == 0) << k;
        EXPECT_EQ(recording.inputs[k].irrigation, k % 11 == 0) << k;
    }
    EXPECT_FALSE(recording.inputs[77].grasper.present);
    EXPECT_TRUE(recording.inputs[78].grasper.present);
    EXPECT_EQ(recording.inputs[78].grasper.pose.position_m, Vec3(-78, 39, 7));
    EXPECT_EQ(recording.inputs[78].grasper.pose.orientation, Quat(0.5, 0.5, 0.5, -0.5));
    EXPECT_EQ(recording.inputs[78].grasper.jaw, 1.0 / 79);
    ASSERT_EQ(recording.hashes.size(), 3u);
    EXPECT_EQ(recording.hashes[0].tick, 1000);
    EXPECT_EQ(recording.hashes[2].tick, 2500);
    EXPECT_EQ(recording.hashes[2].fields, tissue::hash_fields(state));
}

TEST_F(RecordingFile, CutOffAnywhereKeepsWholeSeconds) {
    write(true);
    const auto size = std::filesystem::file_size(path);
    for (std::uintmax_t keep = size - 1; keep > size / 2; keep -= 997) {
        std::filesystem::resize_file(path, keep);
        const Recording recording = read_recording(path);
        EXPECT_FALSE(recording.complete);
        EXPECT_TRUE(recording.inputs.size() == 2500 || recording.inputs.size() % 1000 == 0) << recording.inputs.size();
    }
}

TEST_F(RecordingFile, KilledBeforeTheEndKeepsWholeSeconds) {
    write(false);
    const Recording recording = read_recording(path);
    EXPECT_FALSE(recording.complete);
    EXPECT_EQ(recording.inputs.size(), 2000u);
}

TEST_F(RecordingFile, ChangedByteIsNoticed) {
    write(true);
    const auto size = static_cast<std::streamoff>(std::filesystem::file_size(path));
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(size / 2);
    const auto old = static_cast<char>(file.get());
    file.seekp(size / 2);
    file.put(static_cast<char>(old ^ 0x10));
    file.close();
    EXPECT_FALSE(read_recording(path).complete);
}

TEST_F(RecordingFile, RefusesOtherFiles) {
    EXPECT_THROW(read_recording(path + ".missing"), InputError);
    std::ofstream(path) << "CALOTRE1 but then nonsense that is long enough for a header and more";
    EXPECT_THROW(read_recording(path), InputError);
    std::ofstream(path) << "hello";
    EXPECT_THROW(read_recording(path), InputError);
}

}  // namespace calot::simulation
