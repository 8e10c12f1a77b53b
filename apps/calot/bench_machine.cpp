#include "bench_machine.h"

#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <hwy/targets.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace calot::app {

namespace {

/// "model name : X" of /proc/cpuinfo.
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    std::string family, model;
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos) continue;
        const std::string value = line.substr(colon + 2);
        if (line.rfind("model name", 0) == 0)
            return family.empty() ? value : fmt::format("{} (family {}, model {})", value, family, model);
        if (line.rfind("cpu family", 0) == 0) family = value;
        if (line.rfind("model\t", 0) == 0) model = value;
    }
    return "unknown";
}

std::string system_name() {
    utsname names{};
    return ::uname(&names) == 0 ? fmt::format("{} {} {}", names.sysname, names.release, names.machine) : "unknown";
}

constexpr int kPriority = 20;  // of 1 to 99: above ordinary programs, below the kernel's own threads

std::string scheduling_name() {
    sched_param parameters{};
    const int policy = ::sched_getscheduler(0);
    ::sched_getparam(0, &parameters);
    if (policy == SCHED_FIFO) return fmt::format("SCHED_FIFO, priority {}", parameters.sched_priority);
    const int niceness = ::getpriority(PRIO_PROCESS, 0);
    return niceness == 0 ? "ordinary" : fmt::format("ordinary, nice {}", niceness);
}

}  // namespace

Machine describe_machine() {
    Machine machine;
    machine.processor = processor_name();
    machine.system = system_name();
#ifdef __VERSION__
    machine.compiler = fmt::format("{} {}",
#ifdef __clang__
                                   "clang",
#else
                                   "g++",
#endif
                                   __VERSION__);
#endif
    const std::int64_t targets = hwy::SupportedTargets();
    machine.instruction_set = hwy::TargetName(targets & -targets);  // the lowest bit is the best one
    machine.cores = static_cast<int>(std::thread::hardware_concurrency());
    machine.memory_GB =
        static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE)) * 1e-9;
    std::ifstream("/proc/loadavg") >> machine.load;
    machine.scheduling = scheduling_name();
    return machine;
}

void ask_for_real_time(Machine& machine) {
    machine.memory_locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    sched_param parameters{};
    parameters.sched_priority = kPriority;
    const bool granted = ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
    machine.scheduling = scheduling_name() + (granted ? "" : " (real time is not permitted)");
}

}  // namespace calot::app
