#pragma once
// Pictures of a debrief: the run from two angles, maps of heat and injury on the anatomy.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "calot/render/renderer.h"
#include "calot/simulation/simulation.h"
#include "calot/viewer/picture.h"

namespace calot::app {

struct DebriefFrame {
    double time_s = 0.0;
    std::string front, side;  ///< JPEG files
};

struct DebriefMap {
    std::string title, caption;
    bool injury = false;  ///< else of peak temperature
    std::string picture;  ///< JPEG file
};

class DebriefPictures {
  public:
    /// Throws std::runtime_error when pictures cannot be drawn here.
    DebriefPictures(const simulation::Setup& setup, int width, int height);

    DebriefFrame frame(const simulation::Simulation& run, const tissue::Input& input);
    /// The field as the laparoscope sees it, and duct and artery alone as if all fat were gone.
    std::vector<DebriefMap> maps(const simulation::Simulation& run);

  private:
    std::string draw(const render::View& view, int quality);
    void fill_bare(const simulation::Simulation& run, render::View& view);

    render::OffscreenContext context_;
    render::Renderer renderer_;
    viewer::Picture picture_;
    render::View view_;
    render::Camera front_, side_;
};

}  // namespace calot::app
