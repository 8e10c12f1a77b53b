#include "calot/viewer/loader.h"

#include <utility>

namespace calot::viewer {

Loader::Loader(std::function<scene::Scene()> make_scene,
               std::function<std::vector<std::shared_ptr<Observer>>(const simulation::Setup&)> make_observers)
    : make_scene_(std::move(make_scene)), make_observers_(std::move(make_observers)) {
    thread_ = std::thread([this] { work(); });
}

Loader::~Loader() {
    if (thread_.joinable()) thread_.join();
}

void Loader::work() {
    try {
        const scene::Scene scene = make_scene_();
        step_ = Step::anatomy;
        auto setup = std::make_shared<const simulation::Setup>(scene::build(scene));
        step_ = Step::tissue;
        auto run = std::make_unique<simulation::Simulation>(setup);
        step_ = Step::picture;
        SessionOptions options;
        if (make_observers_) options.observers = make_observers_(*setup);
        session_ = std::make_unique<Session>(std::move(run), std::move(options));
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
