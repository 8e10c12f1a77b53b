#pragma once
// A small field with a duct and an artery under fat, and a hand that burns into it: what the tests of training share.

#include <memory>

#include <unistd.h>

#include <filesystem>
#include <string>

#include "calot/scene/scene.h"
#include "calot/simulation/simulation.h"
#include "calot/training/task.h"

namespace calot::test {

/// The standard patient, coarse: 1.2 mm hexels; the hook comes down over the duct and burns for 0.3 s.
inline const std::shared_ptr<const simulation::Setup>& coarse_setup() {
    static const std::shared_ptr<const simulation::Setup> setup = [] {
        const scene::Scene scene = scene::parse(R"(
[scene]
name = "coarse"
[triangle]
fat_thickness_mm = 2.4
[sampling]
hexel_spacing_mm = 1.2
[electric]
window_cells = 24
[hook]
trocar = "trocar"
[camera]
eye = "camera"
target = "camera_target"
[run]
duration_s = 1.2
[[script.key]]
t = 0
at = "front_of_duct"
offset_mm = [-3, 0, 3]
[[script.key]]
t = 0.3
at = "front_of_duct"
offset_mm = [-2, 0, -2.5]
[[script.key]]
t = 1.2
at = "front_of_duct"
offset_mm = [3, 0, -3]
[[script.burst]]
from = 0.1
to = 1.1
power_W = 80
)",
                                                "coarse.toml", ".");
        return std::make_shared<const simulation::Setup>(scene::build(scene));
    }();
    return setup;
}

inline constexpr const char* kTaskText = R"([task]
title = "A test"
goal = "Burn a little."
scene = "coarse.toml"
[[target]]
at = "front_of_duct"
radius_mm = 20
[[end]]
metric = "fat_removed_m3"
at_least = 100000
[[limit]]
metric = "activation_s"
at_most = 0.5
cap = 60
message = "too long"
[[score]]
metric = "fat_removed_m3"
weight = 3
worst = 0
best = 20
tip = "burn more"
[[score]]
metric = "activation_s"
weight = 1
worst = 2
best = 0
)";

/// A folder of the test's own, gone afterwards.
class TestFolder {
  public:
    explicit TestFolder(const std::string& name)
        : path_((std::filesystem::temp_directory_path() / ("calot_" + name + "." + std::to_string(::getpid())))
                    .string()) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace calot::test
