#include "calot/viewer/data_files.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "calot/base/error.h"

namespace calot::viewer {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> candidates() {
    std::vector<fs::path> places;
    if (const char* chosen = std::getenv("CALOT_DATA"); chosen != nullptr && *chosen != '\0')
        places.emplace_back(chosen);
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (!error) {
        const fs::path bin = program.parent_path();
        places.push_back((bin / "../share/calot").lexically_normal());
        places.push_back((bin / "../../../data").lexically_normal());  // build/PRESET/bin of a source tree
    }
    return places;
}

}  // namespace

std::string data_directory() {
    std::string looked;
    for (const fs::path& place : candidates()) {
        std::error_code error;
        if (fs::is_regular_file(place / "lang/en.toml", error)) return place.string();
        looked += (looked.empty() ? "" : ", ") + place.string();
    }
    throw InputError("the program's data (lang/en.toml) is nowhere to be found; looked in " + looked,
                     "set CALOT_DATA to the directory that holds lang/");
}

std::string scene_file(const std::string& name) {
    const fs::path data = data_directory();
    for (const fs::path& place : {data / "scenes" / name, data / "../scenes" / name}) {
        std::error_code error;
        if (fs::is_regular_file(place, error)) return place.lexically_normal().string();
    }
    throw InputError("the scene " + name + " is not among the program's scenes",
                     "set CALOT_DATA to a directory that holds lang/ and scenes/");
}

}  // namespace calot::viewer
