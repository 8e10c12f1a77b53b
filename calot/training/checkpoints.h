#pragma once
// Checkpoints beside a recording: whole states, a second apart, so that any moment can be reached without running all
// that came before. docs/sessions.md describes the bytes.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "calot/base/archive.h"
#include "calot/tissue/state.h"

namespace calot::training {

/// States are complete only at multiples of this many ticks (Model::frame_ticks).
bool can_be_stored(const tissue::Model& model, std::int64_t tick);

/// What goes along with a state.
struct Aside {
    std::string measured;  ///< Meter::save()
    std::string effects;   ///< Simulation::archive_effects()
    void archive(Archive& archive) {
        archive.value(measured);
        archive.value(effects);
    }
};

class CheckpointReader;

class CheckpointWriter {
  public:
    /// Creates the file. `initial`: the state at tick 0; others are stored as differences from it, so that untouched
    /// tissue costs next to nothing. Throws std::system_error.
    CheckpointWriter(const std::string& path, const tissue::State& initial);
    /// Appends a state (State::tick says when) and what goes along with it, compressed and flushed.
    void add(const tissue::State& state, const Aside& aside);
    /// Takes over, as they lie, the checkpoints of another file up to `tick`: those of the run that this one continues.
    void adopt(const std::string& path, std::int64_t tick);

  private:
    struct FileCloser {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::string path_;
    std::unique_ptr<std::FILE, FileCloser> file_;
    std::string initial_, raw_, stored_;
};

class CheckpointReader {
  public:
    /// Finds what is whole in the file; damaged or cut-off checkpoints are left out. A missing file, or one of
    /// an older version, holds none. Throws InputError when it is something else than checkpoints.
    explicit CheckpointReader(const std::string& path);

    /// The file is of an older version of Calot: moments are reached from the start, which takes longer.
    bool older() const { return older_; }
    /// Ascending.
    std::vector<std::int64_t> ticks() const;
    /// The last at or before `tick`; -1 when there is none.
    std::int64_t last_before(std::int64_t tick) const;
    /// Reads one into `state`, which must be the simulation's state at tick 0, and what goes along with it. Throws
    /// InputError when it is damaged or belongs to another scene or version.
    void read(std::int64_t tick, tissue::State& state, Aside& aside) const;

  private:
    friend class CheckpointWriter;
    struct Entry {
        std::int64_t tick = 0;
        long offset = 0;
        std::uint32_t stored_bytes = 0;
        std::uint64_t raw_bytes = 0, checksum = 0;
    };
    std::string path_;
    std::vector<Entry> entries_;
    bool older_ = false;
};

}  // namespace calot::training
