#include "frames.h"

#include <filesystem>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/render/video.h"

namespace calot::app {

namespace {

/// One view is drawn while the next is filled and a third waits.
constexpr std::size_t kViews = 3;
constexpr const char* kVideo = "dissection.mp4";
constexpr double kHalfTick_s = 0.5e-3;

render::Quality quality_of(const std::string& word) {
    return word == "low" ? render::Quality::low : word == "high" ? render::Quality::high : render::Quality::medium;
}

}  // namespace

Frames::Frames(const FrameSettings& settings) : settings_(settings) {
    if (settings_.kind == FrameKind::none) return;
    want_video_ = settings_.kind == FrameKind::video;
    if (want_video_ && !render::VideoWriter::available()) {
        want_video_ = false;
        notes_.push_back("no video: there is no ffmpeg program on PATH; stills are in frames/");
    }
    for (std::size_t k = 0; k < kViews; ++k) idle_.push_back(std::make_unique<render::View>());
    thread_ = std::thread([this] { work(); });
}

Frames::~Frames() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

double Frames::still_time_s(int k) const {
    const int last = settings_.picture.stills - 1;
    return last > 0 ? settings_.start_s + (settings_.duration_s - settings_.start_s) * k / last : settings_.start_s;
}
bool Frames::still_due(double time_s) const {
    return next_still_ < settings_.picture.stills && time_s >= still_time_s(next_still_) - kHalfTick_s;
}
bool Frames::frame_due(double time_s) const {
    return want_video_ &&
           time_s >=
               settings_.start_s + static_cast<double>(next_frame_) / settings_.picture.frames_per_second - kHalfTick_s;
}
bool Frames::due(double time_s) const {
    return thread_.joinable() && (still_due(time_s) || frame_due(time_s));
}

std::unique_ptr<render::View> Frames::take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !idle_.empty() || dead_; });
    if (idle_.empty()) return std::make_unique<render::View>();
    std::unique_ptr<render::View> view = std::move(idle_.back());
    idle_.pop_back();
    return view;
}

void Frames::submit(std::unique_ptr<render::View> view) {
    Job job;
    job.still = still_due(view->time_s);
    job.frame = frame_due(view->time_s);
    if (job.still) ++next_still_;
    if (job.frame) ++next_frame_;
    job.view = std::move(view);
    {
        const std::lock_guard lock(mutex_);
        if (dead_ && error_) std::rethrow_exception(error_);
        if (dead_) return;
        jobs_.push_back(std::move(job));
    }
    changed_.notify_all();
}

void Frames::finish() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
    if (error_) std::rethrow_exception(error_);
}

void Frames::work() {
    try {
        draw_all();
    } catch (const InputError&) {
        error_ = std::current_exception();  // a file could not be written
    } catch (const std::system_error&) {
        error_ = std::current_exception();
    } catch (const std::exception& error) {
        notes_.push_back(fmt::format("pictures ended: {}", error.what()));
    }
    const std::lock_guard lock(mutex_);
    dead_ = true;
    changed_.notify_all();
}

void Frames::draw_all() {
    const scene::Picture& picture = settings_.picture;
    render::OffscreenContext context;
    render::Renderer renderer(picture.width, picture.height, quality_of(picture.quality));
    renderer_ = context.description();
    std::unique_ptr<render::VideoWriter> video;
    if (want_video_)
        video = std::make_unique<render::VideoWriter>(settings_.directory + "/" + kVideo, picture.width, picture.height,
                                                      picture.frames_per_second);
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return !jobs_.empty() || closing_; });
            if (jobs_.empty()) break;
            job = std::move(jobs_.front());
            jobs_.pop_front();
        }
        renderer.draw(*job.view);
        const render::Image image = renderer.read();
        if (video && job.frame) video->add(image);
        if (job.still) {
            std::filesystem::create_directories(settings_.directory + "/frames");
            const std::string file = fmt::format("frames/t{:08.3f}s.png", job.view->time_s);
            render::write_png(settings_.directory + "/" + file, image);
            stills_.push_back({job.view->time_s, file});
        }
        {
            const std::lock_guard lock(mutex_);
            idle_.push_back(std::move(job.view));
        }
        changed_.notify_all();
    }
    if (video) {
        video->finish();
        video_ = kVideo;
    }
}

}  // namespace calot::app
