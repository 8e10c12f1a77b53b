#pragma once
// Everything that a run starts from. scene::build makes one from a scene file; a program may as well fill it by hand.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "calot/anatomy/anatomy.h"
#include "calot/effects/smoke.h"
#include "calot/instruments/grasper.h"
#include "calot/instruments/hook.h"
#include "calot/simulation/script.h"
#include "calot/tissue/model.h"

namespace calot::simulation {

class Backend;

/// Where the laparoscope looks from.
struct CameraSetup {
    Vec3 eye_m{0.0, -0.03, 0.08};
    Vec3 target_m{0.0};
    double field_of_view_deg = 60.0;
};

struct Setup {
    std::string name;        ///< of the scene, for people
    std::string scene_text;  ///< canonical, self-contained scene: builds this very Setup again
    std::uint64_t seed = 1;  ///< of the patient
    double duration_s = 10.0;
    anatomy::Anatomy anatomy;
    tissue::Model model;
    instruments::HookShape hook;
    instruments::GrasperShape grasper;
    Vec3 grasper_trocar_m{0.0};  ///< where the left hand would enter, also when the script has no grasper
    effects::SmokeParameters smoke;
    CameraSetup camera;
    Script script;
    /// Makes who computes the ticks of a Simulation (backend.h); empty: the processor does. May throw BackendError.
    std::function<std::unique_ptr<Backend>(const Setup&)> backend;
    /// Told at once when a backend fails (Simulation::notices() keeps it); may be empty.
    std::function<void(const std::string&)> tell;
};

}  // namespace calot::simulation
