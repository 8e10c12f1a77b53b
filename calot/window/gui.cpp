#include "calot/window/gui.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace calot::window {

namespace {

/// The first font file that exists; empty: ImGui's own.
std::string font_file() {
    for (const char* path :
         {"/usr/share/fonts/truetype/open-sans/OpenSans-Regular.ttf", "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
          "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(path, error)) return path;
    }
    return "";
}

ImFont* load_font(const std::string& file, float pixels) {
    ImGuiIO& io = ImGui::GetIO();
    if (!file.empty()) {
        // Latin with its accents, Greek, punctuation, ohms, minus and comparisons.
        static const ImWchar ranges[] = {0x20,   0x17f,  0x370,  0x3ff,  0x2010, 0x2044, 0x2126,
                                         0x2126, 0x2212, 0x2212, 0x2260, 0x2265, 0};
        if (ImFont* font = io.Fonts->AddFontFromFileTTF(file.c_str(), pixels, nullptr, ranges)) return font;
    }
    ImFontConfig config;
    config.SizePixels = pixels;
    return io.Fonts->AddFontDefault(&config);
}

void set_style(float unit) {
    ImGuiStyle& style = ImGui::GetStyle();
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = 10.0f;
    style.FrameRounding = 7.0f;
    style.GrabRounding = 7.0f;
    style.PopupRounding = 7.0f;
    style.WindowBorderSize = 0.0f;
    style.WindowPadding = ImVec2(18.0f, 14.0f);
    style.FramePadding = ImVec2(14.0f, 9.0f);
    style.ItemSpacing = ImVec2(10.0f, 8.0f);
    style.Colors[ImGuiCol_Text] = colour::kText;
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.045f, 0.05f, 0.055f, 0.9f);
    style.Colors[ImGuiCol_PopupBg] = ImVec4(0.07f, 0.075f, 0.08f, 0.98f);
    style.Colors[ImGuiCol_Button] = ImVec4(0.16f, 0.17f, 0.18f, 1.0f);
    style.Colors[ImGuiCol_ButtonHovered] = ImVec4(0.30f, 0.23f, 0.16f, 1.0f);
    style.Colors[ImGuiCol_ButtonActive] = ImVec4(0.52f, 0.34f, 0.16f, 1.0f);
    style.Colors[ImGuiCol_FrameBg] = ImVec4(0.13f, 0.14f, 0.15f, 1.0f);
    style.Colors[ImGuiCol_FrameBgHovered] = ImVec4(0.19f, 0.19f, 0.19f, 1.0f);
    style.Colors[ImGuiCol_FrameBgActive] = ImVec4(0.24f, 0.22f, 0.19f, 1.0f);
    style.Colors[ImGuiCol_Header] = ImVec4(0.30f, 0.23f, 0.16f, 1.0f);
    style.Colors[ImGuiCol_HeaderHovered] = ImVec4(0.36f, 0.27f, 0.18f, 1.0f);
    style.Colors[ImGuiCol_HeaderActive] = ImVec4(0.52f, 0.34f, 0.16f, 1.0f);
    style.Colors[ImGuiCol_SliderGrab] = colour::kAccent;
    style.Colors[ImGuiCol_SliderGrabActive] = colour::kAccent;
    style.Colors[ImGuiCol_CheckMark] = colour::kAccent;
    style.Colors[ImGuiCol_PlotHistogram] = colour::kAccent;
    style.ScaleAllSizes(unit);
}

}  // namespace

Gui::Gui(GLFWwindow* window, double content_scale) : unit_(static_cast<float>(content_scale)) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // panels stay where they are
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard | ImGuiConfigFlags_NavEnableGamepad;
    const std::string file = font_file();
    fonts_.text = load_font(file, 21.0f * unit_);
    fonts_.small = load_font(file, 17.0f * unit_);
    fonts_.large = load_font(file, 34.0f * unit_);
    fonts_.title = load_font(file, 54.0f * unit_);
    set_style(unit_);
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::begin_frame(bool mouse, bool keys) {
    ImGuiIO& io = ImGui::GetIO();
    // While the mouse is the hand, panels must not answer to it, nor keys move a focus about.
    const ImGuiConfigFlags hands_off = ImGuiConfigFlags_NoMouse;
    const ImGuiConfigFlags navigation = ImGuiConfigFlags_NavEnableKeyboard | ImGuiConfigFlags_NavEnableGamepad;
    io.ConfigFlags =
        (io.ConfigFlags & ~(hands_off | navigation)) | (mouse ? 0 : hands_off) | (mouse && keys ? navigation : 0);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Gui::end_unseen_frame() {
    ImGui::EndFrame();
}

void Gui::end_frame() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void progress(const Gui& gui, double share, const ImVec4& tint) {
    const float u = gui.unit(), width = ImGui::GetContentRegionAvail().x, height = 6.0f * u;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const auto filled = static_cast<float>(std::clamp(share, 0.0, 1.0)) * width;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + width, at.y + height), ImGui::GetColorU32(ImGuiCol_FrameBg), 3.0f * u);
    if (filled >= 1.0f)
        list->AddRectFilled(at, ImVec2(at.x + filled, at.y + height), ImGui::GetColorU32(tint), 3.0f * u);
    ImGui::Dummy(ImVec2(width, height + 4.0f * u));
}

ImVec2 middle_of_screen() {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    return ImVec2(0.5f * screen.x, 0.5f * screen.y);
}

bool wide_button(const Gui& gui, const std::string& label, float height) {
    return ImGui::Button(label.c_str(), ImVec2(-1.0f, height * gui.unit()));
}

bool main_button(const Gui&, const std::string& label, ImVec2 size) {
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.80f, 0.48f, 0.16f, 1.0f));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImVec4(0.90f, 0.57f, 0.22f, 1.0f));
    ImGui::PushStyleColor(ImGuiCol_ButtonActive, ImVec4(0.96f, 0.66f, 0.32f, 1.0f));
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.06f, 0.05f, 0.04f, 1.0f));
    const bool pressed = ImGui::Button(label.c_str(), size);
    ImGui::PopStyleColor(4);
    return pressed;
}

void heading(const Gui& gui, const std::string& words) {
    ImGui::PushFont(gui.fonts().large);
    wrapped(words, colour::kAccent);
    ImGui::PopFont();
    ImGui::Dummy(ImVec2(1.0f, 4.0f * gui.unit()));
}

void name_and_value(const std::string& name, const std::string& value, const ImVec4& value_colour) {
    const float room = ImGui::GetContentRegionAvail().x, start = ImGui::GetCursorPosX();
    const float width = ImGui::CalcTextSize(value.c_str()).x;
    const bool together = ImGui::CalcTextSize(name.c_str()).x + width + ImGui::GetStyle().ItemSpacing.x <= room;
    wrapped(name, colour::kFaint);
    if (together) ImGui::SameLine();
    ImGui::SetCursorPosX(start + room - width);
    ImGui::TextColored(value_colour, "%s", value.c_str());
}

std::string capitalised(std::string words) {
    if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
    return words;
}

void wrapped(const std::string& words, const ImVec4& tint) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored(tint, "%s", words.c_str());
    ImGui::PopTextWrapPos();
}

bool begin_panel(const char* name, ImVec2 at, ImVec2 pivot, ImVec2 size, float opacity) {
    ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
    ImGui::SetNextWindowSize(size, ImGuiCond_Always);
    ImGui::SetNextWindowBgAlpha(opacity);
    return ImGui::Begin(name, nullptr,
                        ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                            ImGuiWindowFlags_NoFocusOnAppearing);
}

}  // namespace calot::window
