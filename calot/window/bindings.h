#pragma once
// Which key does what: read by the window, shown by the help.

#include <vector>

#include "calot/viewer/mapping.h"

namespace calot::window {

/// Keys that are held.
struct HeldKey {
    int key;  ///< GLFW_KEY_...
    viewer::Action action;
};
const std::vector<HeldKey>& held_keys();

/// A line of the help: what to press, and the language file's key that says what it does.
struct HelpLine {
    const char* keys;  ///< of the language file too, where words are in it
    const char* text;
};
struct HelpGroup {
    const char* title;
    std::vector<HelpLine> lines;
};
const std::vector<HelpGroup>& help();

}  // namespace calot::window
