#pragma once
// Draws the operating field in a thread and an OpenGL context of its own, into textures that the window shares. However
// long a picture takes, or the making of a shader, the window goes on answering.

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "calot/base/triple_buffer.h"
#include "calot/render/renderer.h"
#include "calot/viewer/quality.h"
#include "calot/viewer/session.h"

struct GLFWwindow;

namespace calot::window {

/// What the window wants to see.
struct PictureWish {
    render::Camera camera;
    render::Lens lens;
    int width = 0, height = 0;  ///< of the window, pixels
    int tier = -1;              ///< -1: chosen automatically

    bool operator==(const PictureWish& other) const;
};

/// A finished picture and what it shows.
struct Picture {
    unsigned texture = 0;  ///< 0: none yet
    int width = 0, height = 0;
    viewer::Figures figures;
    int tier = 0;
    double draw_s = 0.0;  ///< mean
};

class PictureThread {
  public:
    /// `shared` is a window whose context shares with this thread's; called from the main thread.
    PictureThread(GLFWwindow* shared, const std::string& gl_renderer);
    ~PictureThread();
    PictureThread(const PictureThread&) = delete;
    PictureThread& operator=(const PictureThread&) = delete;

    /// Draws these snapshots from now on; null: rests. Returns once the old ones are no longer looked at.
    void show(TripleBuffer<viewer::Snapshot>* snapshots);
    void wish(const PictureWish& wish);
    /// True when there is a newer picture than the last.
    bool update() { return pictures_.update(); }
    const Picture& picture() const { return pictures_.front(); }
    /// What went wrong, once; empty: nothing.
    std::string take_trouble();

  private:
    struct Target {
        unsigned texture = 0, framebuffer = 0;
        int width = 0, height = 0;
    };
    void work();
    bool draw_once();
    void draw(viewer::Snapshot& snapshot, const PictureWish& wish);
    void prepare(const PictureWish& wish);
    void prepare_target(Target& target, int width, int height);

    GLFWwindow* context_;
    viewer::QualityGovernor governor_;
    std::unique_ptr<render::Renderer> renderer_;
    render::Quality quality_ = render::Quality::low;
    viewer::Placer placer_;
    std::array<Target, 3> targets_;
    std::size_t next_target_ = 0;
    TripleBuffer<PictureWish> wishes_;
    TripleBuffer<Picture> pictures_;

    std::mutex mutex_;  ///< held while a picture is drawn
    TripleBuffer<viewer::Snapshot>* snapshots_ = nullptr;
    std::string trouble_;
    std::atomic<bool> waiting_{false};  ///< somebody wants the mutex
    std::atomic<bool> closing_{false};
    std::thread thread_;
};

/// What the window shows, from its back buffer: call before swapping.
render::Image read_window(int width, int height);

}  // namespace calot::window
