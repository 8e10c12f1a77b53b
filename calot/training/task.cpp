#include "calot/training/task.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/scene/suggest.h"
#include "calot/training/task_read.h"

namespace calot::training {

namespace fs = std::filesystem;

bool Bound::met(const Metrics& metrics) const {
    const auto found = metrics.find(metric);
    if (found == metrics.end() || std::isnan(found->second)) return false;
    // A billionth of slack: shares are quotients.
    const double value = found->second, slack = 1e-9 * std::abs(value);
    return (!at_least || value >= *at_least - slack) && (!at_most || value <= *at_most + slack);
}

Task load_task(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream || fs::is_directory(path))
        throw InputError(path, 0, 0, fmt::format("cannot read the task ({})", std::strerror(stream ? EISDIR : errno)),
                         "`calot tasks` lists those that there are");
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return parse_task(bytes.str(), path);
}

std::vector<std::string> list_tasks(const std::vector<std::string>& folders) {
    std::map<std::string, std::string> by_name;
    for (const std::string& folder : folders) {
        std::error_code error;
        for (const auto& entry : fs::directory_iterator(folder, error))
            if (entry.path().extension() == ".toml")
                by_name.emplace(entry.path().stem().string(), entry.path().string());
    }
    std::vector<std::string> paths;
    for (const auto& [name, path] : by_name) paths.push_back(path);
    return paths;
}

std::string find_task(const std::string& name, const std::vector<std::string>& folders) {
    if (name.find('/') != std::string::npos || fs::path(name).extension() == ".toml") return name;
    std::vector<std::string> names;
    for (const std::string& path : list_tasks(folders)) {
        names.push_back(fs::path(path).stem().string());
        if (names.back() == name) return path;
    }
    const std::string near = scene::closest(name, names);
    throw InputError(fmt::format("there is no task '{}'", name),
                     names.empty() ? "there are no task files in " + scene::join(folders)
                                   : (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) +
                                         "tasks: " + scene::join(names) + "; or give the path of a .toml file");
}

std::vector<Target> place_targets(const Task& task, const simulation::Setup& setup) {
    std::vector<Target> targets;
    for (const TargetPlace& place : task.targets) {
        Vec3 position_m = place.offset_m;
        if (!place.landmark.empty()) {
            const auto found = setup.anatomy.landmarks_m.find(place.landmark);
            if (found == setup.anatomy.landmarks_m.end()) {
                std::vector<std::string> names;
                for (const auto& [name, where] : setup.anatomy.landmarks_m) names.push_back(name);
                throw InputError(task.path, 0, 0,
                                 fmt::format("a target names the unknown landmark \"{}\"", place.landmark),
                                 "this anatomy has " + scene::join(names));
            }
            position_m += found->second;
        }
        targets.push_back({position_m, place.radius_m});
    }
    return targets;
}

}  // namespace calot::training
