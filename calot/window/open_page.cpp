#include "calot/window/open_page.h"

#include <spawn.h>
#include <sys/wait.h>

#include <thread>

extern char** environ;

namespace calot::window {

bool open_page(const std::string& path) {
    std::string program = "xdg-open", argument = path;
    char* arguments[] = {program.data(), argument.data(), nullptr};
    pid_t child = -1;
    if (::posix_spawnp(&child, "xdg-open", nullptr, nullptr, arguments, environ) != 0) return false;
    std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
    return true;
}

}  // namespace calot::window
