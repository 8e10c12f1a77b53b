#pragma once
// The network device's packets (docs/haptics.md): little-endian, of fixed size for each kind, each with a checksum.
//
//     u32 magic | u16 version | u16 kind | u32 session | u32 sequence | content ... | u32 CRC-32 of all before

#include <array>
#include <cstdint>
#include <string>

#include "calot/haptics/device.h"

namespace calot::haptics::protocol {

inline constexpr std::uint32_t kMagic = 0x48544c43;  // "CLTH"
inline constexpr std::uint16_t kVersion = 1;
inline constexpr std::size_t kMostBytes = 128;

enum class Kind : std::uint16_t { hello = 1, welcome = 2, hand = 3, force = 4, bye = 5 };
enum class Answer : std::uint32_t { welcome = 0, busy = 1, wrong_version = 2 };

struct Header {
    std::uint16_t version = kVersion;
    Kind kind = Kind::bye;
    std::uint32_t session = 0;
    std::uint32_t sequence = 0;
};

struct Hello {
    double max_force_N = 0.0, mass_kg = 0.0;
    Box workspace_m;
    std::string name;  ///< at most 31 bytes
};
struct Welcome {
    double max_force_N = 0.0, timeout_s = 0.0;
    Answer answer = Answer::welcome;
};
struct Force {
    Vec3 force_N{0.0};
    std::uint32_t answers = 0;  ///< sequence of the hand's packet
    std::uint32_t fault = 0;
};

/// A packet's bytes; no memory is taken, as the servo loop makes them.
struct Packet {
    std::array<unsigned char, kMostBytes> bytes{};
    std::size_t size = 0;
};

Packet encode(Header header, const Hello& hello);
Packet encode(Header header, const Welcome& welcome);
Packet encode(Header header, const DeviceSample& hand);
Packet encode(Header header, const Force& force);
Packet encode_bye(Header header);

/// False unless magic, size and checksum are right for the kind. A wrong version is for the caller to judge.
bool decode_header(const unsigned char* bytes, std::size_t size, Header& header);
/// Of packets whose header was decoded.
Hello decode_hello(const unsigned char* bytes);
Welcome decode_welcome(const unsigned char* bytes);
DeviceSample decode_hand(const unsigned char* bytes);
Force decode_force(const unsigned char* bytes);

/// CRC-32 as in Ethernet, zlib and PNG.
std::uint32_t crc32(const unsigned char* bytes, std::size_t size);

/// Whether a sequence number is newer; they wrap around.
constexpr bool newer(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(a - b) > 0;
}

}  // namespace calot::haptics::protocol
