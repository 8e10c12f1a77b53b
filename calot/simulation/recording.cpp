#include "calot/simulation/recording.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <unistd.h>
#include <zstd.h>

#include "calot/base/error.h"
#include "calot/base/hash.h"

// File = magic, then chunks:
//
//   | kind u32 | raw bytes u32 | stored bytes u32 | reserved u32 | XXH3 of the stored bytes u64 | stored bytes ... |
//
// All integers and doubles are little-endian. Kinds: scene (once, first), inputs, hashes, end (once, last).
// Inputs come as one hand's (72 bytes a tick, versions before 0.2) or as both hands' (144).

namespace calot::simulation {

namespace {

constexpr char kMagic[8] = {'C', 'A', 'L', 'O', 'T', 'R', 'E', '1'};
enum class Kind : std::uint32_t { scene = 1, hook_inputs = 2, hashes = 3, end = 4, inputs = 5 };

struct ChunkHeader {
    std::uint32_t kind = 0;
    std::uint32_t raw_bytes = 0;
    std::uint32_t stored_bytes = 0;
    std::uint32_t reserved = 0;
    std::uint64_t checksum = 0;
};
static_assert(sizeof(ChunkHeader) == 24);
constexpr std::uint32_t kMaxChunkBytes = 64u << 20;

/// One tick's input, as it lies in the file: the hook's hand and the foot, then the grasper's hand.
struct StoredHook {
    double position_m[3];
    double orientation[4];  ///< w x y z
    double power_setting_W;
    std::uint8_t pedal;
    std::uint8_t mode;
    std::uint8_t wipe_tip;
    std::uint8_t suction, irrigation;  ///< zero in older recordings
    std::uint8_t reserved[3];
};
static_assert(sizeof(StoredHook) == 72);
struct StoredGrasper {
    double position_m[3];
    double orientation[4];  ///< w x y z
    double jaw;
    std::uint8_t present;
    std::uint8_t reserved[7];
};
static_assert(sizeof(StoredGrasper) == 72);

template <class Stored>
void store_pose(const tissue::Pose& pose, Stored& stored) {
    for (int c = 0; c < 3; ++c) stored.position_m[c] = pose.position_m[c];
    const Quat& q = pose.orientation;
    const double wxyz[4] = {q.w, q.x, q.y, q.z};
    std::memcpy(stored.orientation, wxyz, sizeof(wxyz));
}
template <class Stored>
tissue::Pose load_pose(const Stored& stored) {
    return {Vec3(stored.position_m[0], stored.position_m[1], stored.position_m[2]),
            Quat(stored.orientation[0], stored.orientation[1], stored.orientation[2], stored.orientation[3])};
}

StoredHook store_hook(const tissue::Input& input) {
    StoredHook stored{};
    store_pose(input.hook, stored);
    stored.power_setting_W = input.power_setting_W;
    stored.pedal = input.pedal ? 1 : 0;
    stored.wipe_tip = input.wipe_tip ? 1 : 0;
    stored.suction = input.suction ? 1 : 0;
    stored.irrigation = input.irrigation ? 1 : 0;
    stored.mode = static_cast<std::uint8_t>(input.mode);
    return stored;
}

StoredGrasper store_grasper(const tissue::Input& input) {
    StoredGrasper stored{};
    store_pose(input.grasper.pose, stored);
    stored.jaw = input.grasper.jaw;
    stored.present = input.grasper.present ? 1 : 0;
    return stored;
}

tissue::Input load(const StoredHook& stored) {
    tissue::Input input;
    input.hook = load_pose(stored);
    input.power_setting_W = stored.power_setting_W;
    input.pedal = stored.pedal != 0;
    input.wipe_tip = stored.wipe_tip != 0;
    input.suction = stored.suction != 0;
    input.irrigation = stored.irrigation != 0;
    input.mode = static_cast<tissue::GeneratorMode>(stored.mode);
    return input;
}

void append(std::string& bytes, const void* data, std::size_t count) {
    bytes.append(static_cast<const char*>(data), count);
}
void append_text(std::string& bytes, const std::string& text) {
    const auto count = static_cast<std::uint32_t>(text.size());
    append(bytes, &count, sizeof(count));
    bytes += text;
}

[[noreturn]] void fail(const std::string& path) {
    throw std::system_error(errno, std::generic_category(), "cannot write " + path);
}

void write_chunk(std::FILE* file, const std::string& path, Kind kind, const std::string& raw) {
    std::string stored(ZSTD_compressBound(raw.size()), '\0');
    stored.resize(ZSTD_compress(stored.data(), stored.size(), raw.data(), raw.size(), 3));
    ChunkHeader header;
    header.kind = static_cast<std::uint32_t>(kind);
    header.raw_bytes = static_cast<std::uint32_t>(raw.size());
    header.stored_bytes = static_cast<std::uint32_t>(stored.size());
    header.checksum = hash_bytes(stored.data(), stored.size());
    if (std::fwrite(&header, sizeof(header), 1, file) != 1 ||
        std::fwrite(stored.data(), 1, stored.size(), file) != stored.size())
        fail(path);
}

std::string hash_chunk(const HashRecord& record) {
    std::string raw;
    append(raw, &record.tick, sizeof(record.tick));
    append(raw, record.fields.data(), record.fields.size() * sizeof(std::uint64_t));
    return raw;
}

/// Reads from a chunk's bytes; throws InputError past their end.
class Reader {
  public:
    Reader(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}
    template <class T>
    T value() {
        T out;
        take(&out, sizeof(T));
        return out;
    }
    std::string text() {
        std::string out(value<std::uint32_t>(), '\0');
        take(out.data(), out.size());
        return out;
    }
    std::size_t left() const { return bytes_.size() - at_; }

