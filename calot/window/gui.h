#pragma once
// Dear ImGui set up as Calot looks: calm, dark, large.

#include <string>

#include <imgui.h>

struct GLFWwindow;

namespace calot::window {

struct Fonts {
    ImFont* text = nullptr;
    ImFont* small = nullptr;
    ImFont* large = nullptr;
    ImFont* title = nullptr;
};

namespace colour {
inline const ImVec4 kText{0.93f, 0.92f, 0.89f, 1.0f};
inline const ImVec4 kFaint{0.62f, 0.62f, 0.60f, 1.0f};
inline const ImVec4 kAccent{0.95f, 0.62f, 0.28f, 1.0f};
inline const ImVec4 kGood{0.52f, 0.80f, 0.50f, 1.0f};
inline const ImVec4 kBad{0.96f, 0.43f, 0.36f, 1.0f};
inline const ImVec4 kYellow{0.98f, 0.80f, 0.20f, 1.0f};
inline const ImVec4 kBlue{0.36f, 0.62f, 0.98f, 1.0f};
}  // namespace colour

/// Owns ImGui's context. Needs the window's OpenGL context.
class Gui {
  public:
    Gui(GLFWwindow* window, double content_scale);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// `mouse`: it is not the hand; `keys`: arrows and Enter go about the panels.
    void begin_frame(bool mouse, bool keys);
    void end_frame();         ///< draws into the bound frame buffer
    void end_unseen_frame();  ///< draws nothing

    const Fonts& fonts() const { return fonts_; }
    float unit() const { return unit_; }  ///< pixels that a length of 1 is at usual resolution

  private:
    Fonts fonts_;
    float unit_;
};

ImVec2 middle_of_screen();
bool wide_button(const Gui& gui, const std::string& label, float height = 52.0f);
/// What is to be done next: stands out.
bool main_button(const Gui& gui, const std::string& label, ImVec2 size);
void heading(const Gui& gui, const std::string& words);
/// Name on the left, value on the right; below one another where both do not fit.
void name_and_value(const std::string& name, const std::string& value, const ImVec4& value_colour = colour::kText);
/// A thin bar, filled from the left as far as `share` says.
void progress(const Gui& gui, double share, const ImVec4& tint = colour::kAccent);
/// With a capital at its beginning, where that is a Latin letter.
std::string capitalised(std::string words);
/// Text in lines as long as there is room.
void wrapped(const std::string& words, const ImVec4& tint = colour::kText);

/// Starts a panel without a frame at a place; end with ImGui::End().
bool begin_panel(const char* name, ImVec2 at, ImVec2 pivot, ImVec2 size, float opacity = 0.78f);

}  // namespace calot::window
