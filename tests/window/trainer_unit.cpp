// The trainer as a person meets it: a window, a mouse, keys, pictures of what is seen. On a display out of sight.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include <stb/stb_image.h>

#include "apps/program.h"
#include "calot/training/store.h"
#include "window/display.h"

namespace calot::window::test {
namespace {

using calot::test::Folder;
using calot::test::Program;

constexpr int kWidth = 960, kHeight = 640;
constexpr auto kPatience = std::chrono::seconds(150);  // for machines that do much else

constexpr const char* kBlock = R"(
[scene]
name = "block"
[anatomy]
kind = "block"
[block]
size_mm = [24, 24, 7.2]
[electric]
window_cells = 24
[camera]
eye_offset_mm = [0, -25, 40]
)";

struct Colour {
    double r = 0.0, g = 0.0, b = 0.0;
    double luma() const { return 0.3 * r + 0.59 * g + 0.11 * b; }
};

/// A picture of the window.
class Shot {
  public:
    explicit Shot(const std::string& path) {
        int channels = 0;
        pixels_ = stbi_load(path.c_str(), &width_, &height_, &channels, 3);
    }
    ~Shot() { stbi_image_free(pixels_); }
    Shot(Shot&& other) noexcept
        : pixels_(std::exchange(other.pixels_, nullptr)), width_(other.width_), height_(other.height_) {}
    Shot& operator=(Shot&&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    Colour at(int x, int y) const {
        const unsigned char* p = pixels_ + 3 * (y * width_ + x);
        return {p[0] / 255.0, p[1] / 255.0, p[2] / 255.0};
    }
    Colour mean(int x0, int y0, int x1, int y1) const {
        Colour sum;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) sum.r += at(x, y).r, sum.g += at(x, y).g, sum.b += at(x, y).b;
        const double n = (x1 - x0) * (y1 - y0);
        return {sum.r / n, sum.g / n, sum.b / n};
    }
    /// Share of the pixels in a box that differ visibly from another picture's.
    double changed(const Shot& other, int x0, int y0, int x1, int y1) const {
        int count = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) count += std::fabs(at(x, y).luma() - other.at(x, y).luma()) > 0.08;
        return static_cast<double>(count) / ((x1 - x0) * (y1 - y0));
    }
    double share_brighter(double luma, int x0, int y0, int x1, int y1) const {
        int count = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) count += at(x, y).luma() > luma;
        return static_cast<double>(count) / ((x1 - x0) * (y1 - y0));
    }

  private:
    unsigned char* pixels_ = nullptr;
    int width_ = 0, height_ = 0;
};

/// The program in a window, and the person in front of it.
class Person {
  public:
    explicit Person(const Folder& folder, std::vector<std::string> more = {}) : folder_(folder) {
        ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
        std::vector<std::string> words{"view",       folder.write("block.toml", kBlock),
                                       "--data",     folder / "sessions",
                                       "--pictures", folder.path().string(),
                                       "--width",    std::to_string(kWidth),
                                       "--height",   std::to_string(kHeight)};
        words.insert(words.end(), more.begin(), more.end());
        program_ = std::make_unique<Program>(words);
        // Without a window manager nobody gives the window the keys.
        seen_ = wait([] {
            return run_tool({"xdotool", "search", "--onlyvisible", "--name", "^Calot$", "windowfocus"});
        });
    }
    bool window_opened() const { return seen_; }
    void key(const std::string& name) const { run_tool({"xdotool", "key", name}); }
    void click(int x, int y) const {
        run_tool({"xdotool", "mousemove", std::to_string(x), std::to_string(y)});
        pause(150);
        run_tool({"xdotool", "mousedown", "1"});
        pause(120);
        run_tool({"xdotool", "mouseup", "1"});
    }
    static void pause(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }
    template <class Condition>
    static bool wait(const Condition& condition) {
        const auto until = std::chrono::steady_clock::now() + kPatience;
        while (!condition()) {
            if (std::chrono::steady_clock::now() > until) return false;
            pause(60);
        }
        return true;
    }
    /// F12, as a person would.
    Shot look() {
        char name[32];
        std::snprintf(name, sizeof(name), "calot-%03d.png", ++shots_);
        key("F12");
        const std::string path = folder_ / name;
        EXPECT_TRUE(wait([&] { return std::filesystem::exists(path); })) << path;
        return Shot(path);
    }
    calot::test::Outcome ended() { return program_->wait(); }

  private:
    const Folder& folder_;
    std::unique_ptr<Program> program_;
    bool seen_ = false;
    int shots_ = 0;
};

