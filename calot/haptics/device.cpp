#include "calot/haptics/device.h"

namespace calot::haptics {

const char* describe(Fault fault) {
    switch (fault) {
        case Fault::none:
            return "none";
        case Fault::absent:
            return "nobody is connected";
        case Fault::disconnected:
            return "the device is disconnected";
        case Fault::device_error:
            return "the device reports an error";
        case Fault::motors_warm:
            return "the device's motors are warm";
        case Fault::not_calibrated:
            return "the device is not calibrated";
        case Fault::not_finite:
            return "a pose or force is not a number";
        case Fault::simulation_late:
            return "the simulation is late";
    }
    return "";
}

}  // namespace calot::haptics
