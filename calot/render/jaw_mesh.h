#pragma once
// A jaw of the grasper as it is drawn: half-round outside and slimmer towards the tip, flat and toothed inside.

#include "calot/render/instrument_mesh.h"

namespace calot::render {

/// Appends one. Its inner face lies where the capsule that touches tissue has its inmost line: `radius_m` from the
/// axis between hinge and tip, in the direction `inward`.
void add_jaw(const Vec3& hinge_m, const Vec3& tip_m, double radius_m, const Vec3& inward, InstrumentMesh& mesh);

}  // namespace calot::render