/// Tissue fills the middle of the round image: warm, neither dark nor blown out.
bool shows_tissue(const Shot& shot) {
    const Colour middle = shot.mean(kWidth / 2 - 120, kHeight / 2 - 60, kWidth / 2 + 120, kHeight / 2 + 120);
    return middle.luma() > 0.12 && middle.r > middle.b + 0.10;
}

/// The patient is there: tissue, and beside it the generator's figures, which the picture behind the loading bar lacks.
bool at_work(const Shot& shot) {
    return shows_tissue(shot) && shot.share_brighter(0.6, 16, kHeight - 250, 316, kHeight - 16) > 0.004;
}

class Trainer : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!display_.works() || !run_tool({"xdotool", "version"})) GTEST_SKIP() << "there is no Xvfb or no xdotool";
    }
    Display display_{kWidth, kHeight};
};

TEST_F(Trainer, start_practice_burn_pause_and_quit) {
    const Folder folder("trainer");
    Person person(folder);
    ASSERT_TRUE(person.window_opened());
    const Shot start = person.look();  // the first frame: it is not empty
    ASSERT_EQ(start.width(), kWidth);
    ASSERT_EQ(start.height(), kHeight);
    // A heading and exercises on the left; on the right what is chosen, and the button that starts it.
    EXPECT_GT(start.share_brighter(0.6, 20, 20, 340, 300), 0.004);
    const Colour button = start.mean(420, 570, 560, 600);
    EXPECT_GT(button.r, 0.6);
    EXPECT_LT(button.b, 0.3);

    person.click(655, 585);
    ASSERT_TRUE(Person::wait([&] { return at_work(person.look()); }));
    Person::pause(600);
    const Shot practice = person.look();
    EXPECT_GT(practice.share_brighter(0.4, kWidth - 290, 16, kWidth - 16, 110), 0.004);  // the exercise's figures

    // The hook follows the mouse, from its first movement on.
    run_tool({"xdotool", "mousemove_relative", "--", "-120", "80"});
    EXPECT_TRUE(
        Person::wait([&] { return person.look().changed(practice, 330, 100, kWidth - 100, kHeight - 60) > 0.004; }));

    // The yellow pedal lights the yellow half of the generator.
    run_tool({"xdotool", "mousedown", "1"});
    const Colour dark = practice.mean(40, kHeight - 198, 150, kHeight - 168);
    EXPECT_TRUE(Person::wait([&] {
        const Colour lit = person.look().mean(40, kHeight - 198, 150, kHeight - 168);
        return lit.r > dark.r + 0.3 && lit.g > dark.g + 0.2 && lit.b < 0.45;
    }));
    run_tool({"xdotool", "mouseup", "1"});

    person.key("Escape");
    EXPECT_TRUE(Person::wait([&] {  // a panel over the middle
        const Shot paused = person.look();
        return paused.mean(kWidth / 2 - 200, kHeight / 2 - 150, kWidth / 2 + 200, kHeight / 2 + 150).luma() < 0.25 &&
               paused.changed(practice, kWidth / 2 - 200, kHeight / 2 - 150, kWidth / 2 + 200, kHeight / 2 + 150) > 0.5;
    }));
    person.click(kWidth / 2, kHeight / 2 + 207);  // the last button: quit
    const auto outcome = person.ended();
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_EQ(outcome.output, "");
}

/// Share of a box that has the yellow pedal's colour.
double yellow(const Shot& shot, int x0, int y0, int x1, int y1) {
    int count = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const Colour c = shot.at(x, y);
            count += c.r > 0.9 && c.g > 0.7 && c.b < 0.35;
        }
    return static_cast<double>(count) / ((x1 - x0) * (y1 - y0));
}

