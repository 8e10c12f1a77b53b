#pragma once
// Draws pictures beside the simulation: the run hands over views, a thread of its own draws them to stills and video.

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "calot/render/renderer.h"
#include "calot/scene/scene.h"
#include "commands.h"

namespace calot::app {

struct Still {
    double time_s = 0.0;
    std::string file;  ///< relative to the output directory
};

struct FrameSettings {
    FrameKind kind = FrameKind::none;
    scene::Picture picture;
    double start_s = 0.0, duration_s = 0.0;  ///< from, up to
    std::string directory;  ///< output directory (the temporary one)
};

class Frames {
  public:
    /// Starts the drawing thread. Trouble with OpenGL or ffmpeg is no error: it ends in notes(), and pictures are
    /// missing.
    explicit Frames(const FrameSettings& settings);
    ~Frames();

    /// Whether a picture is due at this time.
    bool due(double time_s) const;
    /// An empty or used view to fill. Waits when drawing is behind.
    std::unique_ptr<render::View> take();
    /// Hands a filled view over.
    void submit(std::unique_ptr<render::View> view);
    /// Draws what is left, ends the video. Throws what went wrong with files (disk full).
    void finish();

    const std::vector<Still>& stills() const { return stills_; }  ///< after finish()
    const std::string& video() const { return video_; }           ///< file name, empty without; after finish()
    const std::vector<std::string>& notes() const { return notes_; }
    const std::string& renderer() const { return renderer_; }

  private:
    struct Job {
        std::unique_ptr<render::View> view;
        bool still = false, frame = false;
    };
    void work();
    void draw_all();
    bool still_due(double time_s) const;
    bool frame_due(double time_s) const;
    double still_time_s(int k) const;

    FrameSettings settings_;
    bool want_video_ = false;
    int next_still_ = 0;
    std::int64_t next_frame_ = 0;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    std::vector<std::unique_ptr<render::View>> idle_;
    bool closing_ = false, dead_ = false;
    std::exception_ptr error_;
    std::thread thread_;

    std::vector<Still> stills_;
    std::string video_, renderer_;
    std::vector<std::string> notes_;
};

}  // namespace calot::app
