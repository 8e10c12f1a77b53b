#include "calot/validation/trial.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "calot/base/units.h"
#include "calot/scene/scene.h"
#include "calot/validation/spoil.h"

namespace calot::validation {

namespace {

/// Horizontal distance [m] from the axes of the bare metal.
double distance_across_m(const std::vector<tissue::Capsule>& capsules, const Vec3& at) {
    double nearest = 1e9;
    for (const tissue::Capsule& c : capsules) {
        if (!c.bare) continue;
        const glm::dvec2 a(c.a_m), ab = glm::dvec2(c.b_m) - a, ap = glm::dvec2(at) - a;
        const double length2 = glm::dot(ab, ab);
        const double t = length2 > 0.0 ? std::clamp(glm::dot(ap, ab) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(ap - t * ab) - c.radius_m);
    }
    return nearest;
}

/// The topmost present hexel of every column.
template <class Visit>
void for_each_top(const tissue::Model& model, const tissue::State& state, const Visit& visit) {
    const Int3 size = model.hexels.size;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            for (int z = size.z - 1; z >= 0; --z) {
                const std::int64_t h = model.hexels.index(x, y, z);
                if (!state.hexel_present.test(h)) continue;
                visit(h);
                break;
            }
}

/// Least distance [m] of every column's middle to the metal, horizontally, while the pedal was down.
class Path {
  public:
    explicit Path(const tissue::Model& model)
        : size_(model.hexels.size), nearest_(static_cast<std::size_t>(size_.x * size_.y), 1e9) {}
    void look(const simulation::Simulation& run) {
        for (int y = 0; y < size_.y; ++y)
            for (int x = 0; x < size_.x; ++x) {
                double& nearest = at(x, y);
                nearest =
                    std::min(nearest, distance_across_m(run.capsules(), run.model().hexels.centre_m(Int3(x, y, 0))));
            }
    }
    double& at(int x, int y) { return nearest_[static_cast<std::size_t>(x + size_.x * y)]; }

  private:
    Int3 size_;
    std::vector<double> nearest_;
};

/// What was burnt and what was hurt; columns that the metal came over do not count as hurt beside it.
void measure(const simulation::Simulation& run, Path& path, Trial& trial) {
    const tissue::Model& model = run.model();
    const tissue::State& state = run.state();
    const double cell_mm3 = model.hexel_volume_m3() * 1e9, s = model.hexels.spacing_m;
    double top_m = -1e9;
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
        if (model.hexel_initial.test(h)) top_m = std::max(top_m, model.hexels.centre_m(h).z);
    std::vector<double> section_m(static_cast<std::size_t>(model.hexels.size.x), 0.0);
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h) {
        if (!model.hexel_initial.test(h)) continue;
        const Int3 c = model.hexels.coordinates(h);
        if (!state.hexel_present.test(h)) {
            trial.removed_mm3 += cell_mm3;
            trial.depth_mm = std::max(trial.depth_mm, (top_m - model.hexels.centre_m(h).z + s) * 1e3);
        } else if (state.damage[static_cast<std::size_t>(h)] >= 1.0f) {
            trial.damaged_mm3 += cell_mm3;
            // Hexels count with their far side.
            const double reach_m = path.at(c.x, c.y) + 0.5 * s;
            trial.damage_mm = std::max(trial.damage_mm, reach_m * 1e3);
            section_m[static_cast<std::size_t>(c.x)] = std::max(section_m[static_cast<std::size_t>(c.x)], reach_m);
        }
    }
    double sections = 0.0;
    for (int x = 0; x < model.hexels.size.x; ++x) {
        double nearest = 1.0;
        for (int y = 0; y < model.hexels.size.y; ++y) nearest = std::min(nearest, path.at(x, y));
        if (nearest > 0.0) continue;
        trial.section_damage_mm += section_m[static_cast<std::size_t>(x)] * 1e3;
        sections += 1.0;
    }
    trial.section_damage_mm /= std::max(sections, 1.0);
}

/// A hand that lets the instrument rest on tissue.
class RestingHand {
  public:
    explicit RestingHand(double force_N) : force_N_(force_N) {}
    void move(const simulation::Simulation& run, tissue::Input& input) {
        constexpr double kCompliance_m_per_Ns = 0.02, kFastest_m_per_s = 0.02;
        if (force_N_ > 0.0 && input.pedal) {
            const double missing_N = force_N_ - run.state().hook_force_N.z;
            lowered_m_ +=
                run.model().tick_s * std::clamp(kCompliance_m_per_Ns * missing_N, -kFastest_m_per_s, kFastest_m_per_s);
        }
        input.hook.position_m.z -= lowered_m_;
    }

