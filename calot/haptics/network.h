#pragma once
// Other hardware, over UDP: a small program beside the device sends the hand's pose and gets the force back. The
// protocol is in docs/haptics.md, an example of such a program in examples/haptic_client.py. Calot listens only when
// this device is chosen, and only on the loopback unless told otherwise: nothing in the protocol keeps strangers out.

#include <string>

#include <netinet/in.h>

#include "calot/haptics/device.h"
#include "calot/haptics/protocol.h"

namespace calot::haptics {

struct NetworkOptions {
    std::string address = "127.0.0.1";  ///< to listen on
    int port = 5460;                    ///< 0: any free one
    double silent_s = 0.02;             ///< without a word from the client for so long: zero force
    double gone_s = 1.0;                ///< for so long: the client is forgotten, another may come
};

class NetworkDevice : public HapticDevice {
  public:
    explicit NetworkDevice(const NetworkOptions& options = {});
    ~NetworkDevice() override { close(); }

    const DeviceInfo& info() const override { return info_; }
    std::string open() override;
    void close() noexcept override;
    Fault read(double now_s, DeviceSample& sample) noexcept override;
    Fault write(const Vec3& force_N) noexcept override;

    /// Where it listens, once open.
    int port() const { return port_; }

  private:
    void receive(double now_s) noexcept;
    void greet(const sockaddr_in& from, const protocol::Header& header, const unsigned char* bytes,
               double now_s) noexcept;
    void send(const sockaddr_in& to, const protocol::Packet& packet) noexcept;
    void forget() noexcept;

    NetworkOptions options_;
    DeviceInfo info_;
    int socket_ = -1, port_ = 0;
    std::uint32_t salt_ = 0, session_ = 0;  ///< session 0: nobody
    std::uint32_t hand_sequence_ = 0, own_sequence_ = 0;
    sockaddr_in peer_{};
    DeviceSample hand_;
    double heard_s_ = 0.0;
    bool has_hand_ = false;
    Fault fault_ = Fault::absent;
};

}  // namespace calot::haptics
