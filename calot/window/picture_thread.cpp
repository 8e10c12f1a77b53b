#include "calot/window/picture_thread.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "calot/render/gl.h"

namespace calot::window {

namespace {

constexpr auto kNap = std::chrono::milliseconds(1);

}  // namespace

bool PictureWish::operator==(const PictureWish& other) const {
    return camera.eye_m == other.camera.eye_m && camera.target_m == other.camera.target_m &&
           camera.up == other.camera.up && lens.fog == other.lens.fog && lens.smear == other.lens.smear &&
           lens.seed == other.lens.seed && width == other.width && height == other.height && tier == other.tier;
}

PictureThread::PictureThread(GLFWwindow* shared, const std::string& gl_renderer)
    : governor_(viewer::start_tier(gl_renderer.c_str())) {
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    context_ = glfwCreateWindow(16, 16, "Calot's pictures", nullptr, shared);
    glfwWindowHint(GLFW_VISIBLE, GLFW_TRUE);
    if (context_ == nullptr) throw std::runtime_error("this OpenGL cannot share textures between two contexts");
    thread_ = std::thread([this] { work(); });
}

PictureThread::~PictureThread() {
    closing_ = true;
    thread_.join();
    glfwDestroyWindow(context_);
}

void PictureThread::show(TripleBuffer<viewer::Snapshot>* snapshots) {
    waiting_ = true;
    const std::lock_guard lock(mutex_);
    waiting_ = false;
    snapshots_ = snapshots;
}

void PictureThread::wish(const PictureWish& wish) {
    wishes_.back() = wish;
    wishes_.publish();
}

std::string PictureThread::take_trouble() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock.owns_lock() ? std::exchange(trouble_, {}) : std::string();
}

void PictureThread::work() {
    glfwMakeContextCurrent(context_);
    while (!closing_) {
        if (waiting_ || !draw_once()) std::this_thread::sleep_for(kNap);
    }
    renderer_.reset();
    for (Target& target : targets_) {
        if (target.framebuffer != 0) glDeleteFramebuffers(1, &target.framebuffer);
        if (target.texture != 0) glDeleteTextures(1, &target.texture);
    }
    glfwMakeContextCurrent(nullptr);
}

bool PictureThread::draw_once() {
    const std::lock_guard lock(mutex_);
    if (snapshots_ == nullptr || !trouble_.empty()) return false;
    // A wish comes with every turn of the window's loop: the scope may have moved while the patient did not.
    const bool moved = wishes_.update(), changed = snapshots_->update();
    if (!moved && !changed) return false;
    if (wishes_.front().width <= 0) return false;
    try {
        draw(snapshots_->front(), wishes_.front());
    } catch (const std::exception& error) {
        trouble_ = error.what();
    }
    return true;
}

void PictureThread::prepare(const PictureWish& wish) {
    if (wish.tier < 0)
        governor_.release();
    else
        governor_.fix(wish.tier);
    const viewer::Tier& tier = viewer::tiers()[static_cast<std::size_t>(governor_.tier())];
    const int width = std::max(64, static_cast<int>(std::lround(wish.width * tier.scale)));
    const int height = std::max(48, static_cast<int>(std::lround(wish.height * tier.scale)));
    if (!renderer_ || quality_ != tier.quality) {
        renderer_.reset();  // first, so that both do not need memory at once
        renderer_ = std::make_unique<render::Renderer>(width, height, tier.quality);
        quality_ = tier.quality;
    }
    renderer_->resize(width, height);
    prepare_target(targets_[next_target_], width, height);
}

void PictureThread::prepare_target(Target& target, int width, int height) {
    if (target.width == width && target.height == height) return;
    if (target.texture == 0) glGenTextures(1, &target.texture);
    if (target.framebuffer == 0) glGenFramebuffers(1, &target.framebuffer);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, target.texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture, 0);
    target.width = width;
    target.height = height;
}

void PictureThread::draw(viewer::Snapshot& snapshot, const PictureWish& wish) {
    Picture& picture = pictures_.back();
    // The slot's own texture, so that none is drawn into that the window may still show.
    for (next_target_ = 0; next_target_ < targets_.size(); ++next_target_)
        if (targets_[next_target_].texture != 0 && targets_[next_target_].texture == picture.texture) break;
    if (next_target_ == targets_.size())
        for (next_target_ = 0; next_target_ + 1 < targets_.size() && targets_[next_target_].texture != 0;)
            ++next_target_;
    prepare(wish);
    render::View& view = snapshot.view;
    placer_.place(snapshot.moment, view);
    const double begun_s = viewer::steady_s();
    view.camera = wish.camera;
    view.lens = wish.lens;
    renderer_->draw(view);
    const Target& target = targets_[next_target_];
    renderer_->present(target.framebuffer, target.width, target.height);
    glFinish();  // the window's context may use it from now on; and the time is that of drawing, not of asking
    const double now_s = viewer::steady_s();
    governor_.add(now_s - begun_s, now_s);
    picture.texture = target.texture;
    picture.width = target.width;
    picture.height = target.height;
    picture.figures = snapshot;
    picture.tier = governor_.tier();
    picture.draw_s = governor_.mean_s();
    pictures_.publish();
}

render::Image read_window(int width, int height) {
    render::Image image;
    image.width = width;
    image.height = height;
    const auto stride = static_cast<std::size_t>(width) * 3;
    std::vector<std::uint8_t> rows(stride * static_cast<std::size_t>(height));
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    render::gl::check("reading the window");
    image.rgb.resize(rows.size());
    for (int y = 0; y < height; ++y)
        std::copy_n(&rows[static_cast<std::size_t>(height - 1 - y) * stride], stride,
                    &image.rgb[static_cast<std::size_t>(y) * stride]);
    return image;
}

}  // namespace calot::window
