#pragma once
// Dear ImGui set up as Calot looks: calm, dark, large.

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

    void begin_frame(bool mouse);
    void end_frame();  ///< draws into the bound frame buffer

    const Fonts& fonts() const { return fonts_; }
    float unit() const { return unit_; }  ///< pixels that a length of 1 is at usual resolution

  private:
    Fonts fonts_;
    float unit_;
};

/// Starts a panel without a frame at a place; end with ImGui::End().
bool begin_panel(const char* name, ImVec2 at, ImVec2 pivot, ImVec2 size, float opacity = 0.78f);

}  // namespace calot::window
