#include "calot/training/checkpoints.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>
#include <zstd.h>

#include "calot/base/error.h"
#include "calot/base/hash.h"

// File = magic, then checkpoints:
//
//   | tick i64 | raw bytes u64 | XXH3 of the stored bytes u64 | stored bytes u32 | 0 u32 | stored bytes ... |
//
// raw = u64 count of fields, u64 bytes of each field, all fields XOR the initial state's, then the Aside.

namespace calot::training {

namespace {

constexpr char kMagic[8] = {'C', 'A', 'L', 'O', 'T', 'C', 'K', '2'};
constexpr char kOlder[8] = {'C', 'A', 'L', 'O', 'T', 'C', 'K', '1'};  ///< without effects
constexpr std::uint64_t kMostBytes = 4ull << 30;
constexpr int kLevel = 1;  ///< of Zstandard: speed; what differs little from the start is small anyhow

struct Header {
    std::int64_t tick = 0;
    std::uint64_t raw_bytes = 0;
    std::uint64_t checksum = 0;
    std::uint32_t stored_bytes = 0;
    std::uint32_t reserved = 0;
};
static_assert(sizeof(Header) == 32);

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& path) {
    throw std::system_error(errno, std::generic_category(), "cannot write " + path);
}

std::vector<tissue::Field> fields_of(const tissue::State& state) {
    return tissue::fields(const_cast<tissue::State&>(state));
}

std::string all_bytes(const tissue::State& state) {
    std::string bytes;
    for (const tissue::Field& field : fields_of(state)) bytes.append(static_cast<const char*>(field.data), field.bytes);
    return bytes;
}

/// a ^= b, eight bytes at a time.
void exclusive_or(char* a, const char* b, std::size_t count) {
    std::size_t k = 0;
    for (; k + 8 <= count; k += 8) {
        std::uint64_t x, y;
        std::memcpy(&x, a + k, 8);
        std::memcpy(&y, b + k, 8);
        x ^= y;
        std::memcpy(a + k, &x, 8);
    }
    for (; k < count; ++k) a[k] = static_cast<char>(a[k] ^ b[k]);
}

}  // namespace

bool can_be_stored(const tissue::Model& model, std::int64_t tick) {
    return tick % model.frame_ticks == 0;
}

CheckpointWriter::CheckpointWriter(const std::string& path, const tissue::State& initial)
    : path_(path), file_(std::fopen(path.c_str(), "wb")), initial_(all_bytes(initial)) {
    if (!file_ || std::fwrite(kMagic, sizeof(kMagic), 1, file_.get()) != 1 || std::fflush(file_.get()) != 0)
        fail(path_);
}

