#include "calot/training/structures.h"

#include <algorithm>
#include <cmath>

namespace calot::training {

namespace {

constexpr double kClearance_m = 1.5e-3;
constexpr double kFacing = 0.5;  ///< cosine: within 60 degrees of the lens

/// Away from the structure: minus the mean direction of its hexels within 2.5 cells. 0 in the middle.
Vec3 outward_of(const tissue::Model& model, const Int3& cell, tissue::MaterialIndex material) {
    Vec3 sum(0.0);
    for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) {
                const Int3 d(x, y, z), there = cell + d;
                if (x * x + y * y + z * z > 6 || !model.hexels.contains(there)) continue;
                if (model.hexel_material[static_cast<std::size_t>(model.hexels.index(there))] == material)
                    sum -= Vec3(d);
            }
    const double length = glm::length(sum);
    return length > 1e-9 ? sum / length : Vec3(0.0);
}

bool on_surface(const tissue::Model& model, std::int64_t hexel, tissue::MaterialIndex material) {
    for (int axis = 0; axis < 3; ++axis)
        for (int sign : {-1, 1})
            if (model.hexel_material[static_cast<std::size_t>(hexel + sign * model.hexels.stride[axis])] != material)
                return true;
    return false;
}

}  // namespace

Structure::Structure(const tissue::Model& model, tissue::MaterialIndex material, const Vec3& eye_m)
    : material_(material) {
    if (material == tissue::kNoMaterial) return;
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
        if (model.hexel_initial.test(h) && model.hexel_material[static_cast<std::size_t>(h)] == material)
            hexels_.push_back(h);
    probe_of_.assign(hexels_.size(), -1);
    for (std::size_t k = 0; k < hexels_.size(); ++k) {
        if (!on_surface(model, hexels_[k], material)) continue;
        const std::size_t before = probes_.size();
        add_probe(model, hexels_[k], eye_m);
        if (probes_.size() > before) probe_of_[k] = static_cast<std::int32_t>(before);
    }
    for (const Probe& probe : probes_) front_probes_ += probe.front;
}

void Structure::add_probe(const tissue::Model& model, std::int64_t hexel, const Vec3& eye_m) {
    const Lattice& lattice = model.hexels;
    const Int3 cell = lattice.coordinates(hexel);
    const Vec3 outward = outward_of(model, cell, material_);
    if (outward == Vec3(0.0)) return;
    Probe probe;
    probe.hexel = hexel;
    probe.first = static_cast<std::int32_t>(cells_.size());
    const int steps = std::max(1, static_cast<int>(kClearance_m / lattice.spacing_m + 1e-9));
    std::int64_t last = hexel;
    for (int k = 1; k <= steps; ++k) {
        const Int3 there(glm::floor(Vec3(cell) + static_cast<double>(k) * outward + 0.5));
        if (!lattice.contains(there)) break;  // beyond the field: gas
        const std::int64_t index = lattice.index(there);
        if (model.hexel_held.test(index)) {
            cells_.resize(static_cast<std::size_t>(probe.first));
            return;  // covered by an organ
        }
        if (index == last || model.hexel_material[static_cast<std::size_t>(index)] == material_) continue;
        cells_.push_back(index);
        last = index;
    }
    probe.count = static_cast<std::int32_t>(cells_.size()) - probe.first;
    probe.front = glm::dot(outward, glm::normalize(eye_m - lattice.centre_m(cell))) > kFacing;
    probes_.push_back(probe);
}

bool Structure::free(const tissue::State& state, const Probe& probe) const {
    if (!state.hexel_present.test(probe.hexel)) return false;
    for (std::int32_t k = 0; k < probe.count; ++k)
        if (state.hexel_present.test(cells_[static_cast<std::size_t>(probe.first + k)])) return false;
    return true;
}

StructureState Structure::look(const tissue::State& state) const {
    StructureState now;
    std::int64_t free_front = 0, free_all = 0;
    for (std::size_t k = 0; k < hexels_.size(); ++k) {
        const auto cell = static_cast<std::size_t>(hexels_[k]);
        const bool present = state.hexel_present.test(hexels_[k]);
        const bool injured = !present || state.damage[cell] >= 1.0f;
        now.peak_K = std::max(now.peak_K, static_cast<double>(state.peak_temperature_K[cell]));
        now.burnt += !present;
        now.injured += injured;
        bool exposed = false;
        if (probe_of_[k] >= 0) {
            const Probe& probe = probes_[static_cast<std::size_t>(probe_of_[k])];
            exposed = free(state, probe);
            free_all += exposed;
            free_front += exposed && probe.front;
        }
        now.hidden += injured && present && !exposed;
    }
    if (!probes_.empty()) now.freed = static_cast<double>(free_all) / static_cast<double>(probes_.size());
    if (front_probes_ > 0) now.exposed = static_cast<double>(free_front) / static_cast<double>(front_probes_);
    return now;
}

std::vector<std::int64_t> hexels_at_organ(const tissue::Model& model, const std::string& organ) {
    std::vector<std::int64_t> found;
    for (const tissue::RigidOrgan& candidate : model.organs) {
        if (candidate.name != organ) continue;
        for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h) {
            if (!model.hexel_initial.test(h)) continue;
            bool touches = false;
            for (int axis = 0; axis < 3 && !touches; ++axis)
                for (int sign : {-1, 1}) {
                    const std::int64_t there = h + sign * model.hexels.stride[axis];
                    touches = touches || (model.hexel_held.test(there) &&
                                          candidate.shape->distance_m(model.hexels.centre_m(there)) <= 0.0);
                }
            if (touches) found.push_back(h);
        }
    }
    return found;
}

BitArray fat_between(const tissue::Model& model, const Structure& duct, const Structure& artery,
                     tissue::MaterialIndex fat, std::int64_t& count) {
    BitArray between(model.hexels.cells);
    count = 0;
    // Middle of each structure in y, for every x of the lattice.
    auto middles = [&](const Structure& structure) {
        std::vector<double> sum(static_cast<std::size_t>(model.hexels.size.x)), n(sum.size());
        for (std::int64_t hexel : structure.hexels()) {
            const Int3 cell = model.hexels.coordinates(hexel);
            sum[static_cast<std::size_t>(cell.x)] += cell.y;
            n[static_cast<std::size_t>(cell.x)] += 1.0;
        }
        for (std::size_t x = 0; x < sum.size(); ++x) sum[x] = n[x] > 0.0 ? sum[x] / n[x] : std::nan("");
        return sum;
    };
    const std::vector<double> a = middles(duct), b = middles(artery);
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h) {
        if (!model.hexel_initial.test(h) || model.hexel_material[static_cast<std::size_t>(h)] != fat) continue;
        const Int3 cell = model.hexels.coordinates(h);
        const auto x = static_cast<std::size_t>(cell.x);
        if (std::isnan(a[x]) || std::isnan(b[x])) continue;
        if (cell.y <= std::min(a[x], b[x]) || cell.y >= std::max(a[x], b[x])) continue;
        between.set(h);
        ++count;
    }
    return between;
}

}  // namespace calot::training
