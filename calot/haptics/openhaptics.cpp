#include "calot/haptics/openhaptics.h"

#include <algorithm>

#include <fmt/format.h>

namespace calot::haptics {

namespace {

/// Calibration is looked at every so many frames until it is there: the check itself takes time.
constexpr int kFramesPerCheck = 100;
/// Errors pile up on a stack; a library gone wild must not hold the servo loop.
constexpr int kMostErrors = 16;

Fault fault_of(unsigned int code) {
    switch (code) {
        case hd::kSuccess:
            return Fault::none;
        case hd::kWarmMotors:
            return Fault::motors_warm;
        case hd::kDeviceFault:
        case hd::kCommError:
        case hd::kCommConfigError:
        case hd::kTimerError:
        case hd::kBadHandle:
            return Fault::disconnected;
        default:
            return Fault::device_error;
    }
}

/// The worse of two: what asks for a reconnection rules.
Fault worse(Fault a, Fault b) {
    if (a == Fault::disconnected || b == Fault::none) return a;
    return a == Fault::none || b == Fault::disconnected ? b : a;
}

}  // namespace

OpenHapticsDevice::OpenHapticsDevice(std::string configuration, std::string library)
    : configuration_(std::move(configuration)), library_(std::move(library)) {
    info_.name = "openhaptics";
}

std::string OpenHapticsDevice::trouble(const char* what) {
    const hd::ErrorInfo error = api_->GetError();
    if (error.code == hd::kSuccess) return "";
    drain_errors();
    const char* text = api_->GetErrorString(error.code);
    return fmt::format("{}: {} (error 0x{:04x}, {})", what, text != nullptr ? text : "unknown", error.code,
                       error.internal_code);
}

std::string OpenHapticsDevice::open() {
    close();
    std::string why;
    api_ = hd::load(library_, why);
    if (api_ == nullptr) return why;
    drain_errors();  // of earlier attempts: they would make a good device look bad
    handle_ = api_->InitDevice(configuration_.empty() ? nullptr : configuration_.c_str());
    why = trouble("the device cannot be opened");
    if (handle_ == hd::kInvalidHandle && why.empty()) why = "the device cannot be opened";
    if (!why.empty()) {
        if (handle_ != hd::kInvalidHandle) api_->DisableDevice(handle_);
        handle_ = hd::kInvalidHandle;
        return why;
    }
    api_->MakeCurrentDevice(handle_);
    describe_device();
    api_->Enable(hd::kForceOutput);
    why = trouble("its forces cannot be switched on");
    if (!why.empty()) close();
    fault_ = Fault::none;
    calibrated_ = in_frame_ = false;
    frames_ = 0;
    return why;
}

void OpenHapticsDevice::describe_device() {
    const char* model = api_->GetString(hd::kDeviceModelType);
    const char* serial = api_->GetString(hd::kDeviceSerialNumber);
    info_.model = model != nullptr ? model : "OpenHaptics device";
    if (serial != nullptr && *serial != '\0') info_.model += fmt::format(" ({})", serial);
    double force_N = 0.0, continuous_N = 0.0, workspace_mm[6] = {};
    api_->GetDoublev(hd::kNominalMaxForce, &force_N);
    api_->GetDoublev(hd::kNominalMaxContinuousForce, &continuous_N);
    api_->GetDoublev(hd::kUsableWorkspace, workspace_mm);
    if (force_N > 0.0) info_.max_force_N = force_N;
    if (continuous_N > 0.0) info_.max_continuous_force_N = continuous_N;
    const Box workspace{1e-3 * Vec3(workspace_mm[0], workspace_mm[1], workspace_mm[2]),
                        1e-3 * Vec3(workspace_mm[3], workspace_mm[4], workspace_mm[5])};
    if (glm::all(glm::lessThan(workspace.low, workspace.high))) info_.workspace_m = workspace;
    drain_errors();  // a device that does not tell keeps the defaults
}

void OpenHapticsDevice::close() noexcept {
    stop_clock();
    if (api_ == nullptr || handle_ == hd::kInvalidHandle) return;
    api_->MakeCurrentDevice(handle_);
    api_->Disable(hd::kForceOutput);
    api_->DisableDevice(handle_);
    handle_ = hd::kInvalidHandle;
    drain_errors();
}

Fault OpenHapticsDevice::drain_errors() noexcept {
    Fault worst = Fault::none;
    for (int k = 0; k < kMostErrors; ++k) {
        const Fault fault = fault_of(api_->GetError().code);
        if (fault == Fault::none) break;
        worst = worse(worst, fault);
    }
    return worst;
}

bool OpenHapticsDevice::calibrated() noexcept {
    if (calibrated_ || frames_++ % kFramesPerCheck != 0) return calibrated_;
    const hd::Enum state = api_->CheckCalibration();
    calibrated_ = state == hd::kCalibrationOk;
    if (state == hd::kCalibrationNeedsUpdate) {
        int styles = 0;
        api_->GetIntegerv(hd::kCalibrationStyle, &styles);
        // The lowest style that the device offers: encoder reset, then by itself, then in the inkwell.
        if (styles != 0) api_->UpdateCalibration(static_cast<hd::Enum>(styles & -styles));
    }
    return calibrated_;
}

Fault OpenHapticsDevice::read(double, DeviceSample& sample) noexcept {
    if (handle_ == hd::kInvalidHandle) return Fault::disconnected;
    if (fault_ == Fault::disconnected) return fault_;
    const bool good = calibrated();
    api_->BeginFrame(handle_);
    in_frame_ = true;
    double t[16] = {}, velocity_mm_per_s[3] = {};
    int buttons = 0;
    api_->GetDoublev(hd::kCurrentTransform, t);
    api_->GetDoublev(hd::kCurrentVelocity, velocity_mm_per_s);
    api_->GetIntegerv(hd::kCurrentButtons, &buttons);
    // Its stylus' z axis runs from the tip to the hand; ours from the hand to the tip: half a turn about x.
    const Vec3 x(t[0], t[1], t[2]), y(t[4], t[5], t[6]), z(t[8], t[9], t[10]);
    sample.position_m = 1e-3 * Vec3(t[12], t[13], t[14]);
    sample.orientation = glm::quat_cast(Mat3(x, -y, -z));
    sample.velocity_m_per_s = 1e-3 * Vec3(velocity_mm_per_s[0], velocity_mm_per_s[1], velocity_mm_per_s[2]);
    sample.has_velocity = true;
    sample.buttons = static_cast<std::uint32_t>(buttons);
    if (fault_ != Fault::none) return fault_;
    return good ? Fault::none : Fault::not_calibrated;
}

Fault OpenHapticsDevice::write(const Vec3& force_N) noexcept {
    if (!in_frame_) return Fault::disconnected;
    const double force[3] = {force_N.x, force_N.y, force_N.z};
    api_->SetDoublev(hd::kCurrentForce, force);
    api_->EndFrame(handle_);
    in_frame_ = false;
    fault_ = drain_errors();
    return fault_;
}

bool OpenHapticsDevice::start_clock(Tick tick, void* user) {
    tick_ = tick;
    user_ = user;
    scheduled_ = api_->ScheduleAsynchronous(
        [](void* self) -> unsigned int {
            auto* device = static_cast<OpenHapticsDevice*>(self);
            device->tick_(device->user_);
            return hd::kCallbackContinue;
        },
        this, hd::kMostPriority);
    api_->StartScheduler();
    running_ = true;
    return true;
}

void OpenHapticsDevice::stop_clock() noexcept {
    if (!running_) return;
    // The scheduler first: afterwards no callback runs any more, whatever the library does with unscheduled ones.
    api_->StopScheduler();
    api_->Unschedule(scheduled_);
    running_ = false;
}

}  // namespace calot::haptics
