#pragma once
// The window of the operating system: OpenGL context, keys, mouse, pads. Everything GLFW.

#include <bitset>
#include <string>

#include "calot/viewer/mapping.h"

struct GLFWwindow;

namespace calot::window {

/// Keys that do something once when they go down.
enum class Command {
    pause,
    help,
    pace,
    reset,
    fullscreen,
    mute,
    picture,
    grasp,
    wipe,
    preset1,
    preset2,
    preset3,
    preset4,
    play,     ///< these six on a timeline
    earlier,  ///< again and again while it is held
    later,
    first,
    last,
    enter,
    count
};

class GlfwWindow {
  public:
    /// Throws std::runtime_error saying what is missing (no display, no OpenGL).
    GlfwWindow(int width, int height, const std::string& title, bool fullscreen);
    ~GlfwWindow();
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;

    bool should_close() const;
    void poll();
    /// Sleeps until something happens, at most this long.
    void wait(double most_s);
    void swap();
    /// In pixels; (0, 0) while it is iconified.
    void size(int& width, int& height) const;
    /// How much larger than usual the screen's owner wants things.
    double content_scale() const;
    void toggle_fullscreen();
    /// The pointer disappears and moves without end; buttons are pedals.
    void capture_mouse(bool capture);
    bool captured() const { return captured_; }
    bool focused() const;

    /// What was done since the last call.
    viewer::Devices take_devices();
    bool take(Command command);
    /// While text is being typed, letters and digits are no commands.
    void type(bool typing) { typing_ = typing; }
    std::string renderer() const;  ///< OpenGL's name for it
    GLFWwindow* handle() const { return window_; }

    // For the callbacks.
    void on_key(int key, int action);
    void on_cursor(double x, double y);
    void on_scroll(double notches) { wheel_ += notches; }

  private:
    void read_pads(viewer::Devices& devices);
    void read_pad_buttons(const unsigned char* buttons, viewer::Devices& devices);
    void command(Command which) { commands_.set(static_cast<std::size_t>(which)); }

    GLFWwindow* window_ = nullptr;
    bool captured_ = false;
    bool typing_ = false;
    double cursor_x_ = 0.0, cursor_y_ = 0.0;
    double moved_x_ = 0.0, moved_y_ = 0.0, wheel_ = 0.0;
    std::bitset<static_cast<std::size_t>(Command::count)> commands_;
    std::bitset<16> pad_before_;  ///< buttons of the last sample
    int windowed_[4] = {60, 60, 1280, 800};
};

}  // namespace calot::window
