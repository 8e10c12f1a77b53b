// calot haptics: what a haptic device feels, how steadily, and whether energy is ever generated.

#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "commands.h"
#include "haptics_report.h"
#include "output_directory.h"

namespace calot::app {

namespace {

int list(const HapticsOptions& options) {
    for (const haptics::ListedDevice& device : haptics::list_devices(options.openhaptics_library))
        fmt::print("{:<12} {:<12} {}\n", device.kind, device.available ? "available" : "not here", device.state);
    return kDone;
}

/// A file under its final name is complete.
void write_whole(const std::string& path, const std::string& content) {
    const std::string partial = path + ".partial";
    write_file(partial, content);
    std::filesystem::rename(partial, path);
}

}  // namespace

int try_haptics(const HapticsOptions& options) {
    if (options.list) return list(options);
    std::optional<OutputDirectory> directory;
    if (!options.report.empty()) directory.emplace(options.report, options.force);
    const HapticTrial trial = run_trial(options);
    if (directory) {
        write_file(directory->path("summary.json"), trial_json(trial));
        write_file(directory->path("report.html"), trial_html(trial));
        write_file(directory->path("force-depth.svg"), trial_svg(trial));
        write_file(directory->path("trace.csv"), trial_csv(trial));
        directory->commit();
    }
    if (!options.json.empty()) write_whole(options.json, trial_json(trial));
    for (const std::string& note : trial.notes) fmt::print(stderr, "calot: note: {}\n", note);
    fmt::print("{}", trial_text(trial));
    if (directory) fmt::print("\nlook at {}/report.html\n", options.report);
    if (trial.interrupted) return kInterrupted;
    return trial.passive() ? kDone : kFailed;
}

}  // namespace calot::app
