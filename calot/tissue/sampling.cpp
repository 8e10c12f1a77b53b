#include "calot/tissue/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calot/base/error.h"
#include "calot/base/parallel.h"

namespace calot::tissue {

namespace {

/// Cells on a shared face of tissue and organ (to rounding) count as held: air between them would let the tissue go.
constexpr double kOnSurface_m = 1e-9;

/// Lattices whose cells cover the bounds of all tissues inside the field.
Box sampled_box(const anatomy::Anatomy& anatomy) {
    Box box{Vec3(1e9), Vec3(-1e9)};
    for (const auto& tissue : anatomy.tissues) {
        const Box bounds = tissue.shape->bounds_m();
        box.low = glm::min(box.low, glm::max(bounds.low, anatomy.field.low));
        box.high = glm::max(box.high, glm::min(bounds.high, anatomy.field.high));
    }
    return box;
}

constexpr int kBlock = 4;             ///< hexels along the edge of the blocks that sampling skips
constexpr MaterialIndex kHeld = 255;  ///< mark of empty cells inside an organ that holds

/// Marks hexels block by block. A shape whose surface is farther from a block's centre than any of its hexels is not
/// asked again for each of them: most blocks cost one query a shape.
class BlockMarker {
  public:
    BlockMarker(const anatomy::Anatomy& anatomy, const std::vector<MaterialIndex>& material_of, const Model& model)
        : field_(anatomy.field), hexels_(model.hexels) {
        // In order of precedence: the last tissue wins, tissues before organs.
        for (std::size_t k = anatomy.tissues.size(); k-- > 0;)
            all_.push_back({anatomy.tissues[k].shape.get(), material_of[k]});
        for (const auto& organ : model.organs)
            if (organ.holds_tissue) all_.push_back({organ.shape.get(), kHeld});
        undecided_.reserve(all_.size());
    }

    void mark_block(const Int3& low, Array<MaterialIndex>& mark) {
        const Int3 high = glm::min(low + kBlock, hexels_.size);
        const Vec3 half = 0.5 * hexels_.spacing_m * Vec3(high - 1 - low);
        const Vec3 centre = hexels_.centre_m(low) + half;
        const double clear = anatomy::kDistanceSlack * glm::length(half) + kOnSurface_m;
        undecided_.clear();
        for (const Candidate& candidate : all_) {
            const double distance = candidate.shape->distance_m(centre);
            if (distance > clear) continue;
            undecided_.push_back({distance < -clear ? nullptr : candidate.shape, candidate.mark});
            if (distance < -clear && (candidate.mark == kHeld || field_holds(centre - half, centre + half))) break;
        }
        if (undecided_.empty()) return;
        for (int z = low.z; z < high.z; ++z)
            for (int y = low.y; y < high.y; ++y)
                for (int x = low.x; x < high.x; ++x)
                    mark[static_cast<std::size_t>(hexels_.index(x, y, z))] = mark_at(hexels_.centre_m(Int3(x, y, z)));
    }

  private:
    struct Candidate {
        const anatomy::Shape* shape;  ///< null: holds the whole block
        MaterialIndex mark;
    };

    bool field_holds(const Vec3& low, const Vec3& high) const {
        return glm::all(glm::greaterThanEqual(low, field_.low)) && glm::all(glm::lessThanEqual(high, field_.high));
    }
    MaterialIndex mark_at(const Vec3& p) const {
        const bool in_field = field_holds(p, p);
        for (const Candidate& c : undecided_)
            if ((in_field || c.mark == kHeld) &&
                (c.shape == nullptr || c.shape->distance_m(p) < (c.mark == kHeld ? kOnSurface_m : 0.0)))
                return c.mark;
        return kNoMaterial;
    }

