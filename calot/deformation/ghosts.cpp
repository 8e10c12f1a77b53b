#include "calot/deformation/ghosts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calot/base/parallel.h"
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

float unless_below(float least, float x) {
    return std::fabs(x) < least ? 0.0f : x;
}

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
        float *x = state.displacement_m[0].data(), *y = state.displacement_m[1].data(),
              *z = state.displacement_m[2].data();
        for (auto n = static_cast<std::size_t>(low); n < static_cast<std::size_t>(high); ++n) {
            Vec3f face(work.face_m[0][n], work.face_m[1][n], work.face_m[2][n]), mean(0.0f);
            const auto begin = static_cast<std::size_t>(images.start[n]),
                       end = static_cast<std::size_t>(images.start[n + 1]);
            for (std::size_t k = begin; k < end; ++k) {
                const std::int32_t p = images.mirrored[k];
                mean += Vec3f(x[p], y[p], z[p]);
            }
            if (end > begin) face *= 2.0f;
            if (end > begin + 1) mean *= 1.0f / static_cast<float>(end - begin);
            const std::int32_t g = images.ghost[n];
            x[g] = face.x - mean.x;
            y[g] = face.y - mean.y;
            z[g] = face.z - mean.z;
            for (auto& velocity : state.velocity_m_per_s) velocity[static_cast<std::size_t>(g)] = 0.0f;
        }
    });
}

void return_ghost_impulses(tissue::State& state, const Work& work, float decay) {
    const Images& images = work.images;
    const auto count = static_cast<std::int64_t>(images.phyxel.size());
    parallel_for("deformation.impulses", 0, count, task_of(count), [&](std::int64_t low, std::int64_t high) {
        float *x = state.velocity_m_per_s[0].data(), *y = state.velocity_m_per_s[1].data(),
              *z = state.velocity_m_per_s[2].data();
        for (auto n = static_cast<std::size_t>(low); n < static_cast<std::size_t>(high); ++n) {
            Vec3f impulse_Ns(0.0f);
            for (auto k = static_cast<std::size_t>(images.first[n]); k < static_cast<std::size_t>(images.first[n + 1]);
                 ++k) {
                const std::int32_t g = images.by[k];
                impulse_Ns += images.share[k] * Vec3f(x[g], y[g], z[g]);
            }
            const auto p = static_cast<std::size_t>(images.phyxel[n]);
            const Vec3f more = -decay * work.inverse_mass_per_kg[p] * impulse_Ns;
            for (std::size_t r = 0; r < 3; ++r) {
                float &v = state.velocity_m_per_s[r][p], &u = state.displacement_m[r][p];
                v = unless_below(kRest_m_per_s, v + more[static_cast<int>(r)]);
                u = unless_below(kNowhere_m, u + work.substep_s * more[static_cast<int>(r)]);
            }
        }
    });
}

}  // namespace calot::deformation
