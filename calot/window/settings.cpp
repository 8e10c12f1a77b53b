#include "calot/window/settings.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <toml++/toml.h>

#include "calot/viewer/quality.h"

namespace calot::window {

namespace {

double number(const toml::table& table, const char* key, double otherwise, double least, double most) {
    const double value = table[key].value_or(otherwise);
    return value >= least && value <= most ? value : otherwise;
}

}  // namespace

std::string settings_path() {
    const char* config = std::getenv("XDG_CONFIG_HOME");
    if (config != nullptr && *config != '\0') return std::string(config) + "/calot/settings.toml";
    const char* home = std::getenv("HOME");
    return home != nullptr && *home != '\0' ? std::string(home) + "/.config/calot/settings.toml" : "";
}

Settings load_settings(const std::string& path) {
    Settings settings;
    std::error_code error;
    if (path.empty() || !std::filesystem::is_regular_file(path, error)) return settings;
    toml::table table;
    try {
        table = toml::parse_file(path);
    } catch (const toml::parse_error&) {
        return settings;
    }
    settings.language = table["language"].value_or(settings.language);
    settings.tier =
        static_cast<int>(number(table, "picture_tier", -1.0, -1.0, static_cast<double>(viewer::tiers().size()) - 1.0));
    settings.volume = number(table, "volume", settings.volume, 0.0, 1.0);
    settings.muted = table["muted"].value_or(settings.muted);
    settings.show_pace = table["show_pace"].value_or(settings.show_pace);
    settings.cut_W = number(table, "cut_W", settings.cut_W, 1.0, 120.0);
    settings.coag_W = number(table, "coag_W", settings.coag_W, 1.0, 120.0);
    settings.blended_cut = table["blended_cut"].value_or(settings.blended_cut);
    settings.hands.mouse = number(table, "mouse_sensitivity", settings.hands.mouse, 0.05, 4.0);
    settings.hands.wheel_m = 1e-3 * number(table, "wheel_mm", 1e3 * settings.hands.wheel_m, 0.1, 10.0);
    settings.hands.invert_wheel = table["invert_wheel"].value_or(settings.hands.invert_wheel);
    return settings;
}

bool save_settings(const std::string& path, const Settings& settings) {
    if (path.empty()) return false;
    namespace fs = std::filesystem;
    std::error_code error;
    fs::create_directories(fs::path(path).parent_path(), error);
    const toml::table table{{"language", settings.language},
                            {"picture_tier", settings.tier},
                            {"volume", settings.volume},
                            {"muted", settings.muted},
                            {"show_pace", settings.show_pace},
                            {"cut_W", settings.cut_W},
                            {"coag_W", settings.coag_W},
                            {"blended_cut", settings.blended_cut},
                            {"mouse_sensitivity", settings.hands.mouse},
                            {"wheel_mm", 1e3 * settings.hands.wheel_m},
                            {"invert_wheel", settings.hands.invert_wheel}};
    {
        std::ofstream file(path + ".partial");
        file << table << "\n";
        if (!file.flush()) return false;
    }
    fs::rename(path + ".partial", path, error);
    return !error;
}

}  // namespace calot::window
