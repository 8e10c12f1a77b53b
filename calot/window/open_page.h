#pragma once

#include <string>

namespace calot::window {

/// Opens a file in the program that the desktop shows it with (xdg-open). False when that cannot be started.
bool open_page(const std::string& path);

}  // namespace calot::window
