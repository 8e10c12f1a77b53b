#pragma once
// Runs the real program and keeps what it said.

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/paths.h"

extern char** environ;

namespace calot::test {

struct Outcome {
    int code = -1;       ///< exit code; 128 + signal when a signal ended it
    std::string output;  ///< standard output and error together
};

/// The program while it runs.
class Program {
  public:
    explicit Program(const std::vector<std::string>& arguments, const std::string& directory = ".") {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
        posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
        posix_spawn_file_actions_addchdir_np(&actions, directory.c_str());
        std::vector<std::string> words{CALOT_PROGRAM};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const int failed = ::posix_spawn(&pid_, CALOT_PROGRAM, &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        pipe_ = ends[0];
        if (failed != 0) throw std::runtime_error(std::string("cannot start ") + CALOT_PROGRAM);
    }
    ~Program() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        ::close(pipe_);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void signal(int number) const { ::kill(pid_, number); }
    Outcome wait() {
        std::string output;
        char bytes[4096];
        for (ssize_t count; (count = ::read(pipe_, bytes, sizeof(bytes))) > 0;)
            output.append(bytes, static_cast<std::size_t>(count));
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = -1;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), output};
    }

  private:
    pid_t pid_ = -1;
    int pipe_ = -1;
};

/// `directory`: where the program works.
inline Outcome run(const std::vector<std::string>& arguments, const std::string& directory = ".") {
    return Program(arguments, directory).wait();
}

/// A directory of the test's own, gone afterwards.
class Folder {
  public:
    explicit Folder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / ("calot_" + name + "." + std::to_string(::getpid()))) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }
    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return *this / name;
    }

  private:
    std::filesystem::path path_;
};

inline std::string read_file(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
}

/// A block of 1152 hexels that is cut for 50 ms: everything happens, in a blink.
inline constexpr const char* kTinyScene = R"(
[scene]
name = "tiny"
[anatomy]
kind = "block"
[block]
size_mm = [7.2, 7.2, 4.8]
[electric]
window_cells = 16
voltage_limit_V = 1000
[materials.fat]
removal_temperature_C = 120
water_mass_fraction = 0.05
electric_conductivity_S_per_m = 0.1
solid_latent_heat_J_per_kg = 1e4
[picture]
width = 96
height = 64
frames_per_second = 50
quality = "low"
stills = 2
[run]
duration_s = 0.06
[[script.key]]
t = 0
offset_mm = [0, 0, 0.6]
[[script.key]]
t = 0.02
offset_mm = [0, 0, -0.8]
[[script.burst]]
from = 0.01
to = 0.06
power_W = 120
)";

}  // namespace calot::test
