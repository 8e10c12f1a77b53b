#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "calot/render/video.h"

namespace calot::render {
namespace {

/// Output of a command, for ffprobe.
std::string output_of(const std::string& command) {
    std::string text;
    std::FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return text;
    std::array<char, 256> chunk;
    while (std::fgets(chunk.data(), static_cast<int>(chunk.size()), pipe) != nullptr) text += chunk.data();
    pclose(pipe);
    return text;
}

Image frame(int width, int height, int number) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.rgb.push_back(static_cast<std::uint8_t>(x * 2 + y + 5 * number + 40 * c));
    return image;
}

class Video : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!VideoWriter::available()) GTEST_SKIP() << "no ffmpeg here";
        std::filesystem::create_directory(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::string probe(const std::string& path) const {
        return output_of(
            "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
            "stream=codec_name,width,height,pix_fmt,nb_read_frames -of csv=p=0 \"" +
            path + "\" 2>/dev/null");
    }
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("calot_video_" + std::to_string(::getpid()));
};

TEST_F(Video, round_trip) {
    const std::string path = (folder / "a b 'c'.mp4").string();
    VideoWriter video(path, 96, 64, 25);
    for (int k = 0; k < 10; ++k) video.add(frame(96, 64, k));
    EXPECT_FALSE(std::filesystem::exists(path));  // not before it is whole
    video.finish();
    EXPECT_GT(std::filesystem::file_size(path), 500u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);  // no temporary left
    EXPECT_THROW(video.add(frame(96, 64, 0)), std::runtime_error);
    const std::string probed = probe(path);
    if (probed.empty()) GTEST_SKIP() << "no ffprobe here";
    EXPECT_EQ(probed, "h264,96,64,yuv420p,10\n");
}

TEST_F(Video, destructor_ends_it_playable) {
    const std::string path = (folder / "left.mp4").string();
    {
        VideoWriter video(path, 96, 64, 25);
        for (int k = 0; k < 4; ++k) video.add(frame(96, 64, k));
    }
    EXPECT_TRUE(std::filesystem::exists(path));
    const std::string probed = probe(path);
    if (!probed.empty()) {
        EXPECT_EQ(probed, "h264,96,64,yuv420p,4\n");
    }
}

TEST_F(Video, odd_sizes_are_padded) {
    const std::string path = (folder / "odd.mp4").string();
    VideoWriter video(path, 95, 63, 25);
    video.add(frame(95, 63, 0));
    video.finish();
    const std::string probed = probe(path);
    if (!probed.empty()) {
        EXPECT_EQ(probed, "h264,96,64,yuv420p,1\n");
    }
}

TEST_F(Video, says_why_it_failed) {
    const std::string path = (folder / "missing" / "video.mp4").string();
    try {
        VideoWriter video(path, 96, 64, 25);
        for (int k = 0; k < 200; ++k) video.add(frame(96, 64, k));  // more than a pipe holds: SIGPIPE must not kill us
        video.finish();
        FAIL() << "a missing folder was not noticed";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos) << error.what();
    }
}

TEST_F(Video, refuses_frames_of_another_size) {
    VideoWriter video((folder / "size.mp4").string(), 96, 64, 25);
    EXPECT_THROW(video.add(frame(64, 96, 0)), std::runtime_error);
}

}  // namespace
}  // namespace calot::render
