#pragma once
// Devices by name, as command lines and menus offer them.

#include <memory>
#include <string>
#include <vector>

#include "calot/haptics/device.h"
#include "calot/haptics/network.h"
#include "calot/haptics/simulated.h"

namespace calot::haptics {

struct DeviceChoice {
    std::string kind = "auto";          ///< "auto", "openhaptics", "simulated", "network"
    std::string openhaptics_device{};   ///< name in its configuration; empty: the default device
    std::string openhaptics_library{};  ///< path of libHD.so; empty: where it is customarily found
    NetworkOptions network{};
    std::vector<HandKey> script = press_and_release(0.01, 4.0);  ///< of the simulated hand
};

/// The device, not yet open. "auto" is OpenHaptics where its library is installed, otherwise nothing: a program that
/// does not ask for a simulated hand shall not get one. Throws InputError for an unknown kind, and for "auto" without
/// any device.
std::unique_ptr<HapticDevice> make_device(const DeviceChoice& choice);

/// What there is, for `calot haptics --list`.
struct ListedDevice {
    std::string kind, state;
    bool available = false;
};
std::vector<ListedDevice> list_devices(const std::string& openhaptics_library = "");

}  // namespace calot::haptics
