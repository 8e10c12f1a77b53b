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

    /// What a session is made of.
    struct Start {
        std::shared_ptr<const simulation::Setup> setup;
        std::unique_ptr<simulation::Simulation> run;
        std::vector<std::shared_ptr<Observer>> observers;
    };

    /// All run in the thread. `prepare` may change the setup before anything is made of it; it may be empty.
    Loader(std::function<scene::Scene()> make_scene,
           std::function<std::vector<std::shared_ptr<Observer>>(const simulation::Setup&)> make_observers,
           std::function<void(simulation::Setup&)> prepare = {});
    /// The same for a run that there is already, somewhere: `make_start` runs in the thread.
    explicit Loader(std::function<Start()> make_start);
    ~Loader();

    Step step() const { return step_; }
    bool finished() const { return finished_; }
    /// Once finished: the session, not yet started; rethrows what went wrong.
    std::unique_ptr<Session> take();
    /// Then: what it was set up from.
    std::shared_ptr<const simulation::Setup> setup() const { return setup_; }

  private:
    void work(const std::function<Start()>& make_start);

    std::atomic<Step> step_{Step::scene};
    std::atomic<bool> finished_{false};
    std::shared_ptr<const simulation::Setup> setup_;
    std::unique_ptr<Session> session_;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace calot::viewer
