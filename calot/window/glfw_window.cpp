#include "calot/window/glfw_window.h"

#include <stdexcept>
#include <utility>

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "calot/render/gl.h"
#include "calot/window/bindings.h"

namespace calot::window {

namespace {

std::string glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason given";
}

GlfwWindow& owner(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
}

}  // namespace

GlfwWindow::GlfwWindow(int width, int height, const std::string& title, bool fullscreen) {
    const render::gl::DriverLeaksIgnored ignored;
    if (glfwInit() != GLFW_TRUE)
        throw std::runtime_error(
            "cannot open a window: " + glfw_error() +
            "; `calot view` needs a display (DISPLAY or WAYLAND_DISPLAY); on a machine without one, "
            "`xvfb-run calot view` opens it out of sight");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);  // the scene has its own
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        const std::string reason = glfw_error();
        glfwTerminate();
        throw std::runtime_error("cannot open a window with OpenGL 3.3: " + reason +
                                 "; on Debian install libgl1-mesa-dri");
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowSizeLimits(window_, 640, 420, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) { owner(w).on_key(key, action); });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { owner(w).on_cursor(x, y); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { owner(w).on_scroll(y); });
    if (fullscreen) toggle_fullscreen();
}

GlfwWindow::~GlfwWindow() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool GlfwWindow::should_close() const {
    return glfwWindowShouldClose(window_) != 0;
}
void GlfwWindow::poll() {
    glfwPollEvents();
}
void GlfwWindow::wait(double most_s) {
    glfwWaitEventsTimeout(most_s);
}
void GlfwWindow::swap() {
    glfwSwapBuffers(window_);
}

bool GlfwWindow::focused() const {
    return glfwGetWindowAttrib(window_, GLFW_FOCUSED) != 0;
}

void GlfwWindow::size(int& width, int& height) const {
    glfwGetFramebufferSize(window_, &width, &height);
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0) width = height = 0;
}

double GlfwWindow::content_scale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_, &x, &y);
    return static_cast<double>(y);
}

void GlfwWindow::toggle_fullscreen() {
    if (glfwGetWindowMonitor(window_) != nullptr) {
        glfwSetWindowMonitor(window_, nullptr, windowed_[0], windowed_[1], windowed_[2], windowed_[3], GLFW_DONT_CARE);
        return;
    }
    glfwGetWindowPos(window_, &windowed_[0], &windowed_[1]);
    glfwGetWindowSize(window_, &windowed_[2], &windowed_[3]);
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr) return;
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    glfwSwapInterval(1);
}

