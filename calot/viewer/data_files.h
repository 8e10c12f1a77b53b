#pragma once
// Where the program's own files are: language files, scenes.

#include <string>

namespace calot::viewer {

/// The directory that holds `lang/` and, beside or in it, `scenes/`: $CALOT_DATA, the installed place beside the
/// program (../share/calot), the source tree that it was built from. Throws InputError saying where it looked.
std::string data_directory();

/// A scene of the program's own by file name ("calot.toml"). Throws InputError.
std::string scene_file(const std::string& name);

}  // namespace calot::viewer