    Box field_;
    const Lattice& hexels_;
    std::vector<Candidate> all_, undecided_;
};

/// Axes of the phyxel lattice, fastest first. The field is a sheet, and its kernels take runs of 16 phyxels: rows along
/// the longest side have the longest runs (370 groups of 16 in the standard scene instead of 584 along the shortest),
/// and the shortest side next keeps planes small.
std::array<int, 3> long_rows(const Int3& size) {
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return size[a] > size[b]; });
    return {axes[0], axes[2], axes[1]};
}

/// Whether any hexel of a phyxel's cell is marked as tissue.
bool holds_tissue(const Model& model, const Int3& phyxel) {
    const int m = model.hexels_per_edge;
    for (int z = 0; z < m; ++z)
        for (int y = 0; y < m; ++y)
            for (int x = 0; x < m; ++x) {
                const std::int64_t hexel = model.hexels.index(m * phyxel + Int3(x, y, z));
                const MaterialIndex mark = model.hexel_material[static_cast<std::size_t>(hexel)];
                if (mark != kNoMaterial && mark != kHeld) return true;
            }
    return false;
}

/// Cells that the kernels take at once: vectors begin at multiples of it.
constexpr int kVector = 16;

/// The same lattice with rows that begin alike within vectors, so that the filled cells touch the fewest of these; as it
/// was where that would take over a fifth more than vectors that begin at the first filled cell, wherever it is.
Lattice align_rows(const Lattice& loose, const std::array<int, 3>& axes, const std::vector<Int3>& filled) {
    auto vectors = [&](const Lattice& lattice, bool aligned) {
        std::vector<std::int64_t> cells;
        for (const Int3& c : filled) cells.push_back(lattice.index(c));
        std::sort(cells.begin(), cells.end());
        int count = 0;
        std::int64_t end = 0;
        for (const std::int64_t cell : cells) {
            if (cell < end) continue;
            ++count;
            end = (aligned ? cell / kVector * kVector : cell) + kVector;
        }
        return count;
    };
    Lattice best = loose;
    int fewest = vectors(loose, false) + vectors(loose, false) / 5;
    for (int shift = 0; shift < kVector; ++shift) {
        const Lattice lattice = Lattice::make(loose.origin_m, loose.spacing_m, loose.size, axes, {kVector, shift});
        const int count = vectors(lattice, true);
        if (count > fewest || (count == fewest && best.stride != loose.stride)) continue;
        fewest = count;
        best = lattice;
    }
    return best;
}

/// Wave speed of longitudinal waves [m/s], squared: (lambda + 2 mu) / rho.
double wave_speed_squared(double mu, double lambda, double density) {
    return (lambda + 2.0 * mu) / density;
}

}  // namespace