void GlfwWindow::capture_mouse(bool capture) {
    if (capture == captured_) return;
    captured_ = capture;
    moved_x_ = moved_y_ = wheel_ = 0.0;
    glfwSetInputMode(window_, GLFW_CURSOR, capture ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    glfwGetCursorPos(window_, &cursor_x_, &cursor_y_);  // movement starts from here
}

std::string GlfwWindow::renderer() const {
    const auto* name = glGetString(GL_RENDERER);
    return name != nullptr ? reinterpret_cast<const char*>(name) : "?";
}

void GlfwWindow::on_key(int key, int action) {
    if (action == GLFW_RELEASE || (typing_ && key < GLFW_KEY_ESCAPE)) return;
    if (action == GLFW_REPEAT && key != GLFW_KEY_LEFT && key != GLFW_KEY_RIGHT) return;
    static constexpr std::pair<int, Command> kCommands[] = {
        {GLFW_KEY_ESCAPE, Command::pause},   {GLFW_KEY_P, Command::pause},      {GLFW_KEY_F1, Command::help},
        {GLFW_KEY_H, Command::help},         {GLFW_KEY_F2, Command::pace},      {GLFW_KEY_F5, Command::reset},
        {GLFW_KEY_F11, Command::fullscreen}, {GLFW_KEY_M, Command::mute},       {GLFW_KEY_F12, Command::picture},
        {GLFW_KEY_R, Command::grasp},        {GLFW_KEY_X, Command::wipe},       {GLFW_KEY_1, Command::preset1},
        {GLFW_KEY_2, Command::preset2},      {GLFW_KEY_3, Command::preset3},    {GLFW_KEY_4, Command::preset4},
        {GLFW_KEY_SPACE, Command::play},     {GLFW_KEY_LEFT, Command::earlier}, {GLFW_KEY_RIGHT, Command::later},
        {GLFW_KEY_HOME, Command::first},     {GLFW_KEY_END, Command::last},     {GLFW_KEY_ENTER, Command::enter},
    };
    for (const auto& [wanted, which] : kCommands)
        if (key == wanted) command(which);
}

void GlfwWindow::on_cursor(double x, double y) {
    moved_x_ += x - cursor_x_;
    moved_y_ += y - cursor_y_;
    cursor_x_ = x;
    cursor_y_ = y;
}

viewer::Devices GlfwWindow::take_devices() {
    viewer::Devices devices;
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    if (captured_ && height > 0) {
        devices.mouse_right = moved_x_ / height;
        devices.mouse_up = -moved_y_ / height;
        devices.wheel = wheel_;
        devices.hold(viewer::Action::yellow_pedal, glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS);
        devices.hold(viewer::Action::blue_pedal, glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS);
        for (const HeldKey& held : held_keys()) devices.hold(held.action, glfwGetKey(window_, held.key) == GLFW_PRESS);
    }
    moved_x_ = moved_y_ = wheel_ = 0.0;
    read_pads(devices);
    return devices;
}

bool GlfwWindow::take(Command which) {
    const auto bit = static_cast<std::size_t>(which);
    const bool was = commands_.test(bit);
    commands_.reset(bit);
    return was;
}

void GlfwWindow::read_pads(viewer::Devices& devices) {
    using viewer::Action;
    for (int joystick = GLFW_JOYSTICK_1; joystick <= GLFW_JOYSTICK_LAST; ++joystick) {
        if (glfwJoystickPresent(joystick) == GLFW_FALSE) continue;
        GLFWgamepadstate state;
        if (glfwGetGamepadState(joystick, &state) == GLFW_TRUE) {
            devices.pad.hook_right = state.axes[GLFW_GAMEPAD_AXIS_RIGHT_X];
            devices.pad.hook_up = -state.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y];
            devices.pad.left_right = state.axes[GLFW_GAMEPAD_AXIS_LEFT_X];
            devices.pad.left_up = -state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y];
            devices.hold(Action::yellow_pedal, state.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] > 0.0f);
            devices.hold(Action::blue_pedal, state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] > 0.0f);
            read_pad_buttons(state.buttons, devices);
            continue;
        }
        // No pad that is known: a foot switch. Its first button is the yellow pedal, its second the blue one.
        int count = 0;
        const unsigned char* buttons = glfwGetJoystickButtons(joystick, &count);
        devices.hold(Action::yellow_pedal, count > 0 && buttons[0] == GLFW_PRESS);
        devices.hold(Action::blue_pedal, count > 1 && buttons[1] == GLFW_PRESS);
    }
}

void GlfwWindow::read_pad_buttons(const unsigned char* buttons, viewer::Devices& devices) {
    using viewer::Action;
    devices.pad.hook_depth = buttons[GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER] == GLFW_PRESS;
    devices.pad.left_depth = buttons[GLFW_GAMEPAD_BUTTON_LEFT_BUMPER] == GLFW_PRESS;
    devices.hold(Action::suction, buttons[GLFW_GAMEPAD_BUTTON_X] == GLFW_PRESS);
    devices.hold(Action::irrigation, buttons[GLFW_GAMEPAD_BUTTON_Y] == GLFW_PRESS);
    devices.hold(Action::scope_in, buttons[GLFW_GAMEPAD_BUTTON_DPAD_UP] == GLFW_PRESS);
    devices.hold(Action::scope_out, buttons[GLFW_GAMEPAD_BUTTON_DPAD_DOWN] == GLFW_PRESS);
    devices.hold(Action::scope_left, buttons[GLFW_GAMEPAD_BUTTON_DPAD_LEFT] == GLFW_PRESS);
    devices.hold(Action::scope_right, buttons[GLFW_GAMEPAD_BUTTON_DPAD_RIGHT] == GLFW_PRESS);
    std::bitset<16> now;
    for (std::size_t k = 0; k <= GLFW_GAMEPAD_BUTTON_LAST; ++k) now.set(k, buttons[k] == GLFW_PRESS);
    const std::bitset<16> pressed = now & ~pad_before_;
    pad_before_ = now;
    if (pressed.test(GLFW_GAMEPAD_BUTTON_A)) command(Command::grasp);
    if (pressed.test(GLFW_GAMEPAD_BUTTON_B)) command(Command::wipe);
    if (pressed.test(GLFW_GAMEPAD_BUTTON_START)) command(Command::pause);
    if (pressed.test(GLFW_GAMEPAD_BUTTON_BACK)) command(Command::preset1);
}

}  // namespace calot::window
