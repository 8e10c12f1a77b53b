#include "calot/haptics/choose.h"

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/haptics/hd_api.h"
#include "calot/haptics/network.h"
#include "calot/haptics/openhaptics.h"

namespace calot::haptics {

std::unique_ptr<HapticDevice> make_device(const DeviceChoice& choice) {
    if (choice.kind == "simulated") return std::make_unique<SimulatedDevice>(choice.script);
    if (choice.kind == "openhaptics")
        return std::make_unique<OpenHapticsDevice>(choice.openhaptics_device, choice.openhaptics_library);
    if (choice.kind == "network") return std::make_unique<NetworkDevice>(choice.network);
    if (choice.kind == "auto") {
        std::string why;
        if (hd::load(choice.openhaptics_library, why) == nullptr)
            throw InputError(fmt::format("no haptic device: {}", why),
                             "install OpenHaptics and its driver, or choose the device simulated or network");
        return std::make_unique<OpenHapticsDevice>(choice.openhaptics_device, choice.openhaptics_library);
    }
    throw InputError(fmt::format("'{}' is no haptic device", choice.kind),
                     "choose auto, openhaptics, simulated or network");
}

std::vector<ListedDevice> list_devices(const std::string& openhaptics_library) {
    std::vector<ListedDevice> devices;
    std::string why;
    const bool library = hd::load(openhaptics_library, why) != nullptr;
    if (library) {
        OpenHapticsDevice device("", openhaptics_library);
        why = device.open();
        if (why.empty()) {
            devices.push_back({"openhaptics", device.info().model, true});
        } else {
            devices.push_back({"openhaptics", fmt::format("library found, but {}", why), false});
        }
    } else {
        devices.push_back({"openhaptics", why, false});
    }
    devices.push_back({"simulated", "a spring-damper hand that presses and releases", true});
    devices.push_back({"network", "listens for other hardware once it is chosen", true});
    return devices;
}

}  // namespace calot::haptics
