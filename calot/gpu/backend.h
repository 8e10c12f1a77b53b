#pragma once
// Whole ticks on a device: gpu::Deformation, Field, Heat and Surface in the order of simulation/step.cpp.
//
// The large arrays stay on the device (gpu::Arrays). In every tick cross the bus: near hexels, contact points, what the
// wire touches and where current enters; sums, what has gone. On the host stay what is small or seldom: instruments,
// contacts' list, generator, energy budget, presence bits and links, smoke and blood.

#include "calot/gpu/arrays.h"
#include "calot/gpu/deformation.h"
#include "calot/gpu/field.h"
#include "calot/gpu/heat.h"
#include "calot/gpu/surface.h"
#include "calot/simulation/backend.h"
#include "calot/simulation/setup.h"

namespace calot::gpu {

/// Memory that a scene takes on a device, about; rather too much.
std::uint64_t device_bytes(const tissue::Model& model);

class Backend final : public simulation::Backend {
  public:
    /// `setup` outlives it. Throws simulation::BackendError when the device cannot be opened, or has too little memory.
    Backend(const DeviceInfo& info, const simulation::Setup& setup);

    std::string name() const override;
    bool keeps_host_current() const override { return false; }
    void begin(const tissue::Model& model, tissue::State& state, simulation::Work& work) override;
    void step(const tissue::Model& model, tissue::State& state, simulation::Work& work,
              const tissue::Input& input) override;
    void fetch_state(const tissue::Model& model, tissue::State& state, simulation::Work& work) override;
    void fetch_surface(const tissue::Model& model, const tissue::State& state, simulation::Work& work) override;
    void embed_surface(const simulation::Work& work, std::span<Vec3f> world_m,
                       std::span<Mat3f> deformation_gradient) override;

    Device& device() const { return *device_; }

  private:
    struct Rooms {
        Arrays arrays;
        Deformation deformation;
        Field field;
        Heat heat;
        Surface surface;
        Rooms(const std::shared_ptr<Device>& device, const tissue::Model& model);
    };
    /// Vertices that are drawn.
    struct Vertices {
        std::uint64_t version = ~std::uint64_t{0};  ///< of the surface
        DeviceArray<float> rest_m, world_m, gradient;
        DeviceArray<std::int32_t> owner, count;
    };
    void fetch_about_breaches(const tissue::Model& model, tissue::State& state, const effects::Bleeding& bleeding);

    std::shared_ptr<Device> device_;
    std::unique_ptr<Rooms> rooms_;
    Vertices vertices_;
    bool surface_is_current_ = false;  ///< simulation::Work::surface
};

}  // namespace calot::gpu
