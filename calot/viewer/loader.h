#pragma once
// Builds a simulation in a thread of its own, so that the window keeps drawing meanwhile.

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "calot/scene/scene.h"
#include "calot/viewer/session.h"

namespace calot::viewer {

class Loader {
  public:
    /// Steps, in order; each has a text "loading.N" in the language file.
    enum class Step { scene, anatomy, tissue, picture, done };

    /// `make_scene` runs in the thread; so does `make_observers`.
    Loader(std::function<scene::Scene()> make_scene,
           std::function<std::vector<std::shared_ptr<Observer>>(const simulation::Setup&)> make_observers);
    ~Loader();

    Step step() const { return step_; }
    bool finished() const { return finished_; }
    /// Once finished: the session, not yet started; rethrows what went wrong.
    std::unique_ptr<Session> take();

  private:
    void work();

    std::function<scene::Scene()> make_scene_;
    std::function<std::vector<std::shared_ptr<Observer>>(const simulation::Setup&)> make_observers_;
    std::atomic<Step> step_{Step::scene};
    std::atomic<bool> finished_{false};
    std::unique_ptr<Session> session_;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace calot::viewer
