#include "calot/haptics/network.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <random>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

namespace calot::haptics {

namespace {

/// A flood must not hold the servo loop: what is left is read in the next step, or dropped by the kernel.
constexpr int kMostPackets = 32;

bool same(const sockaddr_in& a, const sockaddr_in& b) {
    return a.sin_addr.s_addr == b.sin_addr.s_addr && a.sin_port == b.sin_port;
}

/// What a client says of its device, where it is believable.
void believe(const protocol::Hello& hello, DeviceInfo& info) {
    const DeviceInfo usual;
    const bool force = hello.max_force_N > 0.0 && hello.max_force_N < 100.0;
    const bool mass = hello.mass_kg > 1e-3 && hello.mass_kg < 10.0;
    info.max_force_N = force ? hello.max_force_N : usual.max_force_N;
    info.mass_kg = mass ? hello.mass_kg : usual.mass_kg;
}

}  // namespace

NetworkDevice::NetworkDevice(const NetworkOptions& options) : options_(options) {
    info_.name = "network";
    info_.model = "network client";
}

std::string NetworkDevice::open() {
    close();
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_port = htons(static_cast<std::uint16_t>(options_.port));
    if (inet_pton(AF_INET, options_.address.c_str(), &own.sin_addr) != 1)
        return fmt::format("'{}' is no IPv4 address to listen on", options_.address);
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) != 0) {
        const std::string why =
            fmt::format("cannot listen on {}:{}: {}", options_.address, options_.port, std::strerror(errno));
        close();
        return why;
    }
    socklen_t size = sizeof(own);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
    port_ = ntohs(own.sin_port);
    info_.model = fmt::format("UDP {}:{}", options_.address, port_);
    salt_ = std::random_device{}();
    return "";
}

void NetworkDevice::close() noexcept {
    if (session_ != 0) send(peer_, protocol::encode_bye({.session = session_, .sequence = ++own_sequence_}));
    forget();
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
}

void NetworkDevice::forget() noexcept {
    session_ = 0;
    has_hand_ = false;
    hand_ = {};
    fault_ = Fault::absent;
}

void NetworkDevice::send(const sockaddr_in& to, const protocol::Packet& packet) noexcept {
    // A packet that does not go out is like one that was lost on the way: the client's timeout covers both.
    (void)::sendto(socket_, packet.bytes.data(), packet.size, MSG_DONTWAIT | MSG_NOSIGNAL,
                   reinterpret_cast<const sockaddr*>(&to), sizeof(to));
}

void NetworkDevice::greet(const sockaddr_in& from, const protocol::Header& header, const unsigned char* bytes,
                          double now_s) noexcept {
    protocol::Welcome welcome{info_.max_force_N, options_.silent_s, protocol::Answer::welcome};
    protocol::Header answer{.session = 0, .sequence = header.sequence};
    if (header.version != protocol::kVersion) {
        welcome.answer = protocol::Answer::wrong_version;
    } else if (session_ != 0 && !same(from, peer_)) {
        welcome.answer = protocol::Answer::busy;
    } else {
        forget();
        believe(protocol::decode_hello(bytes), info_);
        welcome.max_force_N = info_.max_force_N;
        // Another number for every greeting, so that packets of an earlier session are not taken for this one's.
        salt_ = salt_ * 1664525u + 1013904223u;
        session_ = std::max(1u, salt_);
        peer_ = from;
        hand_sequence_ = header.sequence;
        heard_s_ = now_s;
        answer.session = session_;
    }
    send(from, protocol::encode(answer, welcome));
}

void NetworkDevice::receive(double now_s) noexcept {
    unsigned char bytes[protocol::kMostBytes + 1];
    for (int k = 0; k < kMostPackets; ++k) {
        sockaddr_in from{};
        socklen_t from_size = sizeof(from);
        const ssize_t size =
            ::recvfrom(socket_, bytes, sizeof(bytes), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), &from_size);
        if (size < 0) return;
        protocol::Header header;
        if (!protocol::decode_header(bytes, static_cast<std::size_t>(size), header)) continue;
        if (header.kind == protocol::Kind::hello) {
            greet(from, header, bytes, now_s);
            continue;
        }
        if (header.version != protocol::kVersion || session_ == 0 || header.session != session_ || !same(from, peer_) ||
            !protocol::newer(header.sequence, hand_sequence_))
            continue;
        if (header.kind == protocol::Kind::bye) {
            forget();
        } else if (header.kind == protocol::Kind::hand) {
            hand_ = protocol::decode_hand(bytes);
            hand_sequence_ = header.sequence;
            has_hand_ = true;
            heard_s_ = now_s;
        }
    }
}

Fault NetworkDevice::read(double now_s, DeviceSample& sample) noexcept {
    if (socket_ < 0) return Fault::disconnected;
    receive(now_s);
    if (session_ != 0 && now_s - heard_s_ > options_.gone_s) forget();
    if (!has_hand_) return fault_ = Fault::absent;
    if (now_s - heard_s_ > options_.silent_s) return fault_ = Fault::device_error;
    sample = hand_;
    return fault_ = Fault::none;
}

Fault NetworkDevice::write(const Vec3& force_N) noexcept {
    if (session_ == 0) return Fault::none;
    send(peer_, protocol::encode({.session = session_, .sequence = ++own_sequence_},
                                 protocol::Force{force_N, hand_sequence_, static_cast<std::uint32_t>(fault_)}));
    return Fault::none;
}

}  // namespace calot::haptics
