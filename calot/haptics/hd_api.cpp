#include "calot/haptics/hd_api.h"

#include <dlfcn.h>

#include <fmt/format.h>

#include "calot/base/library.h"

namespace calot::haptics::hd {

namespace {

std::string find_all(void* library, Api& api) {
    std::string missing;
    find_function(library, "hdInitDevice", api.InitDevice, missing);
    find_function(library, "hdDisableDevice", api.DisableDevice, missing);
    find_function(library, "hdMakeCurrentDevice", api.MakeCurrentDevice, missing);
    find_function(library, "hdBeginFrame", api.BeginFrame, missing);
    find_function(library, "hdEndFrame", api.EndFrame, missing);
    find_function(library, "hdGetIntegerv", api.GetIntegerv, missing);
    find_function(library, "hdGetDoublev", api.GetDoublev, missing);
    find_function(library, "hdGetString", api.GetString, missing);
    find_function(library, "hdSetDoublev", api.SetDoublev, missing);
    find_function(library, "hdEnable", api.Enable, missing);
    find_function(library, "hdDisable", api.Disable, missing);
    find_function(library, "hdGetError", api.GetError, missing);
    find_function(library, "hdGetErrorString", api.GetErrorString, missing);
    find_function(library, "hdCheckCalibration", api.CheckCalibration, missing);
    find_function(library, "hdUpdateCalibration", api.UpdateCalibration, missing);
    find_function(library, "hdScheduleAsynchronous", api.ScheduleAsynchronous, missing);
    find_function(library, "hdUnschedule", api.Unschedule, missing);
    find_function(library, "hdStartScheduler", api.StartScheduler, missing);
    find_function(library, "hdStopScheduler", api.StopScheduler, missing);
    return missing;
}

}  // namespace

const Api* load(const std::string& path, std::string& why) {
    static Api api;
    static std::string loaded_from;
    static bool loaded = false;
    if (loaded && (path.empty() || path == loaded_from)) return &api;
    if (loaded) {
        why = fmt::format("{} is loaded already; a program holds one OpenHaptics library", loaded_from);
        return nullptr;
    }
    void* library = nullptr;
    const char* const customary[] = {"libHD.so", "libHD.so.3.4", "libHD.so.3.0"};
    if (!path.empty()) {
        library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) why = dlerror();
    } else {
        for (const char* name : customary)
            if (library == nullptr) library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) why = "OpenHaptics (libHD.so) is not installed";
    }
    if (library == nullptr) return nullptr;
    const std::string missing = find_all(library, api);
    if (!missing.empty()) {
        dlclose(library);
        why = fmt::format("the library lacks {}", missing);
        return nullptr;
    }
    loaded = true;
    loaded_from = path;
    return &api;
}

}  // namespace calot::haptics::hd