void CheckpointWriter::add(const tissue::State& state, const Aside& aside) {
    const std::vector<tissue::Field> fields = fields_of(state);
    raw_.clear();
    const auto put = [&](std::uint64_t value) { raw_.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    put(fields.size());
    for (const tissue::Field& field : fields) put(field.bytes);
    const std::size_t start = raw_.size();
    for (const tissue::Field& field : fields) raw_.append(static_cast<const char*>(field.data), field.bytes);
    if (raw_.size() - start != initial_.size()) throw std::logic_error("a checkpoint of another scene");
    exclusive_or(raw_.data() + start, initial_.data(), initial_.size());
    Archive along;
    const_cast<Aside&>(aside).archive(along);  // writing changes nothing
    raw_ += along.bytes();

    stored_.resize(ZSTD_compressBound(raw_.size()));
    const std::size_t size = ZSTD_compress(stored_.data(), stored_.size(), raw_.data(), raw_.size(), kLevel);
    if (ZSTD_isError(size)) throw std::runtime_error("cannot compress a checkpoint");
    Header header;
    header.tick = state.tick;
    header.raw_bytes = raw_.size();
    header.stored_bytes = static_cast<std::uint32_t>(size);
    header.checksum = hash_bytes(stored_.data(), size);
    if (std::fwrite(&header, sizeof(header), 1, file_.get()) != 1 ||
        std::fwrite(stored_.data(), 1, size, file_.get()) != size || std::fflush(file_.get()) != 0)
        fail(path_);
}

void CheckpointWriter::adopt(const std::string& path, std::int64_t tick) {
    const CheckpointReader reader(path);
    const File source(std::fopen(path.c_str(), "rb"), std::fclose);
    for (const CheckpointReader::Entry& entry : reader.entries_) {
        if (entry.tick > tick) break;
        const Header header{entry.tick, entry.raw_bytes, entry.checksum, entry.stored_bytes, 0};
        stored_.resize(entry.stored_bytes);
        if (!source || std::fseek(source.get(), entry.offset, SEEK_SET) != 0 ||
            std::fread(stored_.data(), 1, stored_.size(), source.get()) != stored_.size())
            break;
        if (std::fwrite(&header, sizeof(header), 1, file_.get()) != 1 ||
            std::fwrite(stored_.data(), 1, stored_.size(), file_.get()) != stored_.size())
            fail(path_);
    }
    if (std::fflush(file_.get()) != 0) fail(path_);
}

CheckpointReader::CheckpointReader(const std::string& path) : path_(path) {
    const File file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) return;
    char magic[sizeof(kMagic)] = {};
    older_ = std::fread(magic, sizeof(magic), 1, file.get()) == 1 && std::memcmp(magic, kOlder, sizeof(magic)) == 0;
    if (older_) return;
    if (std::memcmp(magic, kMagic, sizeof(magic)) != 0)
        throw InputError(path, 0, 0, "these are no checkpoints of Calot",
                         "remove the file: it is made anew when needed");
    std::fseek(file.get(), 0, SEEK_END);
    const long end = std::ftell(file.get());
    std::fseek(file.get(), sizeof(kMagic), SEEK_SET);
    Header header;
    while (std::fread(&header, sizeof(header), 1, file.get()) == 1) {
        Entry entry{header.tick, std::ftell(file.get()), header.stored_bytes, header.raw_bytes, header.checksum};
        const bool rising = entries_.empty() || header.tick > entries_.back().tick;
        if (!rising || header.raw_bytes > kMostBytes || entry.offset + static_cast<long>(header.stored_bytes) > end)
            break;
        entries_.push_back(entry);
        if (std::fseek(file.get(), static_cast<long>(header.stored_bytes), SEEK_CUR) != 0) break;
    }
}

std::vector<std::int64_t> CheckpointReader::ticks() const {
    std::vector<std::int64_t> ticks;
    for (const Entry& entry : entries_) ticks.push_back(entry.tick);
    return ticks;
}

std::int64_t CheckpointReader::last_before(std::int64_t tick) const {
    std::int64_t last = -1;
    for (const Entry& entry : entries_)
        if (entry.tick <= tick) last = entry.tick;
    return last;
}

void CheckpointReader::read(std::int64_t tick, tissue::State& state, Aside& aside) const {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.tick == tick; });
    const File file(std::fopen(path_.c_str(), "rb"), std::fclose);
    const auto damaged = [&](const char* why) {
        return InputError(path_, 0, 0, fmt::format("the checkpoint at tick {} cannot be used: {}", tick, why),
                          "remove the file: the session can still be replayed from its start");
    };
    if (found == entries_.end() || !file || std::fseek(file.get(), found->offset, SEEK_SET) != 0)
        throw damaged("it is not there");
    std::string stored(found->stored_bytes, '\0'), raw(found->raw_bytes, '\0');
    if (std::fread(stored.data(), 1, stored.size(), file.get()) != stored.size() ||
        hash_bytes(stored.data(), stored.size()) != found->checksum)
        throw damaged("it is damaged");
    const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(size) || size != raw.size()) throw damaged("it is damaged");

    const std::vector<tissue::Field> fields = tissue::fields(state);
    std::size_t at = 0, whole = (fields.size() + 1) * sizeof(std::uint64_t);
    const auto next = [&] {
        std::uint64_t value = 0;
        if (at + sizeof(value) <= raw.size()) std::memcpy(&value, raw.data() + at, sizeof(value));
        at += sizeof(value);
        return value;
    };
    bool fits = next() == fields.size();
    for (const tissue::Field& field : fields) {
        fits = fits && next() == field.bytes;
        whole += field.bytes;
    }
    if (!fits || whole > raw.size()) throw damaged("it belongs to another scene or version of Calot");
    for (const tissue::Field& field : fields) {
        exclusive_or(static_cast<char*>(field.data), raw.data() + at, field.bytes);
        at += field.bytes;
    }
    try {
        raw.erase(0, at);
        Archive along(raw);
        aside.archive(along);
    } catch (const std::runtime_error&) {
        throw damaged("it is damaged");
    }
}

}  // namespace calot::training
