// The network device over the loopback: the protocol, what it refuses, silence, and the example client.
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "calot/haptics/network.h"
#include "rig.h"
#include "support/paths.h"

namespace calot::haptics {

namespace {

using protocol::Kind;

/// A client in the test's hands.
class Client {
  public:
    explicit Client(int port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<std::uint16_t>(port));
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
    }
    ~Client() { ::close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void send(const protocol::Packet& packet) const { ::send(socket_, packet.bytes.data(), packet.size, 0); }
    void hello() { send(protocol::encode({.sequence = ++sequence}, protocol::Hello{2.5, 0.06, {}, "test"})); }
    void hand(double y_m) {
        DeviceSample sample;
        sample.position_m.y = y_m;
        send(protocol::encode({.session = session, .sequence = ++sequence}, sample));
    }
    /// The next packet, which is there already: the loopback delivers within the call.
    bool receive(protocol::Header& header) {
        pollfd ready{socket_, POLLIN, 0};
        if (::poll(&ready, 1, 0) != 1) return false;
        const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
        return size > 0 && protocol::decode_header(bytes.data(), static_cast<std::size_t>(size), header);
    }
    void welcome() {
        protocol::Header header;
        ASSERT_TRUE(receive(header));
        ASSERT_EQ(header.kind, Kind::welcome);
        session = header.session;
        answer = protocol::decode_welcome(bytes.data());
    }
    std::array<unsigned char, 256> bytes{};
    std::uint32_t session = 0, sequence = 0;
    protocol::Welcome answer;

  private:
    int socket_;
};

struct Network : ::testing::Test {
    NetworkDevice device{{.port = 0}};
    DeviceSample sample;
    double time_s = 10.0;
    void SetUp() override { ASSERT_EQ(device.open(), ""); }
    Fault read(double after_s = 1e-3) {
        time_s += after_s;
        return device.read(time_s, sample);
    }
    void connect(Client& client) {
        client.hello();
        EXPECT_EQ(read(), Fault::absent);
        client.welcome();
        ASSERT_NE(client.session, 0u);
    }
};

}  // namespace

TEST(Protocol, ChecksumIsTheCustomaryOne) {
    const auto* text = reinterpret_cast<const unsigned char*>("123456789");
    EXPECT_EQ(protocol::crc32(text, 9), 0xcbf43926u);
}

TEST(Protocol, SequencesWrapAround) {
    EXPECT_TRUE(protocol::newer(1, 0));
    EXPECT_TRUE(protocol::newer(2, 0xfffffff0u));
    EXPECT_FALSE(protocol::newer(5, 5));
    EXPECT_FALSE(protocol::newer(0xfffffff0u, 2));
}

TEST(Protocol, EverySingleChangedBitIsFound) {
    DeviceSample sample;
    sample.position_m = Vec3(0.01, 0.02, 0.03);
    const protocol::Packet packet = protocol::encode({.session = 5, .sequence = 6}, sample);
    protocol::Header header;
    ASSERT_TRUE(protocol::decode_header(packet.bytes.data(), packet.size, header));
    EXPECT_EQ(packet.size, 108u);
    EXPECT_EQ(protocol::decode_hand(packet.bytes.data()).position_m, sample.position_m);
    for (std::size_t bit = 0; bit < 8 * packet.size; ++bit) {
        protocol::Packet damaged = packet;
        damaged.bytes[bit / 8] = static_cast<unsigned char>(damaged.bytes[bit / 8] ^ (1u << bit % 8));
        EXPECT_FALSE(protocol::decode_header(damaged.bytes.data(), damaged.size, header)) << bit;
    }
    for (std::size_t size = 0; size < packet.size; ++size)
        EXPECT_FALSE(protocol::decode_header(packet.bytes.data(), size, header)) << size;
}

TEST_F(Network, ExchangesHandsForForces) {
    Client client(device.port());
    connect(client);
    EXPECT_EQ(client.answer.max_force_N, 2.5);
    EXPECT_EQ(device.info().mass_kg, 0.06);
    client.hand(-0.005);
    EXPECT_EQ(read(), Fault::none);
    EXPECT_EQ(sample.position_m.y, -0.005);
    device.write(Vec3(0.0, 0.7, 0.0));
    protocol::Header header;
    ASSERT_TRUE(client.receive(header));
    EXPECT_EQ(header.kind, Kind::force);
    const protocol::Force force = protocol::decode_force(client.bytes.data());
    EXPECT_EQ(force.force_N.y, 0.7);
    EXPECT_EQ(force.answers, client.sequence);
    EXPECT_EQ(force.fault, 0u);
    client.send(protocol::encode_bye({.session = client.session, .sequence = ++client.sequence}));
    EXPECT_EQ(read(), Fault::absent);
}

TEST_F(Network, RefusesWhatIsOldForeignOrFromAnotherSession) {
    Client client(device.port());
    connect(client);
    client.hand(0.001);
    client.hand(0.002);
    ASSERT_EQ(read(), Fault::none);
    EXPECT_EQ(sample.position_m.y, 0.002) << "the latest";
    client.sequence -= 2;
    client.hand(0.003);  // comes late
    Client stranger(device.port());
    stranger.session = client.session;
    stranger.sequence = client.sequence + 100;
    stranger.hand(0.004);
    client.sequence += 10;
    client.session += 1;
    client.hand(0.005);
    client.session -= 1;
    EXPECT_EQ(read(), Fault::none);
    EXPECT_EQ(sample.position_m.y, 0.002);
    stranger.session = 0;
    stranger.hello();
    EXPECT_EQ(read(), Fault::none) << "the first client keeps the device";
    stranger.welcome();
    EXPECT_EQ(stranger.answer.answer, protocol::Answer::busy);
    client.hand(0.006);
    EXPECT_EQ(read(), Fault::none);
    EXPECT_EQ(sample.position_m.y, 0.006);
}

TEST_F(Network, TellsThatItSpeaksAnotherVersion) {
    Client client(device.port());
    client.send(protocol::encode({.version = 2, .sequence = 1}, protocol::Hello{}));
    EXPECT_EQ(read(), Fault::absent);
    client.welcome();
    EXPECT_EQ(client.answer.answer, protocol::Answer::wrong_version);
    EXPECT_EQ(client.session, 0u);
}

TEST_F(Network, SilenceIsAFaultAndThenAGoodbye) {
    Client client(device.port());
    connect(client);
    client.hand(0.001);
    EXPECT_EQ(read(), Fault::none);
    EXPECT_EQ(read(0.015), Fault::none);
    EXPECT_EQ(read(0.010), Fault::device_error) << "25 ms";
    client.hand(0.001);
    EXPECT_EQ(read(), Fault::none);
    EXPECT_EQ(read(1.1), Fault::absent);
    Client other(device.port());
    connect(other);
    EXPECT_NE(other.session, client.session);
}

// What is no number ends at the servo loop, as for every device.
TEST_F(Network, NoNumbersMeanZeroForce) {
    Client client(device.port());
    Servo servo(device, {});
    connect(client);
    client.hand(0.0);
    servo.step(time_s += 1e-3);
    client.hand(std::numeric_limits<double>::quiet_NaN());
    servo.step(time_s += 1e-3);
    ServoState state;
    servo.take_state(state);
    EXPECT_EQ(state.fault, Fault::not_finite);
}

TEST_F(Network, SaysWhyItCannotListen) {
    NetworkDevice second({.port = device.port()});
    const std::string why = second.open();
    EXPECT_NE(why.find("cannot listen on 127.0.0.1"), std::string::npos) << why;
    NetworkDevice third({.address = "localhost"});
    EXPECT_NE(third.open().find("no IPv4 address"), std::string::npos);
}

// The example client of the documentation feels a spring. Times are generous: a busy machine is no fault here.
TEST(NetworkExample, TheClientFeels) {
    auto device = std::make_unique<NetworkDevice>(NetworkOptions{.port = 0, .silent_s = 20.0, .gone_s = 60.0});
    NetworkDevice& network = *device;
    SessionOptions options = rig_options();
    options.threads = false;
    options.servo.late_s = 20.0;
    Session session(std::move(device), options);
    session.keep();
    std::FILE* client = ::popen(("python3 " CALOT_SOURCE_DIR "/examples/haptic_client.py --seconds 1.5 --port " +
                                 std::to_string(network.port()) + " 2>&1")
                                    .c_str(),
                                "r");
    ASSERT_NE(client, nullptr);
    std::atomic<bool> ended{false};
    std::thread simulation([&] {
        tissue::Input input;
        input.hook = instruments::pose_through_trocar(kTrocar_m, Vec3(0.0), 0.0);
        tissue::State state;
        while (!ended) {
            session.servo_step(monotonic_s());
            session.drive(input);
            state.hook_force_N.z = -40.0 * std::min(0.0, input.hook.position_m.z);
            session.feel(state);
            std::this_thread::sleep_for(std::chrono::microseconds(300));
        }
    });
    std::string said;
    for (int c; (c = std::fgetc(client)) != EOF;) said += static_cast<char>(c);
    const int code = ::pclose(client);
    ended = true;
    simulation.join();
    EXPECT_EQ(code, 0) << said;
    double greatest_N = 0.0;
    const std::size_t at = said.find("greatest force ");
    ASSERT_NE(at, std::string::npos) << said;
    ASSERT_EQ(std::sscanf(said.c_str() + at, "greatest force %lf N", &greatest_N), 1) << said;
    EXPECT_GT(greatest_N, 0.1) << said;
    EXPECT_LT(greatest_N, 1.0) << said;
}

}  // namespace calot::haptics
