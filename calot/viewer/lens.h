#pragma once
// What gathers on the front lens: fog where warm steam meets it, smears where tissue spatters close by. Seen only.

#include "calot/base/vec.h"
#include "calot/render/view.h"
#include "calot/viewer/snapshot.h"

namespace calot::viewer {

class LensState {
  public:
    /// `eye_m`: where the lens is.
    void advance(const Figures& figures, const Vec3& eye_m, double dt_s);
    void wipe();
    render::Lens look() const;

  private:
    double fog_ = 0.0, smear_ = 0.0;
    double wiping_ = 0.0;  ///< what is left of a wipe
    int wiped_ = 0;        ///< times: a new pattern each
};

}  // namespace calot::viewer