  private:
    void take(void* out, std::size_t count) {
        if (count > left()) throw InputError(path_, 0, 0, "the recording's chunk is shorter than it says");
        std::memcpy(out, bytes_.data() + at_, count);
        at_ += count;
    }
    const std::string& path_;
    const std::string& bytes_;
    std::size_t at_ = 0;
};

void read_scene_chunk(const std::string& path, const std::string& raw, Recording& recording) {
    Reader reader(path, raw);
    recording.program_version = reader.text();
    recording.scene_text = reader.text();
    const auto names = reader.value<std::uint32_t>();
    for (std::uint32_t k = 0; k < names; ++k) recording.field_names.push_back(reader.text());
}

void read_inputs_chunk(const std::string& path, const std::string& raw, bool grasper, Recording& recording) {
    Reader reader(path, raw);
    while (reader.left() > 0) {
        const auto stored = reader.value<StoredHook>();
        if (stored.mode > static_cast<std::uint8_t>(tissue::GeneratorMode::coag))
            throw InputError(path, 0, 0, "the recording names a generator mode that this version does not know");
        recording.inputs.push_back(load(stored));
        if (!grasper) continue;
        const auto hand = reader.value<StoredGrasper>();
        recording.inputs.back().grasper = {hand.present != 0, load_pose(hand), hand.jaw};
    }
}

void read_hashes_chunk(const std::string& path, const std::string& raw, Recording& recording) {
    Reader reader(path, raw);
    HashRecord record;
    record.tick = reader.value<std::int64_t>();
    while (reader.left() > 0) record.fields.push_back(reader.value<std::uint64_t>());
    if (record.fields.size() != recording.field_names.size())
        throw InputError(path, 0, 0, "the recording's hashes do not fit its fields");
    recording.hashes.push_back(std::move(record));
}

/// The next chunk's bytes, or false at the end of what is whole.
bool read_chunk(std::FILE* file, ChunkHeader& header, std::string& raw) {
    if (std::fread(&header, sizeof(header), 1, file) != 1) return false;
    if (header.stored_bytes > kMaxChunkBytes || header.raw_bytes > kMaxChunkBytes) return false;
    std::string stored(header.stored_bytes, '\0');
    if (std::fread(stored.data(), 1, stored.size(), file) != stored.size()) return false;
    if (hash_bytes(stored.data(), stored.size()) != header.checksum) return false;
    raw.resize(header.raw_bytes);
    const std::size_t count = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
    return !ZSTD_isError(count) && count == raw.size();
}

}  // namespace

Recording read_recording(const std::string& path) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) throw InputError(path, 0, 0, std::string("cannot open the recording: ") + std::strerror(errno));
    char magic[sizeof(kMagic)] = {};
    if (std::fread(magic, sizeof(magic), 1, file.get()) != 1 || std::memcmp(magic, kMagic, sizeof(magic)) != 0)
        throw InputError(path, 0, 0, "this is not a recording of Calot",
                         "recordings are written by `calot simulate` as recording.calot");
    Recording recording;
    ChunkHeader header;
    std::string raw;
    while (!recording.complete) {
        const long at = std::ftell(file.get());
        if (!read_chunk(file.get(), header, raw)) {
            if (recording.scene_text.empty())
                throw InputError(path, 0, 0,
                                 "the recording is damaged at byte " + std::to_string(at) + ", before its scene",
                                 "nothing can be replayed from it; record the run again");
            break;
        }
        switch (static_cast<Kind>(header.kind)) {
            case Kind::scene:
                read_scene_chunk(path, raw, recording);
                break;
            case Kind::hook_inputs:
            case Kind::inputs:
                read_inputs_chunk(path, raw, static_cast<Kind>(header.kind) == Kind::inputs, recording);
                break;
            case Kind::hashes:
                read_hashes_chunk(path, raw, recording);
                break;
            case Kind::end:
                recording.complete = true;
                break;
            default:
                throw InputError(path, 0, 0,
                                 "the recording has a chunk of unknown kind " + std::to_string(header.kind) +
                                     " at byte " + std::to_string(at),
                                 "it may come from a newer version of Calot");
        }
    }
    return recording;
}

