// A stand-in for libHD.so. Values are written out from the public documentation, apart from those in
// calot/haptics/hd_api.h, so that a slip in one does not hide in the other.
#include "stand_in_hd.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

namespace {

using Callback = unsigned (*)(void*);
struct Scheduled {
    unsigned long id;
    Callback callback;
    void* user;
};

struct World {
    StandInRecord record{};
    double position_mm[3] = {0.0, 0.0, 0.0}, velocity_mm_per_s[3] = {0.0, 0.0, 0.0};
    double axes[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    double wanted_N[3] = {0.0, 0.0, 0.0};
    int buttons = 0;
    bool plugged = true, in_frame = false, own_thread = false;
    unsigned fail_once = 0, calibration = 0x5000, handle = 0, next_handle = 7;
    unsigned long next_id = 1;
    std::deque<unsigned> errors;
    std::vector<Scheduled> scheduled;
};

std::recursive_mutex mutex;
World world;
std::thread scheduler;

using Lock = std::lock_guard<std::recursive_mutex>;

void misuse(unsigned error) {
    ++world.record.misuse;
    world.errors.push_back(error);
}
bool valid(unsigned handle) {
    if (handle == world.handle && world.record.device_open == 1) return true;
    misuse(0x0104);  // HD_BAD_HANDLE
    return false;
}
void no_force() {
    for (double& force : world.record.force_N) force = 0.0;
    for (double& force : world.wanted_N) force = 0.0;
}

/// One turn of the scheduler. The callbacks run without the lock, as they call back in.
int turn() {
    std::vector<Scheduled> due;
    {
        const Lock lock(mutex);
        if (world.record.scheduler_running == 0) return 0;
        due = world.scheduled;
    }
    for (const Scheduled& s : due)
        if (s.callback(s.user) == 0) {  // HD_CALLBACK_DONE
            const Lock lock(mutex);
            std::erase_if(world.scheduled, [&](const Scheduled& other) { return other.id == s.id; });
        }
    return static_cast<int>(due.size());
}

}  // namespace

extern "C" {

// --- HDAPI

unsigned hdInitDevice(const char* configuration) {
    const Lock lock(mutex);
    std::snprintf(world.record.configuration, sizeof(world.record.configuration), "%s",
                  configuration != nullptr ? configuration : "(default)");
    if (!world.plugged) {
        world.errors.push_back(0x0300);  // HD_DEVICE_FAULT
        return 0xFFFFFFFFu;
    }
    if (world.record.device_open == 1) {
        misuse(0x0301);  // HD_DEVICE_ALREADY_INITIATED
        return 0xFFFFFFFFu;
    }
    world.record.device_open = 1;
    world.record.forces_enabled = 0;
    ++world.record.initialised;
    world.handle = world.next_handle++;
    return world.handle;
}
void hdDisableDevice(unsigned handle) {
    const Lock lock(mutex);
    if (!valid(handle)) return;
    no_force();
    world.record.device_open = world.record.forces_enabled = 0;
    ++world.record.disabled;
}
void hdMakeCurrentDevice(unsigned handle) {
    const Lock lock(mutex);
    valid(handle);
}
void hdBeginFrame(unsigned handle) {
    const Lock lock(mutex);
    if (!valid(handle)) return;
    if (world.in_frame) misuse(0x0400);  // HD_ILLEGAL_BEGIN
    world.in_frame = true;
}
void hdEndFrame(unsigned handle) {
    const Lock lock(mutex);
    if (!valid(handle)) return;
    if (!world.in_frame) return misuse(0x0401);  // HD_ILLEGAL_END
    world.in_frame = false;
    if (!world.plugged) {
        no_force();
        return world.errors.push_back(0x0302);  // HD_COMM_ERROR
    }
    if (world.fail_once != 0) {
        world.errors.push_back(world.fail_once);
        world.fail_once = 0;
        return no_force();
    }
    double square = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        world.record.force_N[axis] = world.record.forces_enabled != 0 ? world.wanted_N[axis] : 0.0;
        square += world.record.force_N[axis] * world.record.force_N[axis];
    }
    world.record.most_force_N = std::fmax(world.record.most_force_N, std::sqrt(square));
    ++world.record.frames;
}
void hdGetIntegerv(unsigned what, int* values) {
    const Lock lock(mutex);
    if (what == 0x2000) {
        *values = world.buttons;
    } else if (what == 0x2555) {
        *values = 2 | 4;  // HD_CALIBRATION_AUTO, HD_CALIBRATION_INKWELL
    } else {
        misuse(0x0100);  // HD_INVALID_ENUM
    }
}
void hdGetDoublev(unsigned what, double* values) {
    const Lock lock(mutex);
    switch (what) {
        case 0x2050:
            std::memcpy(values, world.position_mm, sizeof(world.position_mm));
            break;
        case 0x2051:
            std::memcpy(values, world.velocity_mm_per_s, sizeof(world.velocity_mm_per_s));
            break;
        case 0x2052:
            for (int column = 0; column < 3; ++column) {
                for (int row = 0; row < 3; ++row) values[4 * column + row] = world.axes[3 * column + row];
                values[4 * column + 3] = 0.0;
            }
            std::memcpy(values + 12, world.position_mm, sizeof(world.position_mm));
            values[15] = 1.0;
            break;
        case 0x2551: {
            const double box[6] = {-210, -110, -85, 210, 205, 130};
            std::memcpy(values, box, sizeof(box));
            break;
        }
        case 0x2603:
            *values = 3.3;
            break;
        case 0x2604:
            *values = 0.88;
            break;
        default:
            misuse(0x0100);
    }
}
const char* hdGetString(unsigned what) {
    return what == 0x2501 ? "Stand-in" : what == 0x2504 ? "0001" : nullptr;
}
void hdSetDoublev(unsigned what, const double* values) {
    const Lock lock(mutex);
    if (what != 0x2700) return misuse(0x0100);
    if (!world.in_frame) return misuse(0x0102);  // HD_INVALID_OPERATION
    std::memcpy(world.wanted_N, values, sizeof(world.wanted_N));
}
void hdEnable(unsigned what) {
    const Lock lock(mutex);
    if (what != 0x4000) return misuse(0x0100);
    world.record.forces_enabled = 1;
}
void hdDisable(unsigned what) {
    const Lock lock(mutex);
    if (what != 0x4000) return misuse(0x0100);
    world.record.forces_enabled = 0;
    no_force();
}
struct HDErrorInfo {
    unsigned code;
    int internal_code;
    unsigned handle;
};
HDErrorInfo hdGetError() {
    const Lock lock(mutex);
    if (world.errors.empty()) return {0, 0, 0xFFFFFFFFu};
    const unsigned code = world.errors.front();
    world.errors.pop_front();
    return {code, -5, world.handle};
}
const char* hdGetErrorString(unsigned code) {
    return code == 0x0300 ? "Device fault" : "Some error";
}
unsigned hdCheckCalibration() {
    const Lock lock(mutex);
    return world.calibration;
}
void hdUpdateCalibration(unsigned style) {
    const Lock lock(mutex);
    world.record.calibration_style = style;
    world.calibration = 0x5000;
}
unsigned long hdScheduleAsynchronous(Callback callback, void* user, unsigned short) {
    const Lock lock(mutex);
    world.scheduled.push_back({world.next_id, callback, user});
    return world.next_id++;
}
void hdUnschedule(unsigned long id) {
    const Lock lock(mutex);
    std::erase_if(world.scheduled, [&](const Scheduled& s) { return s.id == id; });
}
void hdStopScheduler() {
    {
        const Lock lock(mutex);
        world.record.scheduler_running = 0;
    }
    if (scheduler.joinable()) scheduler.join();
}
void hdStartScheduler() {
    const Lock lock(mutex);
    if (world.record.scheduler_running != 0) return misuse(0x0102);
    world.record.scheduler_running = 1;
    if (!world.own_thread) return;
    scheduler = std::thread([] {
        for (;;) {
            {
                const Lock inner(mutex);
                if (world.record.scheduler_running == 0) return;
            }
            turn();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    });
}

// --- Controls

void stand_in_reset() {
    hdStopScheduler();
    const Lock lock(mutex);
    world = World{};
}
void stand_in_record(StandInRecord* record) {
    const Lock lock(mutex);
    world.record.callbacks = static_cast<int>(world.scheduled.size());
    *record = world.record;
}
void stand_in_set_stylus(const double* position_mm, const double* axes, int buttons) {
    const Lock lock(mutex);
    for (int axis = 0; axis < 3; ++axis)
        world.velocity_mm_per_s[axis] = 1000.0 * (position_mm[axis] - world.position_mm[axis]);
    std::memcpy(world.position_mm, position_mm, sizeof(world.position_mm));
    std::memcpy(world.axes, axes, sizeof(world.axes));
    world.buttons = buttons;
}
void stand_in_plug(int in) {
    const Lock lock(mutex);
    world.plugged = in != 0;
}
void stand_in_fail_once(unsigned code) {
    const Lock lock(mutex);
    world.fail_once = code;
}
void stand_in_set_calibration(unsigned state) {
    const Lock lock(mutex);
    world.calibration = state;
}
void stand_in_use_thread(int own) {
    const Lock lock(mutex);
    world.own_thread = own != 0;
}
int stand_in_run(int times) {
    int called = 0;
    for (int k = 0; k < times; ++k) called += turn();
    return called;
}

}  // extern "C"
