#pragma once
// 3D Systems' Touch family (formerly Geomagic, SensAble Phantom) through OpenHaptics' HDAPI, where it is installed.
//
// The library has a scheduler with a real-time thread of its own, at 1000 Hz; the servo loop runs there, one haptic
// frame a step: read() begins the frame, write() ends it.

#include <atomic>
#include <string>

#include "calot/haptics/device.h"
#include "calot/haptics/hd_api.h"

namespace calot::haptics {

class OpenHapticsDevice : public HapticDevice {
  public:
    /// `configuration`: the device's name in the driver's set-up, empty for its default. `library`: path of libHD.so,
    /// empty where it is customarily found.
    explicit OpenHapticsDevice(std::string configuration = "", std::string library = "");
    ~OpenHapticsDevice() override { close(); }

    const DeviceInfo& info() const override { return info_; }
    std::string open() override;
    void close() noexcept override;
    Fault read(double now_s, DeviceSample& sample) noexcept override;
    Fault write(const Vec3& force_N) noexcept override;
    bool start_clock(Tick tick, void* user) override;
    void stop_clock() noexcept override;

  private:
    void describe_device();
    std::string trouble(const char* what);
    Fault drain_errors() noexcept;
    bool calibrated() noexcept;

    std::string configuration_, library_;
    DeviceInfo info_;
    const hd::Api* api_ = nullptr;
    hd::Handle handle_ = hd::kInvalidHandle;
    hd::Scheduled scheduled_ = 0;
    Tick tick_ = nullptr;
    void* user_ = nullptr;
    bool running_ = false, calibrated_ = false, in_frame_ = false;
    Fault fault_ = Fault::none;  ///< of the frame that ended last
    int frames_ = 0;
};

}  // namespace calot::haptics
