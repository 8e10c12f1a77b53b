#include <cmath>
#include <cstdio>
#include <map>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/simulation/recording.h"
#include "calot/training/session.h"
#include "commands.h"
#include "run.h"

namespace calot::app {

namespace {

/// Compares states with the recording's hashes as the run passes them.
class Verifier {
  public:
    Verifier(const std::string& path, const simulation::Recording& recording) : recording_(recording) {
        tissue::State state;
        std::vector<std::string> names;
        for (const tissue::Field& field : tissue::fields(state)) names.emplace_back(field.name);
        if (names != recording.field_names)
            throw InputError(path, 0, 0,
                             fmt::format("it was made by Calot {}, whose state has other fields than this one's ({})",
                                         recording.program_version, CALOT_VERSION),
                             "verify it with that version; without --verify it can be replayed");
        for (const simulation::HashRecord& record : recording.hashes) by_tick_[record.tick] = &record;
        if (by_tick_.empty())
            throw InputError(path, 0, 0, "the recording holds no hashes to compare with",
                             "record at least a second, or to the end");
    }

    /// False at the first difference.
    bool compare(const tissue::State& state) {
        const auto found = by_tick_.find(state.tick);
        if (found == by_tick_.end()) return true;
        const std::vector<std::uint64_t> now = tissue::hash_fields(state);
        for (std::size_t k = 0; k < now.size(); ++k)
            if (now[k] != found->second->fields[k]) {
                difference_ = fmt::format("first difference at tick {} in {}", state.tick, recording_.field_names[k]);
                return false;
            }
        ++compared_;
        return true;
    }

    const std::string& difference() const { return difference_; }
    int compared() const { return compared_; }

  private:
    const simulation::Recording& recording_;
    std::map<std::int64_t, const simulation::HashRecord*> by_tick_;
    std::string difference_;
    int compared_ = 0;
};

}  // namespace

int replay(const ReplayOptions& options) {
    const simulation::Recording recording = simulation::read_recording(options.recording);
    if (recording.inputs.empty())
        throw InputError(options.recording, 0, 0, "the recording holds no inputs",
                         "it was cut off within its first second");
    if (options.from_s * 1e3 >= static_cast<double>(recording.inputs.size()))
        throw InputError(options.recording, 0, 0, fmt::format("the recording has nothing after {} s", options.from_s),
                         fmt::format("it ends at {:.3f} s", static_cast<double>(recording.inputs.size()) * 1e-3));
    if (!recording.complete)
        fmt::print(stderr, "calot: note: the recording was cut off; it is replayed up to tick {}\n",
                   recording.inputs.size());

    RunPlan plan;
    plan.scene = scene::parse(recording.scene_text, options.recording + " (its scene)", ".");
    const auto setup = std::make_shared<simulation::Setup>(build_setup(plan.scene));
    use_backend(options.backend, *setup);
    plan.setup = setup;
    plan.output = options.output;
    plan.ticks = static_cast<std::int64_t>(recording.inputs.size());
    training::Moment moment;
    if (options.from_s > 0.0) {
        plan.before = &recording;
        plan.reach = [&] {
            moment = training::reach(options.recording, std::llround(options.from_s / plan.setup->model.tick_s), nullptr,
                                     plan.setup);
            return std::move(moment.run);
        };
    }
    plan.input = [&recording](std::int64_t tick, double) { return recording.inputs[static_cast<std::size_t>(tick)]; };
    std::optional<Verifier> verifier;
    if (options.verify) {
        verifier.emplace(options.recording, recording);
        plan.observe = [&](const simulation::Simulation& run, const tissue::Input&) {
            return verifier->compare(run.state());
        };
    }
    const RunRecord record = perform(plan);
    if (options.output.progress != ProgressKind::none) print_outcome(record);
    if (verifier && !verifier->difference().empty()) {
        fmt::print(stderr, "calot: {}: {}\n", options.recording, verifier->difference());
        return kFailed;
    }
    if (verifier && !record.interrupted)
        fmt::print("verified: the state is the same at all {} moments compared, to the last bit\n",
                   verifier->compared());
    return record.exit_code();
}

}  // namespace calot::app