Model sample(const anatomy::Anatomy& anatomy, const SamplingParameters& parameters, std::vector<Material> materials) {
    const int m = parameters.hexels_per_edge;
    if (m != 1 && m != 2 && m != 4)
        throw InputError("hexels_per_edge is " + std::to_string(m),
                         "use 1, 2 or 4 hexels along the edge of a phyxel's cell");
    std::vector<MaterialIndex> material_of;
    for (const auto& tissue : anatomy.tissues) {
        material_of.push_back(find_material(materials, tissue.material));
        if (material_of.back() == kNoMaterial)
            throw InputError("tissue '" + tissue.name + "' has the unknown material '" + tissue.material + "'");
    }

    Model model;
    model.materials = std::move(materials);
    model.hexels_per_edge = m;
    for (const auto& organ : anatomy.organs) {
        model.organs.push_back(
            {organ.name, find_material(model.materials, organ.material), organ.holds_tissue, organ.shape});
    }

    const double hexel = parameters.hexel_spacing_m;
    const double spacing = m * hexel;
    const Box box = sampled_box(anatomy);
    if (!(box.low.x < box.high.x && box.low.y < box.high.y && box.low.z < box.high.z))
        throw InputError("no tissue lies inside the operating field");
    // One ring of empty phyxel cells on each side for ghosts.
    const Int3 cells = Int3(glm::ceil((box.high - box.low) / spacing - 1e-9)) + 2;
    const Vec3 corner = 0.5 * (box.low + box.high) - 0.5 * spacing * Vec3(cells);
    model.phyxels = Lattice::make(corner + Vec3(0.5 * spacing), spacing, cells, long_rows(cells), {});
    model.hexels = Lattice::make(corner + Vec3(0.5 * hexel), hexel, cells * m);

    model.hexel_material.assign(static_cast<std::size_t>(model.hexels.cells), kNoMaterial);
    model.hexel_initial = BitArray(model.hexels.cells);
    model.hexel_held = BitArray(model.hexels.cells);

    // Hexels: bytes first (bits of neighbouring rows share words, so they are set afterwards, by one thread).
    Array<MaterialIndex>& mark = model.hexel_material;
    const Int3 size = model.hexels.size;
    const Int3 blocks = (size + kBlock - 1) / kBlock;
    parallel_for("tissue.sample", 0, blocks.z, 1, [&](std::int64_t z_low, std::int64_t z_high) {
        BlockMarker marker(anatomy, material_of, model);
        for (int z = static_cast<int>(z_low); z < z_high; ++z)
            for (int y = 0; y < blocks.y; ++y)
                for (int x = 0; x < blocks.x; ++x) marker.mark_block(kBlock * Int3(x, y, z), mark);
    });
    std::vector<Int3> filled;
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
                if (holds_tissue(model, Int3(x, y, z))) filled.emplace_back(x, y, z);
    model.phyxels = align_rows(model.phyxels, long_rows(cells), filled);
    model.phyxel_initial = BitArray(model.phyxels.cells);
    model.phyxel_ghost = BitArray(model.phyxels.cells);

    std::vector<int> held_in_phyxel(static_cast<std::size_t>(model.phyxels.cells), 0);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const std::int64_t cell = model.hexels.index(x, y, z);
                const std::int64_t phyxel = model.phyxel_of({x, y, z});
                MaterialIndex& found = mark[static_cast<std::size_t>(cell)];
                if (found == kHeld) {
                    model.hexel_held.set(cell);
                    ++held_in_phyxel[static_cast<std::size_t>(phyxel)];
                    found = kNoMaterial;
                } else if (found != kNoMaterial) {
                    model.hexel_initial.set(cell);
                    model.phyxel_initial.set(phyxel);
                }
            }
    if (model.hexel_initial.count() == 0)
        throw InputError("no hexel lies inside any tissue",
                         "the tissue is thinner than the hexel spacing, or outside the field");

    // Ghosts: empty cells mostly inside a holding organ, next to tissue.
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        if (model.phyxel_initial.test(p) || 2 * held_in_phyxel[static_cast<std::size_t>(p)] < model.hexels_per_phyxel())
            continue;
        bool beside_tissue = false;
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    if (std::abs(dx) + std::abs(dy) + std::abs(dz) <= 2)
                        beside_tissue |= model.phyxel_initial.test(p + model.phyxels.offset({dx, dy, dz}));
        if (beside_tissue) model.phyxel_ghost.set(p);
    }
    prepare_time_step(model);
    return model;
}

void prepare_time_step(Model& model) {
    DeformationParameters& d = model.deformation;
    if (d.substeps != 0) return;
    std::vector<bool> seen(model.materials.size(), false);
    for (const MaterialIndex index : model.hexel_material)
        if (index != kNoMaterial) seen[index] = true;
    double softest = 1e300;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        if (!seen[k]) continue;
        const Material& material = model.materials[k];
        const double mu = material.youngs_modulus_Pa / (2.0 * (1.0 + material.poisson_ratio));
        const double lambda = 2.0 * mu * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio);
        softest = std::min(softest, wave_speed_squared(mu, lambda, material.density_kg_per_m3));
    }
    const double longest = d.time_step_safety * model.phyxels.spacing_m / std::sqrt(softest);
    d.substeps = std::max(1, static_cast<int>(std::ceil(model.tick_s / longest - 1e-9)));
}

}  // namespace calot::tissue
