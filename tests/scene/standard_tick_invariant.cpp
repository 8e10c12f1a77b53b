// Ticks of the standard scene while it burns: nothing is allocated, and the system is not asked for anything.

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "calot/base/parallel.h"
#include "calot/scene/scene.h"
#include "calot/simulation/simulation.h"
#include "support/allocations.h"
#include "support/paths.h"

namespace calot::scene {

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // sanitizers ask the system now and then
#else
constexpr bool kSanitized = false;
#endif
#if defined(__x86_64__)
constexpr unsigned kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr unsigned kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr unsigned kArchitecture = 0;
#endif

constexpr double kWarm_s = 2.0;    ///< the hook is in the tissue and burns
constexpr double kLimit_s = 12.0;  ///< by then all has happened: hexels burn, links are severed, the surface changes

struct Events {
    std::int64_t ticks = 0, burnt = 0, severed = 0, with_contact = 0;
    std::uint64_t surfaces = 0;
    bool enough() const { return ticks >= 800 && burnt > 20 && severed > 0 && with_contact > 100 && surfaces > 5; }
};

/// Until enough has happened, or for so long.
Events advance(simulation::Simulation& run, double until_s, bool until_enough) {
    Events events;
    const std::int64_t burnt = run.state().hexels_burnt, severed = run.state().links_severed;
    const std::uint64_t version = run.surface().version();
    while (run.time_s() < until_s && !(until_enough && events.enough())) {
        if (!run.tick(run.setup().script.at(run.time_s()))) break;
        ++events.ticks;
        events.with_contact += run.work().exchange.contacts.empty() ? 0 : 1;
        events.burnt = run.state().hexels_burnt - burnt;
        events.severed = run.state().links_severed - severed;
        events.surfaces = run.surface().version() - version;
    }
    return events;
}

std::shared_ptr<simulation::Setup> standard_setup() {
    return std::make_shared<simulation::Setup>(build(load(CALOT_SOURCE_DIR "/scenes/calot.toml")));
}

/// From here on every system call but these three ends the process at once. False where that is not permitted.
bool forbid_system_calls() {
    const auto allow = [](long number) {
        return std::array<sock_filter, 2>{sock_filter{BPF_JMP | BPF_JEQ | BPF_K, 0, 1, static_cast<unsigned>(number)},
                                          sock_filter{BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW}};
    };
    std::vector<sock_filter> filter{
        {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, arch)},
        {BPF_JMP | BPF_JEQ | BPF_K, 1, 0, kArchitecture},
        {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_KILL_PROCESS},
        {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, nr)},
    };
    for (const long number : {long{SYS_exit_group}, long{SYS_write}, long{SYS_clock_gettime}})
        for (const sock_filter& line : allow(number)) filter.push_back(line);
    filter.push_back({BPF_RET | BPF_K, 0, 0, SECCOMP_RET_KILL_PROCESS});
    sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

constexpr int kNotPermitted = 77, kNothingHappened = 78;

/// Runs `body` in a process of its own, after which its exit code or the signal that ended it is known.
template <class Body>
int status_of_child(const Body& body) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(body());
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

}  // namespace

TEST(StandardTick, AllocatesNothingWhileItBurns) {
    if (kSanitized) GTEST_SKIP() << "sanitizers bring their own operator new";
    const ThreadLimit limit(1);
    simulation::Simulation run(standard_setup());
    advance(run, kWarm_s, false);
    const long before = test::allocations();
    const Events events = advance(run, kLimit_s, true);
    EXPECT_EQ(test::allocations() - before, 0);
    EXPECT_TRUE(events.enough()) << events.burnt << " burnt, " << events.severed << " severed, " << events.surfaces
                                 << " surfaces, " << events.with_contact << " ticks with contact";
}

TEST(StandardTick, AsksTheSystemForNothing) {
    if (kSanitized || kArchitecture == 0) GTEST_SKIP() << "not for this build";
    const ThreadLimit limit(1);
    simulation::Simulation run(standard_setup());
    advance(run, kWarm_s, false);
    const int status = status_of_child([&] {
        if (!forbid_system_calls()) return kNotPermitted;
        const Events events = advance(run, kLimit_s, true);
        return events.enough() ? 0 : kNothingHappened;
    });
    if (WIFEXITED(status) && WEXITSTATUS(status) == kNotPermitted)
        GTEST_SKIP() << "this system does not permit filters of system calls";
    EXPECT_FALSE(WIFSIGNALED(status)) << "a tick made a system call (signal " << WTERMSIG(status) << ")";
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// The same filter does notice a system call.
TEST(StandardTick, ASystemCallWouldBeNoticed) {
    if (kSanitized || kArchitecture == 0) GTEST_SKIP() << "not for this build";
    const int status = status_of_child([] {
        if (!forbid_system_calls()) return kNotPermitted;
        ::syscall(SYS_getppid);
        return 0;
    });
    if (WIFEXITED(status) && WEXITSTATUS(status) == kNotPermitted)
        GTEST_SKIP() << "this system does not permit filters of system calls";
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGSYS);
}

}  // namespace calot::scene
