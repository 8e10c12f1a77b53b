#pragma once
// Blood from arteries that were breached: drops that spurt and fall, a film that runs down, what washes and draws it
// off (docs/physics.md section 9). Seen, not felt: it changes no temperature and no force. Deterministic: a function of
// State, the removed hexels and the inputs, tick by tick.

#include <cstdint>
#include <vector>

#include "calot/base/archive.h"
#include "calot/base/array.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::effects {

struct BloodDrop {
    Vec3f position_m{0.0f};
    Vec3f velocity_m_per_s{0.0f};
    float radius_m = 0.0f;
    float age_s = 0.0f;
    bool water = false;  ///< of the irrigation
};

/// A hole in an artery.
struct Breach {
    std::int64_t hexel = 0;   ///< the wall's, gone
    Vec3f place_m{0.0f};      ///< at rest
    float opening = 0.0f;     ///< 0 sealed ... 1 cut through
    double waiting_m3 = 0.0;  ///< not yet enough for a drop
};

class Bleeding {
  public:
    explicit Bleeding(const tissue::Model& model);

    /// After heat and removal.
    void step(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
              const tissue::Input& input);

    const std::vector<BloodDrop>& drops() const { return drops_; }
    /// Thickness of the film on surface hexels [m], [hexels.cells]; empty where the scene has no artery.
    const Array<float>& film_m() const { return film_m_; }
    /// Holes, closed ones too: step() looks at the temperatures within kSealReach hexels of them.
    const std::vector<Breach>& breaches() const { return breaches_; }
    double flow_m3_per_s() const { return flow_m3_per_s_; }  ///< of all breaches now
    double lost_m3() const { return lost_m3_; }              ///< since the start

    /// All of it, for a checkpoint; read into a Bleeding of the same model. Throws std::runtime_error when it does not
    /// fit.
    void archive(Archive& archive);

    static constexpr int kSealReach = 2;
    static constexpr std::size_t kMostDrops = 768;
    static constexpr std::size_t kMostWet = 12000;  ///< hexels with a film
    static constexpr std::size_t kMostBreaches = 32;

  private:
    void open(const tissue::Model& model, std::int64_t hexel);
    void seal(const tissue::Model& model, const tissue::State& state);
    void spurt(const tissue::Model& model, std::int64_t tick);
    void irrigate(const tissue::Pose& hook, std::int64_t tick);
    void move_drops(const tissue::Model& model, const tissue::State& state);
    void run_down(const tissue::Model& model, const tissue::State& state, std::int64_t tick);
    void clean(const tissue::Model& model, const tissue::Input& input);
    void wet(std::int64_t hexel, float thickness_m);
    void emit(const BloodDrop& drop);

    std::vector<bool> artery_;          ///< by material
    Vec3f down_{0.0f, -0.34f, -0.94f};  ///< on the back, feet lower than the head, as the operation is done
    std::vector<Breach> breaches_;
    std::vector<BloodDrop> drops_;
    Array<float> film_m_;
    std::vector<std::int32_t> wet_;  ///< hexels with a film
    double flow_m3_per_s_ = 0.0, lost_m3_ = 0.0;
    std::uint64_t emitted_ = 0;
};

/// Arterial pressure over a beat, 0 to about 1: quick rise, slow fall, dicrotic wave.
float pulse_at(double time_s);

}  // namespace calot::effects
