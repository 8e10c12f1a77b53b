#pragma once
// A display out of sight, with synthetic hands: Xvfb and xdotool.

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

extern char** environ;

namespace calot::window::test {

/// Starts a program with its words; -1 when it cannot be started.
inline pid_t start(std::vector<std::string> words, int keep_open = -1) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    if (keep_open < 0) posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t pid = -1;
    if (::posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ) != 0) pid = -1;
    posix_spawn_file_actions_destroy(&actions);
    return pid;
}

/// Runs a program to its end; true when it said that all went well.
inline bool run_tool(const std::vector<std::string>& words) {
    const pid_t pid = start(words);
    int status = 1;
    return pid > 0 && ::waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

class Display {
  public:
    Display(int width, int height) {
        int ends[2];
        if (::pipe(ends) != 0) return;
        pid_ = start({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0",
                      std::to_string(width) + "x" + std::to_string(height) + "x24", "-nolisten", "tcp",
                      "-noreset"},  // else it starts anew, without whoever is connecting, when xdotool was the last to leave
                     ends[1]);
        ::close(ends[1]);
        std::FILE* pipe = ::fdopen(ends[0], "r");
        int number = -1;
        if (pid_ > 0 && std::fscanf(pipe, "%d", &number) == 1) name_ = ":" + std::to_string(number);
        std::fclose(pipe);
        if (!name_.empty()) ::setenv("DISPLAY", name_.c_str(), 1);
    }
    ~Display() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
    }
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    bool works() const { return !name_.empty(); }

  private:
    pid_t pid_ = -1;
    std::string name_;
};

}  // namespace calot::window::test
