#pragma once
// Who computes the ticks: the processor (step.h), or a device that keeps the large arrays to itself and hands them out
// when somebody asks. Setup::backend makes one; Simulation::tick asks it.

#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "calot/simulation/step.h"

namespace calot::simulation {

/// A device that is lost or has too little memory. Simulation catches it and goes on with the processor.
class BackendError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

class Backend {
  public:
    virtual ~Backend() = default;

    /// For people.
    virtual std::string name() const = 0;
    /// Whether State and Work are complete after every step, so that nothing below step() is ever asked for.
    virtual bool keeps_host_current() const = 0;

    /// Goes on from here: a state at a multiple of Model::frame_ticks.
    virtual void begin(const tissue::Model& model, tissue::State& state, Work& work) = 0;
    /// One tick. What of State is no array, presence of hexels, and of Work exchange, effects and times are current
    /// afterwards; the rest may lag until it is fetched.
    virtual void step(const tissue::Model& model, tissue::State& state, Work& work, const tissue::Input& input) = 0;
    /// Brings State and Work::thermal's temperatures up to date. What else Work holds of the rooms that compute is the
    /// processor's own.
    virtual void fetch_state(const tissue::Model& model, tissue::State& state, Work& work) = 0;
    /// Brings Work::surface up to date.
    virtual void fetch_surface(const tissue::Model& model, const tissue::State& state, Work& work) = 0;
    /// World positions and deformation gradients of the vertices of Work::surface.smooth_mesh(), which is up to date.
    virtual void embed_surface(const Work& work, std::span<Vec3f> world_m, std::span<Mat3f> deformation_gradient) = 0;
};

/// simulation::step.
std::unique_ptr<Backend> cpu_backend();

}  // namespace calot::simulation