TEST_F(Trainer, a_session_is_answered_for_looked_at_again_and_gone_on_from) {
    const Folder folder("trainer_rewind");
    Person person(folder, {"--start", "free"});
    ASSERT_TRUE(person.window_opened());
    ASSERT_TRUE(Person::wait([&] { return at_work(person.look()); }));
    Person::pause(1500);  // a second before the pedal goes down: a checkpoint lies before it
    run_tool({"xdotool", "mousedown", "1"});
    Person::pause(1200);
    run_tool({"xdotool", "mouseup", "1"});
    Person::pause(800);
    person.key("Escape");
    const auto paused = [&] {
        return person.look().mean(kWidth / 2 - 200, kHeight / 2 - 150, kWidth / 2 + 200, kHeight / 2 + 150).luma() <
               0.25;
    };
    ASSERT_TRUE(Person::wait(paused));
    person.click(kWidth / 2, kHeight / 2 + 147);  // end the exercise
    const auto debriefed = [&] {                  // the button that leads back into the session
        const Colour button = person.look().mean(200, 275, 320, 310);
        return button.r > 0.6 && button.b < 0.3;
    };
    ASSERT_TRUE(Person::wait(debriefed));

    person.click(325, 353);  // twelve questions
    ASSERT_TRUE(Person::wait([&] { return person.look().mean(80, 570, 400, 600).r > 0.6; }));
    person.click(751, 152);  // the first: 3
    Person::pause(400);
    person.click(252, 585);  // store
    ASSERT_TRUE(Person::wait(debriefed));
    training::Store store(folder / "sessions");
    ASSERT_FALSE(store.session(1).answers.empty());
    EXPECT_EQ(store.session(1).answers.front(), 3);
    EXPECT_EQ(store.session(1).answers.back(), std::nullopt);

    person.click(480, 293);  // look again: the timeline has the pedal's yellow
    const auto timeline = [](const Shot& shot) { return yellow(shot, 30, 558, kWidth - 30, 570); };
    ASSERT_TRUE(Person::wait([&] { return timeline(person.look()) > 0.05; }));
    person.key("Home");
    const Shot first = person.look();
    person.click(kWidth - 60, 564);  // near its end: the picture is another
    EXPECT_TRUE(Person::wait([&] { return person.look().changed(first, 30, 552, kWidth - 30, 590) > 0.002; }));
    person.click(kWidth / 2, 564);
    Person::pause(300);
    person.key("Return");  // on from the middle
    ASSERT_TRUE(Person::wait([&] {
        const std::vector<training::SessionRow> rows = store.sessions();
        return rows.size() == 2 && rows.back().parent == 1;
    }));
    EXPECT_NEAR(static_cast<double>(store.session(2).parent_tick) * 1e-3, 0.5 * store.session(1).duration_s, 0.3);
    // After a countdown it runs, and the pedal works.
    Person::pause(4000);
    run_tool({"xdotool", "mousedown", "1"});
    EXPECT_TRUE(Person::wait([&] {
        const Colour lit = person.look().mean(40, kHeight - 198, 150, kHeight - 168);
        return lit.r > 0.7 && lit.g > 0.5 && lit.b < 0.45;
    }));
    run_tool({"xdotool", "mouseup", "1"});
    person.key("Escape");
    ASSERT_TRUE(Person::wait(paused));
    person.click(kWidth / 2, kHeight / 2 + 207);  // quit
    const auto outcome = person.ended();
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_EQ(store.session(2).status, training::SessionStatus::finished);
    EXPECT_GT(store.session(2).duration_s, static_cast<double>(store.session(2).parent_tick) * 1e-3);
}

TEST_F(Trainer, help_covers_and_goes_away_in_another_language) {
    const Folder folder("trainer_help");
    Person person(folder, {"--start", "free", "--language", "de"});
    ASSERT_TRUE(person.window_opened());
    ASSERT_TRUE(Person::wait([&] { return at_work(person.look()); }));
    person.key("F1");
    EXPECT_TRUE(Person::wait([&] {  // much text, and no tissue
        const Shot help = person.look();
        return !shows_tissue(help) && help.share_brighter(0.55, 40, 40, kWidth - 40, kHeight - 40) > 0.005;
    }));
    person.key("F1");
    EXPECT_TRUE(Person::wait([&] { return at_work(person.look()); }));
}

/// Share of a box with writing that says that all is well (green), or not (red).
double written(const Shot& shot, bool well, int x0, int y0, int x1, int y1) {
    int count = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const Colour c = shot.at(x, y);
            count += well ? c.g > 0.4 && c.g > c.r + 0.12 && c.g > c.b + 0.12 : c.r > 0.5 && c.r > c.g + 0.2;
        }
    return static_cast<double>(count) / ((x1 - x0) * (y1 - y0));
}

TEST_F(Trainer, a_device_tells_its_rate_or_why_it_does_not_push) {
    {
        const Folder folder("trainer_device");
        Person person(folder, {"--start", "free", "--haptics", "simulated"});
        ASSERT_TRUE(person.window_opened());
        ASSERT_TRUE(Person::wait([&] { return at_work(person.look()); }));
        // Below name and rates of physics and pictures: its rate, red where this machine is too slow for it.
        EXPECT_TRUE(Person::wait([&] {
            const Shot shot = person.look();
            return written(shot, true, 220, 228, 305, 252) + written(shot, false, 220, 228, 305, 252) > 0.01;
        }));
    }
    const Folder folder("trainer_no_device");
    Person person(folder, {"--start", "free", "--haptics", "network"});  // and nobody connects
    ASSERT_TRUE(person.window_opened());
    ASSERT_TRUE(Person::wait([&] { return at_work(person.look()); }));
    EXPECT_TRUE(Person::wait([&] { return written(person.look(), false, 30, 228, 200, 252) > 0.01; }));
}

}  // namespace
}  // namespace calot::window::test

#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
