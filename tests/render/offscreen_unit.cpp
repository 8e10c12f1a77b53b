#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "calot/base/error.h"
#include "calot/render/renderer.h"

namespace calot::render {
namespace {

TEST(Offscreen, says_what_it_is) {
    OffscreenContext context;
    EXPECT_NE(context.description().find("OpenGL"), std::string::npos);
}

TEST(Offscreen, contexts_may_follow_one_another) {
    { OffscreenContext context; }
    { OffscreenContext context; }
}

TEST(Offscreen, missing_drivers_give_a_clear_error) {
    // A process of its own, as the library of vendors is loaded once: with no vendor EGL has no display.
    ::testing::FLAGS_gtest_death_test_style = "threadsafe";
    auto attempt = [] {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/none.json", 1);
        setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nowhere", 1);
        try {
            OffscreenContext context;
        } catch (const std::runtime_error& error) {
            std::fprintf(stderr, "%s\n", error.what());
            std::exit(3);
        }
        std::exit(0);
    };
    EXPECT_EXIT(attempt(), ::testing::ExitedWithCode(3), "EGL");
}

TEST(Png, is_whole_and_leaves_no_temporary) {
    const auto folder = std::filesystem::temp_directory_path() / ("calot_png_" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder);
    const Image image{2, 3, std::vector<std::uint8_t>(18, 77)};
    const std::string path = (folder / "picture.png").string();
    write_png(path, image);
    std::ifstream file(path, std::ios::binary);
    std::string head(8, '\0');
    file.read(head.data(), 8);
    EXPECT_EQ(head, "\x89PNG\r\n\x1a\n");
    EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
    EXPECT_THROW(write_png((folder / "missing" / "picture.png").string(), image), InputError);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace calot::render
