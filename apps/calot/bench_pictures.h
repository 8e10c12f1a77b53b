#pragma once
// Pictures for the page of `calot bench`.

#include <memory>
#include <string>

#include "bench_results.h"
#include "calot/render/renderer.h"
#include "calot/simulation/simulation.h"

namespace calot::app {

/// Draws without a window. Where OpenGL is missing, take() gives nothing and trouble() says why.
class Camera {
  public:
    Camera(int width, int height);
    /// Draws what `view` holds, from closer; adds it to `pictures`.
    void take(render::View& view, const std::string& figure, const std::string& caption,
              std::vector<Picture64>& pictures);
    const std::string& trouble() const { return trouble_; }

  private:
    std::unique_ptr<render::OffscreenContext> context_;
    std::unique_ptr<render::Renderer> renderer_;
    std::string trouble_;
};

/// Tissue without physics: whatever the bare metal passes is gone at once, nothing moves, nothing gets hot.
class Eraser {
  public:
    explicit Eraser(std::shared_ptr<const simulation::Setup> setup);
    void pass(const tissue::Input& input);
    void fill(render::View& view);
    std::int64_t removed() const { return removed_; }

  private:
    std::shared_ptr<const simulation::Setup> setup_;
    tissue::State state_;
    surface::Surface surface_;
    std::vector<tissue::Capsule> capsules_;
    std::vector<render::OrganMesh> organs_;
    std::int64_t removed_ = 0;
    double time_s_ = 0.0;
};

}  // namespace calot::app
