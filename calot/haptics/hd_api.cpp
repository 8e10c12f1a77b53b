#include "calot/haptics/hd_api.h"

#include <dlfcn.h>

#include <fmt/format.h>

namespace calot::haptics::hd {

namespace {

template <class F>
void find(void* library, const char* name, F& function, std::string& missing) {
    void* symbol = dlsym(library, name);
    if (symbol == nullptr) missing += (missing.empty() ? "" : ", ") + std::string(name);
    function = reinterpret_cast<F>(symbol);
}

std::string find_all(void* library, Api& api) {
    std::string missing;
    find(library, "hdInitDevice", api.InitDevice, missing);
    find(library, "hdDisableDevice", api.DisableDevice, missing);
    find(library, "hdMakeCurrentDevice", api.MakeCurrentDevice, missing);
    find(library, "hdBeginFrame", api.BeginFrame, missing);
    find(library, "hdEndFrame", api.EndFrame, missing);
    find(library, "hdGetIntegerv", api.GetIntegerv, missing);
    find(library, "hdGetDoublev", api.GetDoublev, missing);
    find(library, "hdGetString", api.GetString, missing);
    find(library, "hdSetDoublev", api.SetDoublev, missing);
    find(library, "hdEnable", api.Enable, missing);
    find(library, "hdDisable", api.Disable, missing);
    find(library, "hdGetError", api.GetError, missing);
    find(library, "hdGetErrorString", api.GetErrorString, missing);
    find(library, "hdCheckCalibration", api.CheckCalibration, missing);
    find(library, "hdUpdateCalibration", api.UpdateCalibration, missing);
    find(library, "hdScheduleAsynchronous", api.ScheduleAsynchronous, missing);
    find(library, "hdUnschedule", api.Unschedule, missing);
    find(library, "hdStartScheduler", api.StartScheduler, missing);
    find(library, "hdStopScheduler", api.StopScheduler, missing);
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
