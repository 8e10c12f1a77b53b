#include "calot/simulation/backend.h"

namespace calot::simulation {

namespace {

class CpuBackend final : public Backend {
  public:
    std::string name() const override { return "CPU"; }
    bool keeps_host_current() const override { return true; }
    void begin(const tissue::Model&, tissue::State&, Work&) override {}
    void step(const tissue::Model& model, tissue::State& state, Work& work, const tissue::Input& input) override {
        simulation::step(model, state, work, input);
    }
    void fetch_state(const tissue::Model&, tissue::State&, Work&) override {}
    void fetch_surface(const tissue::Model&, const tissue::State&, Work&) override {}
    void embed_surface(const Work&, std::span<Vec3f>, std::span<Mat3f>) override {}
};

}  // namespace

std::unique_ptr<Backend> cpu_backend() {
    return std::make_unique<CpuBackend>();
}

}  // namespace calot::simulation
