#pragma once
// Writes a session to its folder while it runs, from a thread of its own: recording.calot and checkpoints.calot.
//
// The physics thread only puts an input into a ring and, once a second, copies the state into a slot, spread over some
// ticks (state_copy.h); it takes no lock and waits for nothing, unless the disk has been stuck for half a minute.
// Inputs are with the system after 0.2 s at most, so that a killed program loses less than a second.

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "calot/simulation/recording.h"
#include "calot/simulation/simulation.h"
#include "calot/training/checkpoints.h"
#include "calot/training/state_copy.h"

namespace calot::training {

class Recorder {
  public:
    static constexpr std::int64_t kTicksPerCheckpoint = 1000;

    /// An earlier recording whose first `ticks` this one begins with.
    struct Prefix {
        const simulation::Recording* recording = nullptr;
        std::string checkpoints;  ///< path of its checkpoints
        std::int64_t ticks = 0;
    };

    /// `initial`: the simulation's state at tick 0. Throws std::system_error when the files cannot be made.
    Recorder(const std::string& folder, const std::string& program_version, const std::string& scene_text,
             const tissue::State& initial, const Prefix& prefix);
    ~Recorder();

    /// Once a tick, after Simulation::tick(input). `aside` is asked for what goes along when a checkpoint is due.
    void after_tick(const simulation::Simulation& run, const tissue::Input& input, const std::function<Aside()>& aside);
    /// Writes what is left and ends the recording. Throws what went wrong with the files.
    void finish(const tissue::State& state);
    /// For people: what went wrong with the files, "" while all is well.
    std::string trouble() const;

  private:
    void work();
    void drain();
    void write_slot();

    static constexpr std::size_t kRing = 1u << 15;
    std::vector<tissue::Input> ring_;
    std::atomic<std::size_t> put_{0}, got_{0};

    struct Slot {
        explicit Slot(const tissue::State& initial) : copy(initial) {}
        StateCopy copy;  ///< of the last checkpoint; the physics thread's while the slot is not full
        Aside aside;
        std::size_t inputs = 0;  ///< put_ when it was filled
        std::atomic<bool> full{false};
    } slot_;

    simulation::RecordingWriter recording_;
    CheckpointWriter checkpoints_;
    std::atomic<bool> stopping_{false}, failed_{false};
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace calot::training
