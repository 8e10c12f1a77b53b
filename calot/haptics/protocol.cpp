#include "calot/haptics/protocol.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace calot::haptics::protocol {

namespace {

static_assert(std::endian::native == std::endian::little, "the packets are copied as they lie in memory");

constexpr std::size_t kHeaderBytes = 16, kNameBytes = 32, kChecksumBytes = 4;

constexpr std::array<std::uint32_t, 256> make_crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t k = 0; k < 256; ++k) {
        std::uint32_t c = k;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
        table[k] = c;
    }
    return table;
}
constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

/// Bytes of a packet's content, -1 for kinds that there are not.
int content_bytes(Kind kind) {
    switch (kind) {
        case Kind::hello:
            return 8 * 8 + static_cast<int>(kNameBytes);
        case Kind::welcome:
            return 2 * 8 + 4;
        case Kind::hand:
            return 10 * 8 + 2 * 4;
        case Kind::force:
            return 3 * 8 + 2 * 4;
        case Kind::bye:
            return 0;
    }
    return -1;
}

class Writer {
  public:
    Writer(const Header& header, Kind kind) {
        add(kMagic);
        add(header.version);
        add(static_cast<std::uint16_t>(kind));
        add(header.session);
        add(header.sequence);
    }
    template <class T>
    void add(T value) {
        std::memcpy(packet_.bytes.data() + packet_.size, &value, sizeof(T));
        packet_.size += sizeof(T);
    }
    void add(const Vec3& v) {
        for (int axis = 0; axis < 3; ++axis) add(v[axis]);
    }
    void add(const std::string& text) {
        std::memcpy(packet_.bytes.data() + packet_.size, text.data(), std::min(text.size(), kNameBytes - 1));
        packet_.size += kNameBytes;
    }
    Packet finish() {
        add(crc32(packet_.bytes.data(), packet_.size));
        return packet_;
    }

  private:
    Packet packet_;
};

class Reader {
  public:
    explicit Reader(const unsigned char* bytes) : at_(bytes) {}
    template <class T>
    T take() {
        T value;
        std::memcpy(&value, at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }
    Vec3 take_vector() {
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = take<double>();
        return v;
    }
    std::string take_name() const {
        const auto* text = reinterpret_cast<const char*>(at_);
        return std::string(text, strnlen(text, kNameBytes));
    }

  private:
    const unsigned char* at_;
};

}  // namespace

std::uint32_t crc32(const unsigned char* bytes, std::size_t size) {
    std::uint32_t c = 0xffffffffu;
    for (std::size_t k = 0; k < size; ++k) c = kCrcTable[(c ^ bytes[k]) & 0xffu] ^ (c >> 8);
    return c ^ 0xffffffffu;
}

Packet encode(Header header, const Hello& hello) {
    Writer writer(header, Kind::hello);
    writer.add(hello.max_force_N);
    writer.add(hello.mass_kg);
    writer.add(hello.workspace_m.low);
    writer.add(hello.workspace_m.high);
    writer.add(hello.name);
    return writer.finish();
}

Packet encode(Header header, const Welcome& welcome) {
    Writer writer(header, Kind::welcome);
    writer.add(welcome.max_force_N);
    writer.add(welcome.timeout_s);
    writer.add(static_cast<std::uint32_t>(welcome.answer));
    return writer.finish();
}

Packet encode(Header header, const DeviceSample& hand) {
    Writer writer(header, Kind::hand);
    writer.add(hand.position_m);
    for (const double part : {hand.orientation.w, hand.orientation.x, hand.orientation.y, hand.orientation.z})
        writer.add(part);
    writer.add(hand.velocity_m_per_s);
    writer.add(hand.buttons);
    writer.add(std::uint32_t{hand.has_velocity ? 1u : 0u});
    return writer.finish();
}

Packet encode(Header header, const Force& force) {
    Writer writer(header, Kind::force);
    writer.add(force.force_N);
    writer.add(force.answers);
    writer.add(force.fault);
    return writer.finish();
}

Packet encode_bye(Header header) {
    return Writer(header, Kind::bye).finish();
}

bool decode_header(const unsigned char* bytes, std::size_t size, Header& header) {
    if (size < kHeaderBytes + kChecksumBytes) return false;
    Reader reader(bytes);
    if (reader.take<std::uint32_t>() != kMagic) return false;
    header.version = reader.take<std::uint16_t>();
    header.kind = static_cast<Kind>(reader.take<std::uint16_t>());
    header.session = reader.take<std::uint32_t>();
    header.sequence = reader.take<std::uint32_t>();
    const int content = content_bytes(header.kind);
    if (content < 0 || size != kHeaderBytes + static_cast<std::size_t>(content) + kChecksumBytes) return false;
    return Reader(bytes + size - kChecksumBytes).take<std::uint32_t>() == crc32(bytes, size - kChecksumBytes);
}

Hello decode_hello(const unsigned char* bytes) {
    Reader reader(bytes + kHeaderBytes);
    Hello hello;
    hello.max_force_N = reader.take<double>();
    hello.mass_kg = reader.take<double>();
    hello.workspace_m.low = reader.take_vector();
    hello.workspace_m.high = reader.take_vector();
    hello.name = reader.take_name();
    return hello;
}

Welcome decode_welcome(const unsigned char* bytes) {
    Reader reader(bytes + kHeaderBytes);
    Welcome welcome;
    welcome.max_force_N = reader.take<double>();
    welcome.timeout_s = reader.take<double>();
    welcome.answer = static_cast<Answer>(reader.take<std::uint32_t>());
    return welcome;
}

DeviceSample decode_hand(const unsigned char* bytes) {
    Reader reader(bytes + kHeaderBytes);
    DeviceSample hand;
    hand.position_m = reader.take_vector();
    hand.orientation.w = reader.take<double>();
    hand.orientation.x = reader.take<double>();
    hand.orientation.y = reader.take<double>();
    hand.orientation.z = reader.take<double>();
    hand.velocity_m_per_s = reader.take_vector();
    hand.buttons = reader.take<std::uint32_t>();
    hand.has_velocity = (reader.take<std::uint32_t>() & 1u) != 0;
    return hand;
}

Force decode_force(const unsigned char* bytes) {
    Reader reader(bytes + kHeaderBytes);
    Force force;
    force.force_N = reader.take_vector();
    force.answers = reader.take<std::uint32_t>();
    force.fault = reader.take<std::uint32_t>();
    return force;
}

}  // namespace calot::haptics::protocol