  private:
    double force_N_;
    double lowered_m_ = 0.0;
};

}  // namespace

Points surface_temperature_C(const simulation::Simulation& run, bool peak) {
    Points points;
    for_each_top(run.model(), run.state(), [&](std::int64_t h) {
        const double distance = distance_across_m(run.capsules(), run.model().hexels.centre_m(h));
        const float K = peak ? run.state().peak_temperature_K[static_cast<std::size_t>(h)]
                             : tissue::temperature_K(run.model(), run.state(), h);
        points.emplace_back(distance * 1e3, celsius_from_kelvin(static_cast<double>(K)));
    });
    std::sort(points.begin(), points.end());
    return points;
}

double mean_at(const Points& points, double x) {
    double sum = 0.0;
    int count = 0;
    for (const auto& [at, value] : points)
        if (std::abs(at - x) < 0.4) sum += value, ++count;
    return count > 0 ? sum / count : NAN;
}

double Trial::spread_mm(double celsius) const {
    double far = 0.0;
    for (const auto& [at, value] : surface)
        if (value >= celsius) far = std::max(far, at);
    return far;
}

Trial perform(const Options& options, const TrialPlan& plan) {
    scene::Scene scene = scene::load(options.scenes + "/" + plan.scene);
    for (const std::string& assignment : plan.assignments) scene::override_value(scene, assignment);
    auto setup = std::make_shared<simulation::Setup>(scene::build(scene));
    setup->model = spoiled(options, std::move(setup->model));
    simulation::Simulation run(setup);
    Trial trial;
    trial.scene = plan.scene;
    Path path(run.model());
    RestingHand hand(plan.rests_with_N);
    const double until = plan.until_s > 0.0 ? plan.until_s : setup->duration_s;
    const auto ticks = static_cast<std::int64_t>(std::llround(until / run.model().tick_s));
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        tissue::Input input = setup->script.at(run.time_s());
        hand.move(run, input);
        if (!run.tick(input)) {
            trial.stopped = true;
            break;
        }
        if (plan.watch) plan.watch(run);
        const double ohm = run.state().generator.impedance_Ohm;
        if (input.pedal && tick % 20 == 0) path.look(run);
        if (ohm > 0.0) {
            if (trial.first_Ohm == 0.0) trial.first_Ohm = trial.least_Ohm = ohm;
            trial.least_Ohm = std::min(trial.least_Ohm, ohm);
            trial.last_Ohm = ohm;
            trial.rise_of_impedance = std::max(trial.rise_of_impedance, ohm / trial.least_Ohm);
            if (tick % 8 == 0) trial.impedance.emplace_back(run.time_s(), ohm);
        }
        if (options.progress && tick % 100 == 0)
            options.progress(static_cast<double>(tick) / static_cast<double>(ticks));
    }
    measure(run, path, trial);
    trial.surface = surface_temperature_C(run, false);
    trial.peak = surface_temperature_C(run, true);
    trial.imbalance = std::abs(run.energy_imbalance());
    trial.delivered_J = run.state().energy_J.delivered;
    return trial;
}

}  // namespace calot::validation