RecordingWriter::RecordingWriter(const std::string& path, const std::string& program_version,
                                 const std::string& scene_text, const tissue::State& state)
    : file_(std::fopen(path.c_str(), "wb")), path_(path) {
    if (!file_) fail(path_);
    if (std::fwrite(kMagic, sizeof(kMagic), 1, file_.get()) != 1) fail(path_);
    std::string raw;
    append_text(raw, program_version);
    append_text(raw, scene_text);
    const std::vector<tissue::Field> fields = tissue::fields(const_cast<tissue::State&>(state));
    const auto count = static_cast<std::uint32_t>(fields.size());
    append(raw, &count, sizeof(count));
    for (const tissue::Field& field : fields) append_text(raw, field.name);
    write_chunk(file_.get(), path_, Kind::scene, raw);
    if (std::fflush(file_.get()) != 0) fail(path_);
    pending_.reserve(static_cast<std::size_t>(ticks_per_chunk_));
}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::add(const tissue::Input& input, const tissue::State& state) {
    pending_.push_back(input);
    if (hashes_at(state.tick)) flush(state);
}

void RecordingWriter::flush() {
    if (!pending_.empty()) {
        std::string raw;
        for (const tissue::Input& input : pending_) {
            const StoredHook hook = store_hook(input);
            const StoredGrasper grasper = store_grasper(input);
            append(raw, &hook, sizeof(hook));
            append(raw, &grasper, sizeof(grasper));
        }
        pending_.clear();
        write_chunk(file_.get(), path_, Kind::inputs, raw);
    }
    if (std::fflush(file_.get()) != 0) fail(path_);
}

void RecordingWriter::flush(const tissue::State& state) {
    flush();
    write_chunk(file_.get(), path_, Kind::hashes, hash_chunk({state.tick, tissue::hash_fields(state)}));
    if (std::fflush(file_.get()) != 0) fail(path_);
}

void RecordingWriter::adopt(const Recording& earlier, std::int64_t ticks) {
    std::size_t next = 0;
    for (const HashRecord& record : earlier.hashes) {
        if (record.tick > ticks) break;
        for (; next < static_cast<std::size_t>(record.tick); ++next) pending_.push_back(earlier.inputs.at(next));
        flush();
        write_chunk(file_.get(), path_, Kind::hashes, hash_chunk(record));
    }
    for (; next < static_cast<std::size_t>(ticks); ++next) pending_.push_back(earlier.inputs.at(next));
    flush();
}

void RecordingWriter::sync() {
    ::fdatasync(::fileno(file_.get()));  // where that is not possible, nothing more can be done
}

void RecordingWriter::finish(const tissue::State& state) {
    if (finished_) return;
    if (!pending_.empty()) flush(state);
    write_chunk(file_.get(), path_, Kind::end, "");
    if (std::fflush(file_.get()) != 0) fail(path_);
    finished_ = true;
}

}  // namespace calot::simulation
