#pragma once
// The part of OpenHaptics' HDAPI that Calot calls, declared from its public documentation and loaded at run time, so
// that one program works with and without the library (docs/haptics.md says what each value was compared with).

#include <memory>
#include <string>

namespace calot::haptics::hd {

using Handle = unsigned int;
using Enum = unsigned int;
using Scheduled = unsigned long;
using Callback = unsigned int (*)(void* user);

struct ErrorInfo {
    unsigned int code;
    int internal_code;
    Handle handle;
};

inline constexpr Handle kInvalidHandle = 0xFFFFFFFFu;  // HD_INVALID_HANDLE
inline constexpr unsigned int kCallbackContinue = 1;   // HD_CALLBACK_CONTINUE
inline constexpr unsigned short kMostPriority = 0xFFFF;

// Errors
inline constexpr unsigned int kSuccess = 0x0000;
inline constexpr unsigned int kWarmMotors = 0x0200;            // HD_WARM_MOTORS
inline constexpr unsigned int kExceededMaxForce = 0x0201;      // HD_EXCEEDED_MAX_FORCE
inline constexpr unsigned int kExceededForceImpulse = 0x0202;  // HD_EXCEEDED_MAX_FORCE_IMPULSE
inline constexpr unsigned int kExceededMaxVelocity = 0x0203;   // HD_EXCEEDED_MAX_VELOCITY
inline constexpr unsigned int kForceError = 0x0204;            // HD_FORCE_ERROR
inline constexpr unsigned int kDeviceFault = 0x0300;           // HD_DEVICE_FAULT
inline constexpr unsigned int kCommError = 0x0302;             // HD_COMM_ERROR
inline constexpr unsigned int kCommConfigError = 0x0303;       // HD_COMM_CONFIG_ERROR
inline constexpr unsigned int kTimerError = 0x0304;            // HD_TIMER_ERROR
inline constexpr unsigned int kBadHandle = 0x0104;             // HD_BAD_HANDLE

// What can be read
inline constexpr Enum kCurrentButtons = 0x2000;             // HD_CURRENT_BUTTONS, 1 integer
inline constexpr Enum kCurrentPosition = 0x2050;            // HD_CURRENT_POSITION, 3 doubles, mm
inline constexpr Enum kCurrentVelocity = 0x2051;            // HD_CURRENT_VELOCITY, 3 doubles, mm/s
inline constexpr Enum kCurrentTransform = 0x2052;           // HD_CURRENT_TRANSFORM, 16 doubles, column by column, mm
inline constexpr Enum kDeviceModelType = 0x2501;            // HD_DEVICE_MODEL_TYPE, text
inline constexpr Enum kDeviceSerialNumber = 0x2504;         // HD_DEVICE_SERIAL_NUMBER, text
inline constexpr Enum kUsableWorkspace = 0x2551;            // HD_USABLE_WORKSPACE_DIMENSIONS, 6 doubles, mm
inline constexpr Enum kCalibrationStyle = 0x2555;           // HD_CALIBRATION_STYLE, 1 integer, bits
inline constexpr Enum kNominalMaxForce = 0x2603;            // HD_NOMINAL_MAX_FORCE, 1 double, N
inline constexpr Enum kNominalMaxContinuousForce = 0x2604;  // HD_NOMINAL_MAX_CONTINUOUS_FORCE, 1 double, N
// What can be written
inline constexpr Enum kCurrentForce = 0x2700;  // HD_CURRENT_FORCE, 3 doubles, N
// What can be switched on
inline constexpr Enum kForceOutput = 0x4000;  // HD_FORCE_OUTPUT
// Calibration
inline constexpr Enum kCalibrationOk = 0x5000;                // HD_CALIBRATION_OK
inline constexpr Enum kCalibrationNeedsUpdate = 0x5001;       // HD_CALIBRATION_NEEDS_UPDATE
inline constexpr Enum kCalibrationNeedsManualInput = 0x5002;  // HD_CALIBRATION_NEEDS_MANUAL_INPUT

/// The library's functions. All are there, or load() failed.
struct Api {
    Handle (*InitDevice)(const char* configuration) = nullptr;
    void (*DisableDevice)(Handle) = nullptr;
    void (*MakeCurrentDevice)(Handle) = nullptr;
    void (*BeginFrame)(Handle) = nullptr;
    void (*EndFrame)(Handle) = nullptr;
    void (*GetIntegerv)(Enum, int*) = nullptr;
    void (*GetDoublev)(Enum, double*) = nullptr;
    const char* (*GetString)(Enum) = nullptr;
    void (*SetDoublev)(Enum, const double*) = nullptr;
    void (*Enable)(Enum) = nullptr;
    void (*Disable)(Enum) = nullptr;
    ErrorInfo (*GetError)() = nullptr;
    const char* (*GetErrorString)(unsigned int) = nullptr;
    Enum (*CheckCalibration)() = nullptr;
    void (*UpdateCalibration)(Enum) = nullptr;
    Scheduled (*ScheduleAsynchronous)(Callback, void* user, unsigned short priority) = nullptr;
    void (*Unschedule)(Scheduled) = nullptr;
    void (*StartScheduler)() = nullptr;
    void (*StopScheduler)() = nullptr;
};

/// Loads the library: `path`, or where it is customarily found when `path` is empty. Returns nothing, with `why` set,
/// when there is none or it lacks a function. It is never unloaded: its threads may outlive their callbacks.
const Api* load(const std::string& path, std::string& why);

}  // namespace calot::haptics::hd
