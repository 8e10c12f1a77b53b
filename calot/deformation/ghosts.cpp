#include "calot/deformation/ghosts.h"

#include <algorithm>
#include <utility>

#include "calot/base/parallel.h"
#include "calot/deformation/carriers.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/links.h"

namespace calot::deformation {

namespace {

/// Up to so many ghosts are one task: fewer are not worth a second thread.
constexpr std::int64_t kOneTask = 1536;
/// Of more, each task has so many: some 2 us of work, so that two threads end together.
constexpr std::int64_t kTaskGhosts = 256;

std::int64_t task_of(std::int64_t count) {
    return count <= kOneTask ? kOneTask : kTaskGhosts;
}

/// The components of a vector, and a lane of zero.
template <class T>
Four load(const std::array<T*, 3>& field, std::int32_t i) {
    return Four{field[0][i], field[1][i], field[2][i], 0.0f};
}
void store(const Four& value, const std::array<float*, 3>& field, std::int32_t i) {
    field[0][i] = value[0];
    field[1][i] = value[1];
    field[2][i] = value[2];
}
Four unless_below(float least, const Four& x) {
    const Four size = x < 0.0f ? -x : x;
    return size < least ? Four{} : x;
}

template <class Fields>
auto pointers(Fields& fields) {
    return std::array{fields[0].data(), fields[1].data(), fields[2].data()};
}

/// Of n phyxels that a ghost mirrors each counts for so much.
constexpr std::array<float, 13> kShare = [] {
    std::array<float, 13> share{};
    for (int n = 1; n < 13; ++n) share[static_cast<std::size_t>(n)] = 1.0f / static_cast<float>(n);
    return share;
}();

}  // namespace

void list_ghosts(const tissue::Model& model, Work& work) {
    work.mirrors.clear();
    work.mirrors.reserve(static_cast<std::size_t>(model.phyxel_ghost.count()));
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (model.phyxel_ghost.test(p)) work.mirrors.push_back({static_cast<std::int32_t>(p), 0, {}});
    Images& images = work.images;
    images.stale = true;
    images.ghost.clear();
    for (const Mirror& mirror : work.mirrors) images.ghost.push_back(mirror.ghost);
    images.start.assign(work.mirrors.size() + 1, 0);
    images.slot.assign(static_cast<std::size_t>(model.phyxels.cells), -1);
    for (auto& face : work.face_m) face.assign(work.mirrors.size(), 0.0f);
}

const Mirror& find_mirror(const Work& work, std::int64_t ghost) {
    return *std::lower_bound(work.mirrors.begin(), work.mirrors.end(), ghost,
                             [](const Mirror& mirror, std::int64_t cell) { return mirror.ghost < cell; });
}

void refresh_mirror(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t ghost) {
    Mirror& mirror = const_cast<Mirror&>(find_mirror(work, ghost));
    mirror.count = 0;
    work.images.stale = true;
    for (const double wanted : {kFaceWeight, kEdgeWeight}) {
        if (mirror.count > 0) break;
        for_each_link(model.phyxels, state.links, ghost, [&](std::int64_t other, const Int3&, double weight) {
            if (weight == wanted && state.phyxel_present.test(other))
                mirror.phyxel[static_cast<std::size_t>(mirror.count++)] = static_cast<std::int32_t>(other);
        });
    }
}

void reserve_images(const tissue::Model& model, const tissue::State& state, Work& work) {
    // Links only ever go: a ghost has at most as many images as it has faces now, or edges when it has lost these.
    std::size_t most = 0;
    for (const Mirror& mirror : work.mirrors) {
        std::size_t faces = 0, edges = 0;
        for_each_link(model.phyxels, state.links, mirror.ghost, [&](std::int64_t other, const Int3&, double weight) {
            if (state.phyxel_present.test(other)) ++(weight == kFaceWeight ? faces : edges);
        });
        most += std::max(faces, edges);
    }
    Images& images = work.images;
    for (auto* list : {&images.mirrored, &images.phyxel, &images.first, &images.by}) list->reserve(most + 1);
    images.share.reserve(most);
    refresh_images(work);
}

void refresh_images(Work& work) {
    Images& images = work.images;
    if (!images.stale) return;
    images.stale = false;
    images.mirrored.clear();
    images.phyxel.clear();
    images.first.clear();
    // first[n + 1] counts the ghosts of phyxel n, then says where they begin, and is theirs' end when all are in.
    images.first.push_back(0);
    for (std::size_t n = 0; n < work.mirrors.size(); ++n) {
        const Mirror& mirror = work.mirrors[n];
        for (int k = 0; k < mirror.count; ++k) {
            const std::int32_t phyxel = mirror.phyxel[static_cast<std::size_t>(k)];
            std::int32_t& slot = images.slot[static_cast<std::size_t>(phyxel)];
            if (slot < 0) {
                slot = static_cast<std::int32_t>(images.phyxel.size());
                images.phyxel.push_back(phyxel);
                images.first.push_back(0);
            }
            ++images.first[static_cast<std::size_t>(slot) + 1];
            images.mirrored.push_back(phyxel);
        }
        images.start[n + 1] = static_cast<std::int32_t>(images.mirrored.size());
    }
    std::int32_t before = 0;
    for (std::size_t n = 1; n < images.first.size(); ++n) before += std::exchange(images.first[n], before);
    images.by.resize(images.mirrored.size());
    images.share.resize(images.mirrored.size());
    for (const Mirror& mirror : work.mirrors)
        for (int k = 0; k < mirror.count; ++k) {
            const auto slot = static_cast<std::size_t>(
                images.slot[static_cast<std::size_t>(mirror.phyxel[static_cast<std::size_t>(k)])]);
            const auto place = static_cast<std::size_t>(images.first[slot + 1]++);
            images.by[place] = mirror.ghost;
            images.share[place] = 1.0f / static_cast<float>(mirror.count);
        }
    for (const std::int32_t phyxel : images.phyxel) images.slot[static_cast<std::size_t>(phyxel)] = -1;
}

void move_ghosts(tissue::State& state, const Work& work) {
    const Images& images = work.images;
    const auto count = static_cast<std::int64_t>(images.ghost.size());
    parallel_for("deformation.ghosts", 0, count, task_of(count), [&](std::int64_t low, std::int64_t high) {
        const auto displacement = pointers(state.displacement_m), velocity = pointers(state.velocity_m_per_s);
        const auto faces = pointers(work.face_m);
        const std::int32_t *start = images.start.data(), *mirrored = images.mirrored.data(),
                           *ghosts = images.ghost.data();
        for (auto n = static_cast<std::int32_t>(low); n < high; ++n) {
            const std::int32_t begin = start[n], end = start[n + 1];
            Four face = load(faces, n), sum{};
            for (std::int32_t k = begin; k < end; ++k) sum += load(displacement, mirrored[k]);
            if (end > begin) face += face;
            store(face - sum * kShare[static_cast<std::size_t>(end - begin)], displacement, ghosts[n]);
            store(Four{}, velocity, ghosts[n]);
        }
    });
}

void return_ghost_impulses(tissue::State& state, const Work& work, float decay) {
    const Images& images = work.images;
    const auto count = static_cast<std::int64_t>(images.phyxel.size());
    parallel_for("deformation.impulses", 0, count, task_of(count), [&](std::int64_t low, std::int64_t high) {
        const auto displacement = pointers(state.displacement_m), velocity = pointers(state.velocity_m_per_s);
        const float *inverse_mass = work.inverse_mass_per_kg.data(), *share = images.share.data(), dt = work.substep_s;
        const std::int32_t *first = images.first.data(), *by = images.by.data(), *phyxels = images.phyxel.data();
        for (std::int64_t n = low; n < high; ++n) {
            Four impulse_Ns{};
            for (std::int32_t k = first[n]; k < first[n + 1]; ++k) impulse_Ns += share[k] * load(velocity, by[k]);
            const std::int32_t p = phyxels[n];
            const Four more = (-decay * inverse_mass[p]) * impulse_Ns;
            store(unless_below(kRest_m_per_s, load(velocity, p) + more), velocity, p);
            store(unless_below(kNowhere_m, load(displacement, p) + dt * more), displacement, p);
        }
    });
}

}  // namespace calot::deformation
