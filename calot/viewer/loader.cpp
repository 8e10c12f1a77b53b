#include "calot/viewer/loader.h"

#include <utility>

namespace calot::viewer {

Loader::Loader(std::function<scene::Scene()> make_scene,
               std::function<std::vector<std::shared_ptr<Observer>>(const simulation::Setup&)> make_observers,
               std::function<void(simulation::Setup&)> prepare)
    : Loader([this, make_scene = std::move(make_scene), make_observers = std::move(make_observers),
              prepare = std::move(prepare)] {
          const scene::Scene scene = make_scene();
          step_ = Step::anatomy;
          auto setup = std::make_shared<simulation::Setup>(scene::build(scene));
          if (prepare) prepare(*setup);
          step_ = Step::tissue;
          Start start;
          start.run = std::make_unique<simulation::Simulation>(setup);
          start.setup = setup;
          if (make_observers) start.observers = make_observers(*setup);
          return start;
      }) {}

Loader::Loader(std::function<Start()> make_start)
    : thread_([this, make = std::move(make_start)] { work(make); }) {}

Loader::~Loader() {
    if (thread_.joinable()) thread_.join();
}

void Loader::work(const std::function<Start()>& make_start) {
    try {
        Start start = make_start();
        setup_ = std::move(start.setup);
        step_ = Step::picture;
        SessionOptions options;
        options.observers = std::move(start.observers);
        session_ = std::make_unique<Session>(std::move(start.run), std::move(options));
        step_ = Step::done;
    } catch (...) {
        error_ = std::current_exception();
    }
    finished_ = true;
}

std::unique_ptr<Session> Loader::take() {
    if (thread_.joinable()) thread_.join();
    if (error_) std::rethrow_exception(error_);
    return std::move(session_);
}

}  // namespace calot::viewer
