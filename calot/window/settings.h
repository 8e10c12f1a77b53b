#pragma once
// What the trainee may change, kept from one day to the next.

#include <string>

#include "calot/viewer/mapping.h"

namespace calot::window {

struct Settings {
    std::string language = "en";
    int tier = -1;  ///< of viewer::tiers(); -1: chosen automatically
    double volume = 0.6;
    bool muted = false;
    bool show_pace = true;
    double cut_W = 40.0;
    double coag_W = 30.0;
    bool blended_cut = false;
    viewer::Sensitivity hands;
};

/// $XDG_CONFIG_HOME/calot/settings.toml or ~/.config/calot/settings.toml; empty without a home.
std::string settings_path();

/// What the file says; what it lacks, or says wrongly, keeps its default. A missing file is no mistake.
Settings load_settings(const std::string& path);
/// Written beside and renamed. False when that fails: settings are then those of this session alone.
bool save_settings(const std::string& path, const Settings& settings);

}  // namespace calot::window
