// Frames go as raw rgb24 through a pipe into the ffmpeg program, started without a shell so that any path is safe. It
// runs in a process group of its own: a terminal's Ctrl-C reaches us, not it, and the file is ended in order.

#include "calot/render/video.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace calot::render {

namespace {

/// Keeps SIGPIPE from this thread while it writes to a pipe whose reader may be gone.
class PipeSignalBlocked {
  public:
    PipeSignalBlocked() {
        sigemptyset(&pipe_);
        sigaddset(&pipe_, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
    }
    ~PipeSignalBlocked() {
        // A SIGPIPE raised meanwhile is pending on this thread: take it, unless it was blocked before us anyway.
        if (!sigismember(&before_, SIGPIPE)) {
            const timespec now{0, 0};
            while (sigtimedwait(&pipe_, nullptr, &now) < 0 && errno == EINTR) {
            }
        }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

  private:
    sigset_t pipe_;
    sigset_t before_;
};

std::string find_ffmpeg() {
    const char* path = std::getenv("PATH");
    if (path == nullptr) return "";
    std::string_view rest(path);
    while (!rest.empty()) {
        const std::size_t end = rest.find(':');
        const std::string program = std::string(rest.substr(0, end)) + "/ffmpeg";
        if (access(program.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(program)) return program;
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    }
    return "";
}

std::string last_lines(const std::string& text, std::size_t most = 600) {
    std::size_t end = text.find_last_not_of(" \n\r");
    if (end == std::string::npos) return "(it said nothing)";
    ++end;
    return text.substr(end > most ? end - most : 0, end > most ? most : end);
}

void close_fd(int& fd) {
    if (fd >= 0) close(fd);
    fd = -1;
}

}  // namespace

struct VideoWriter::Impl {
    std::string path;
    std::string temporary;
    int width = 0;
    int height = 0;
    pid_t child = -1;
    int to_child = -1;
    int from_child = -1;
    std::thread listener;  ///< reads ffmpeg's words, so that it never blocks on a full pipe
    std::string words;

    ~Impl() {
        if (child < 0) return;
        try {
            end();
        } catch (...) {
            // A destructor has nobody to tell; whatever ffmpeg wrote is at `temporary`, or removed by end().
        }
    }

    void start(const std::string& program, int frames_per_second);
    void add(const Image& image);
    void end();
    int wait_for_child();
};

void VideoWriter::Impl::start(const std::string& program, int frames_per_second) {
    int in[2] = {-1, -1}, out[2] = {-1, -1};
    if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0)
        throw std::runtime_error(std::string("cannot make a pipe to ffmpeg: ") + std::strerror(errno));
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    const std::string rate = std::to_string(frames_per_second);
    // A leading "./" or "/" keeps ffmpeg from reading the name as an option or a protocol.
    const std::string file = std::filesystem::absolute(temporary).string();
    std::vector<std::string> words_out = {program,
                                          "-hide_banner",
                                          "-nostdin",
                                          "-loglevel",
                                          "error",
                                          "-y",
                                          "-f",
                                          "rawvideo",
                                          "-pix_fmt",
                                          "rgb24",
                                          "-s",
                                          size,
                                          "-r",
                                          rate,
                                          "-i",
                                          "pipe:0",
                                          "-an",
                                          "-vf",
                                          "pad=ceil(iw/2)*2:ceil(ih/2)*2:0:0,scale=out_color_matrix=bt709:out_range=tv",
                                          "-c:v",
                                          "libx264",
                                          "-preset",
                                          "veryfast",
                                          "-crf",
                                          "20",
                                          "-pix_fmt",
                                          "yuv420p",
                                          "-colorspace",
                                          "bt709",
                                          "-color_primaries",
                                          "bt709",
                                          "-color_trc",
                                          "bt709",
                                          "-color_range",
                                          "tv",
                                          "-movflags",
                                          "+faststart",
                                          "-f",
                                          "mp4",
                                          "file:" + file};
    std::vector<char*> arguments;
    for (std::string& word : words_out) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    const int failed = posix_spawn(&child, program.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    close_fd(in[0]);
    close_fd(out[1]);
    to_child = in[1];
    from_child = out[0];
    if (failed != 0) {
        child = -1;
        close_fd(to_child);
        close_fd(from_child);
        throw std::runtime_error("cannot start " + program + ": " + std::strerror(failed));
    }
    listener = std::thread([this] {
        char chunk[4096];
        for (;;) {
            const ssize_t got = read(from_child, chunk, sizeof(chunk));
            if (got > 0) words.append(chunk, static_cast<std::size_t>(got));
            if (got == 0 || (got < 0 && errno != EINTR)) return;
        }
    });
}

int VideoWriter::Impl::wait_for_child() {
    close_fd(to_child);
    if (listener.joinable()) listener.join();
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    child = -1;
    close_fd(from_child);
    return status;
}

void VideoWriter::Impl::add(const Image& image) {
    if (child < 0) throw std::runtime_error("this video is finished");
    if (image.width != width || image.height != height)
        throw std::runtime_error("a frame of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                                 " does not fit a video of " + std::to_string(width) + " x " + std::to_string(height));
    const PipeSignalBlocked blocked;
    const std::uint8_t* from = image.rgb.data();
    std::size_t left = image.rgb.size();
    while (left > 0) {
        const ssize_t put = write(to_child, from, left);
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) {
            wait_for_child();
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            throw std::runtime_error("ffmpeg stopped while writing " + path + ": " + last_lines(words));
        }
        from += put;
        left -= static_cast<std::size_t>(put);
    }
}

void VideoWriter::Impl::end() {
    if (child < 0) return;
    const int status = wait_for_child();
    std::error_code error;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        std::filesystem::remove(temporary, error);
        throw std::runtime_error("ffmpeg could not write " + path + ": " + last_lines(words));
    }
    std::filesystem::rename(temporary, path, error);
    if (error) throw std::runtime_error("cannot rename " + temporary + " to " + path + ": " + error.message());
}

bool VideoWriter::available() {
    return !find_ffmpeg().empty();
}

VideoWriter::VideoWriter(const std::string& path, int width, int height, int frames_per_second)
    : impl_(std::make_unique<Impl>()) {
    const std::string program = find_ffmpeg();
    if (program.empty())
        throw std::runtime_error(
            "video needs the ffmpeg program on PATH; on Debian install ffmpeg, or write pictures instead");
    impl_->path = path;
    impl_->temporary = path + ".tmp";
    impl_->width = width;
    impl_->height = height;
    impl_->start(program, frames_per_second);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& image) {
    impl_->add(image);
}

void VideoWriter::finish() {
    impl_->end();
}

}  // namespace calot::render
