#pragma once
// Recordings: the scene, every tick's input, and every second's state hashes. Enough to run it again, bit for bit.
//
// The file is a sequence of chunks that each carry their length and a checksum, appended once a second: whatever kills
// the program, all but the last second stays readable. docs/recording.md describes the bytes.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::simulation {

/// Hashes of all fields (in the order of tissue::fields) when State::tick was `tick`.
struct HashRecord {
    std::int64_t tick = 0;
    std::vector<std::uint64_t> fields;
};

struct Recording {
    std::string program_version;
    std::string scene_text;                ///< Setup::scene_text
    std::vector<std::string> field_names;  ///< of the hashes
    std::vector<tissue::Input> inputs;     ///< input of tick k
    std::vector<HashRecord> hashes;
    bool complete = false;  ///< ended in order, not cut off
};

/// Throws InputError naming the file and the byte when it is not a recording or damaged before its first input; a
/// recording cut off later is returned with what is whole and complete = false.
Recording read_recording(const std::string& path);

class RecordingWriter {
  public:
    /// Creates `path` (replaces what is there). Throws std::system_error when it cannot be written.
    RecordingWriter(const std::string& path, const std::string& program_version, const std::string& scene_text,
                    const tissue::State& state);
    ~RecordingWriter();
    /// Once a tick, after Simulation::tick(input). Writes and flushes a chunk whenever State::tick is a multiple of a
    /// second's ticks.
    void add(const tissue::Input& input, const tissue::State& state);
    /// Whether add() reads the state after this tick.
    bool hashes_at(std::int64_t tick) const { return tick % ticks_per_chunk_ == 0; }
    /// Writes what is left, a last hash record and the end mark.
    void finish(const tissue::State& state);

    // For those that write when they choose (a session's own thread):
    /// One tick's input, kept until the next flush().
    void add(const tissue::Input& input) { pending_.push_back(input); }
    /// Writes and flushes the inputs so far.
    void flush();
    /// The same, and the hashes of the state after the last of them.
    void flush(const tissue::State& state);
    /// Begins with the first `ticks` of an earlier recording: a run that continues from there.
    void adopt(const Recording& earlier, std::int64_t ticks);
    /// Everything written so far is on the disk, not only with the system.
    void sync();

  private:
    struct FileCloser {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, FileCloser> file_;
    std::string path_;
    std::vector<tissue::Input> pending_;
    std::int64_t ticks_per_chunk_ = 1000;
    bool finished_ = false;
};

}  // namespace calot::simulation
