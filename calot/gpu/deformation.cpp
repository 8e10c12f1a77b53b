#include "calot/gpu/deformation.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <numeric>

#include "calot/deformation/embedding.h"
#include "calot/deformation/grasp.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/neighbours.h"
#include "calot/deformation/rest.h"

namespace calot::gpu {

using deformation::kNeighbourhood;
using tissue::Exchange;
using tissue::Model;
using tissue::State;

namespace {

constexpr int kGroup = 64;          // of the sweeps
constexpr int kContactGroup = 256;  // CONTACT_GROUP of kernels/contact.cl
constexpr std::int64_t kContactLanes = 16;
/// Torn phyxels that are read together with the rest of the report.
constexpr std::int64_t kMostReported = 62;

/// Coordinates of the centres of cells along x, then y, then z, rounded once: as Vec3f(lattice.centre_m(c)) has them.
DeviceArray<float> centres_of(Device& device, const Lattice& lattice) {
    std::vector<float> centres;
    for (int axis = 0; axis < 3; ++axis)
        for (int c = 0; c < lattice.size[axis]; ++c)
            centres.push_back(static_cast<float>(lattice.centre_m(Int3(c))[axis]));
    DeviceArray<float> array(device, static_cast<std::int64_t>(centres.size()));
    array.upload(device, std::span<const float>(centres));
    return array;
}

DeviceArray<std::int32_t> list_on(Device& device, const std::vector<std::int32_t>& list) {
    DeviceArray<std::int32_t> array(device, static_cast<std::int64_t>(list.size()));
    array.upload(device, std::span<const std::int32_t>(list));
    return array;
}

template <class T>
std::int64_t words_in(std::int64_t count) {
    return count * static_cast<std::int64_t>(sizeof(T) / 4);
}

}  // namespace

Deformation::Deformation(std::shared_ptr<Device> device, const Model& model, Arrays& arrays)
    : device_(std::move(device)), model_(&model), arrays_(&arrays) {
    for (const auto& [kernel, name] : {std::pair{&raise_masses_, "raise_masses"},
                                       {&motion_, "motion"},
                                       {&return_ghost_impulses_, "return_ghost_impulses"},
                                       {&move_ghosts_, "move_ghosts"},
                                       {&gradients_, "gradients"}})
        *kernel = device_->kernel("deformation", name);
    for (const auto& [kernel, name] : {std::pair{&couple_points_, "couple_points"},
                                       {&place_held_, "place_held"},
                                       {&solve_contacts_, "solve_contacts"}})
        *kernel = device_->kernel("contact", name);
    for (const auto& [kernel, name] : {std::pair{&near_phyxels_, "near_phyxels"},
                                       {&list_phyxels_, "list_phyxels"},
                                       {&near_hexels_, "near_hexels"},
                                       {&list_hexels_, "list_hexels"}})
        *kernel = device_->kernel("near", name);
    for (const auto& [kernel, name] : {std::pair{&keep_main_, "keep_main"},
                                       {&sever_faces_, "sever_faces"},
                                       {&sever_edges_, "sever_edges"},
                                       {&drop_phyxels_, "drop_phyxels"},
                                       {&drop_hexels_, "drop_hexels"}})
        *kernel = device_->kernel("topology", name);
    refresh_rest_ = device_->kernel("rest", "refresh_rest");
    refresh_masses_ = device_->kernel("rest", "refresh_masses");
    embed_points_ = device_->kernel("embedding", "embed_points");

    const std::int64_t cells = model.phyxels.cells;
    rest_ = DeviceArray<float>(*device_, REST_PLANES * cells);
    mass_ = DeviceArray<float>(*device_, MASS_PLANES * cells);
    gradient_ = DeviceArray<float>(*device_, 9 * cells);
    moment_stress_ = DeviceArray<float>(*device_, 9 * cells);
    own_force_ = DeviceArray<float>(*device_, 3 * cells);
    stiffening_ = DeviceArray<float>(*device_, cells);
    words_ = DeviceArray<std::uint32_t>(*device_, WORD_PLANES * cells);
    phyxel_centres_ = centres_of(*device_, model.phyxels);
    hexel_centres_ = centres_of(*device_, model.hexels);
    const deformation::NeighbourRows rows(model.hexels);
    std::vector<float> outwards;
    for (const auto& row : deformation::kRowOutward)
        for (const auto& sum : row) {
            Vec3f outward(0.0f);
            for (int k = 0; k < 3; ++k) outward[rows.axis[k]] = sum[static_cast<std::size_t>(k)];
            outwards.insert(outwards.end(), {outward.x, outward.y, outward.z});
        }
    outwards_ = DeviceArray<float>(*device_, static_cast<std::int64_t>(outwards.size()));
    outwards_.upload(*device_, std::span<const float>(outwards));

    embedding_.hexels = arrays.hexels;
    embedding_.phyxels = arrays.phyxels;
    embedding_.hexels_per_edge = model.hexels_per_edge;
    embedding_.per_spacing = static_cast<float>(1.0 / model.phyxels.spacing_m);
    embedding_.per_squared_radius =
        static_cast<float>(1.0 / (deformation::kEmbeddingRadius * deformation::kEmbeddingRadius));

    std::vector<std::int32_t> active, ghosts, beside;
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        const bool ghost = model.phyxel_ghost.test(p), phyxel = model.phyxel_initial.test(p);
        if (ghost || phyxel) active.push_back(static_cast<std::int32_t>(p));
        if (ghost) ghosts.push_back(static_cast<std::int32_t>(p));
        if (!phyxel) continue;
        for (const auto& link : deformation::neighbour_links())
            if (link.direction >= 0 && model.phyxel_ghost.test(p + model.phyxels.offset(link.step))) {
                beside.push_back(static_cast<std::int32_t>(p));
                break;
            }
    }
    active_ = list_on(*device_, active);
    ghosts_ = list_on(*device_, ghosts);
    beside_ = list_on(*device_, beside);
    report_ = DeviceArray<std::int32_t>(*device_, 2 + std::max<std::int64_t>(active_.size(), kMostReported));

    capsules_ = DeviceArray<std::uint32_t>(*device_, words_in<GpuCapsules>(1));
    is_near_ = DeviceArray<std::int32_t>(*device_, active_.size());
    near_total_ = DeviceArray<std::int32_t>(*device_, 1);
    near_hexel_total_ = DeviceArray<std::int32_t>(*device_, 1);
    reserve_near(1024, 4096);
}

void Deformation::take(const State& state) {
    host_ = deformation::make_work(*model_, state);
    const std::int64_t cells = model_->phyxels.cells;
    auto put = [&](DeviceArray<float>& to, std::int64_t plane, const Array<float>& from) {
        to.upload(*device_, {from.data(), from.size()}, plane * cells);
    };
    for (std::size_t e = 0; e < 6; ++e)
        put(rest_, REST_MOMENT_INVERSE + static_cast<std::int64_t>(e), host_.moment_inverse[e]);
    for (std::size_t c = 0; c < 3; ++c) put(rest_, REST_STEP_SUM + static_cast<std::int64_t>(c), host_.step_sum[c]);
    put(rest_, REST_VOLUME, host_.volume_m3);
    put(rest_, REST_HOURGLASS, host_.hourglass);
    put(rest_, REST_MU, host_.lame_mu_Pa);
    put(rest_, REST_LAMBDA, host_.lame_lambda_Pa);
    put(rest_, REST_PULL, host_.pull_N_per_m2);
    put(rest_, REST_SHARE, host_.volume_share);
    put(rest_, REST_STIFFNESS, host_.initial_stiffness_Nm);
    Array<float> trace(static_cast<std::size_t>(cells), 0.0f);
    for (std::int64_t p = model_->phyxels.first; p < model_->phyxels.last; ++p)
        if (model_->phyxel_initial.test(p))
            trace[static_cast<std::size_t>(p)] = static_cast<float>(deformation::initial_trace(*model_, p));
    put(rest_, REST_TRACE, trace);
    upload_numbers();
    put(mass_, MASS_WEIGHING, host_.weighing_mass_kg);
    put(mass_, MASS_MOVING, host_.moving_mass_kg);
    put(mass_, MASS_STABLE, host_.stable_mass_kg);
    std::vector<std::uint32_t> words(static_cast<std::size_t>(WORD_PLANES * cells), 0);
    auto word = [&](int plane, std::int64_t cell) -> std::uint32_t& {
        return words[static_cast<std::size_t>(plane * cells + cell)];
    };
    for (std::int64_t p = model_->phyxels.first; p < model_->phyxels.last; ++p) {
        const auto i = static_cast<std::size_t>(p);
        word(WORD_LINKS, p) = host_.link_word[i];
        word(WORD_MIRROR, p) = mirror_word(p);
        word(WORD_CARRIERS, p) = carrier_word(state, p);
        word(WORD_OCCUPANCY, p) = static_cast<std::uint32_t>(host_.occupancy[i]);
        word(WORD_OCCUPANCY + 1, p) = static_cast<std::uint32_t>(host_.occupancy[i] >> 32);
        word(WORD_HELD, p) = static_cast<std::uint32_t>(host_.held[i]);
        word(WORD_HELD + 1, p) = static_cast<std::uint32_t>(host_.held[i] >> 32);
    }
    words_.upload(*device_, std::span<const std::uint32_t>(words));
    for (DeviceArray<float>* array : {&gradient_, &moment_stress_, &own_force_, &stiffening_})
        device_->fill_zero(array->buffer());
    run_gradients(sweep(), active_, active_.size(), 1);

    const deformation::ContactWork& contact = host_.contact;
    const std::int64_t most_rows = static_cast<std::int64_t>(contact.inverse_mass_per_kg.size());
    rows_ = DeviceArray<std::int32_t>(*device_, most_rows);
    psi_ = DeviceArray<float>(*device_, most_rows * deformation::kMaxPoints);
    coupling_ = DeviceArray<float>(*device_, deformation::kMaxPoints * deformation::kMaxPoints);
    device_points_ = DeviceArray<std::uint32_t>(*device_, words_in<GpuContactPoint>(deformation::kMaxPoints));
    torn_.clear();
}

GpuSweep Deformation::sweep() const {
    GpuSweep s{};
    s.phyxels = arrays_->phyxels;
    s.law = model_->deformation.law == tissue::ElasticLaw::stable_neo_hookean ? 0 : 1;
    s.volume_stiffness_Pa = static_cast<float>(model_->deformation.volume_stiffness_Pa);
    const double stretch = model_->deformation.tear_stretch;
    s.most_squared_stretch = static_cast<float>(stretch * stretch + 2.0 / stretch);  // as KernelView::make
    s.substep_s = host_.substep_s;
    s.rest_m_per_s = deformation::kRest_m_per_s;
    s.nowhere_m = deformation::kNowhere_m;
    s.decay = static_cast<float>(std::exp(-model_->deformation.damping_per_s * static_cast<double>(host_.substep_s)));
    for (int r = 0; r < 3; ++r)
        s.gravity_step_m_per_s[r] = static_cast<float>(model_->deformation.gravity_m_per_s2[r]) * host_.substep_s;
    std::array<int, kNeighbourhood> order;
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return host_.neighbour_offset[static_cast<std::size_t>(a)] <
               host_.neighbour_offset[static_cast<std::size_t>(b)];
    });
    std::copy(order.begin(), order.end(), s.ascending);
    return s;
}

void Deformation::run_gradients(const GpuSweep& s, const DeviceArray<std::int32_t>& cells, std::int64_t count,
                                int whole) {
    device_->launch(gradients_, count, kGroup, s, cells, static_cast<std::int32_t>(count), whole,
                    arrays_->phyxel_present, arrays_->phyxel_ghost, words_, rest_, arrays_->displacement_m, gradient_,
                    moment_stress_, own_force_, stiffening_, report_, static_cast<std::int32_t>(report_.size() - 2));
}

void Deformation::prepare_contacts(const State& state, const Exchange& exchange, const GpuSweep& s) {
    deformation::ContactWork& contact = host_.contact;
    deformation::list_points(*model_, state, exchange, contact);
    contact_ = {};
    contact_.points = static_cast<std::int32_t>(contact.points.size());
    if (contact_.points == 0) return;
    deformation::carry_points(*model_, state, host_);
    contact_.rows = static_cast<std::int32_t>(contact.phyxel.size());
    contact_.stride = contact.stride;
    contact_.cells = arrays_->phyxels.cells;
    contact_.friction = static_cast<float>(model_->contact.friction);
    contact_.substep_s = s.substep_s;
    points_.assign(contact.points.size(), {});
    for (std::size_t c = 0; c < points_.size(); ++c) {
        deformation::ContactPoint& point = contact.points[c];
        GpuContactPoint& to = points_[c];
        if (point.held()) {
            deformation::place_point(*model_, state, exchange, Vec3f(0.0f), point);
            const Vec3 rest_m = deformation::away_at_rest_m(*model_, state, point) - Vec3(point.away_m);
            for (int r = 0; r < 3; ++r) to.away_rest[r] = static_cast<float>(rest_m[r]);
        }
        for (int r = 0; r < 3; ++r) {
            to.normal[r] = point.normal[r];
            to.tool_velocity[r] = point.tool_velocity_m_per_s[r];
            to.away[r] = point.away_m[r];
            to.impulse[r] = point.impulse_Ns[r];
        }
        to.stiffness = point.stiffness_N_per_m;
        to.gap = point.gap_m;
        to.most_force = point.most_force_N;
        to.first = point.first;
        to.end = point.end;
    }
    device_->write(device_points_.buffer(), points_.data(), points_.size() * sizeof(GpuContactPoint));
    rows_.upload(*device_, std::span<const std::int32_t>(contact.phyxel));
    psi_.upload(*device_, {contact.psi.data(), points_.size() * static_cast<std::size_t>(contact.stride)});
    device_->launch(couple_points_, std::int64_t{contact_.points} * deformation::kMaxPoints * kContactLanes,
                    kContactGroup, contact_, device_points_, rows_, psi_, mass_, coupling_);
    if (contact.points.back().held())  // held ones come last
        device_->launch(place_held_, contact_.points, kGroup, contact_, device_points_, rows_, psi_,
                        arrays_->displacement_m);
}

void Deformation::advance(const State& state, const Exchange& exchange) {
    const GpuSweep s = sweep();
    const auto active = static_cast<std::int32_t>(active_.size()), ghosts = static_cast<std::int32_t>(ghosts_.size()),
               beside = static_cast<std::int32_t>(beside_.size());
    Arrays& a = *arrays_;
    device_->launch(raise_masses_, active, kGroup, s, active_, active, a.phyxel_present, words_, stiffening_, mass_,
                    report_);
    prepare_contacts(state, exchange, s);
    for (int substep = 0; substep < host_.substeps; ++substep) {
        device_->launch(motion_, active, kGroup, s, active_, active, a.phyxel_present, a.phyxel_ghost, words_,
                        moment_stress_, own_force_, mass_, a.velocity_m_per_s, a.displacement_m);
        device_->launch(return_ghost_impulses_, beside, kGroup, s, beside_, beside, a.phyxel_present, words_, mass_,
                        a.velocity_m_per_s, a.displacement_m);
        if (contact_.points > 0)
            device_->launch(solve_contacts_, kContactGroup, kContactGroup, contact_,
                            substep == 0 ? deformation::kFirstSweeps : deformation::kSweeps, device_points_, rows_,
                            psi_, mass_, coupling_, a.velocity_m_per_s, a.displacement_m);
        device_->launch(move_ghosts_, ghosts, kGroup, s, ghosts_, ghosts, words_, a.displacement_m, a.velocity_m_per_s);
        run_gradients(s, active_, active, substep + 1 < host_.substeps ? 0 : 2);
    }
}

void Deformation::finish_advance(State& state, Exchange& exchange) {
    std::array<std::int32_t, 2 + kMostReported> report{};
    report_.download(*device_, std::span<std::int32_t>(report));
    const std::int32_t torn = report[1];
    torn_.assign(static_cast<std::size_t>(torn), 0);
    if (torn <= kMostReported)
        std::copy_n(report.begin() + 2, torn, torn_.begin());
    else
        report_.download(*device_, std::span<std::int32_t>(torn_), 2);
    std::sort(torn_.begin(), torn_.end());  // they come in no order

    std::array<Vec3, tissue::kInstruments> impulse_Ns{};
    deformation::ContactWork& contact = host_.contact;
    if (contact_.points > 0) {
        device_->read(device_points_.buffer(), points_.data(), points_.size() * sizeof(GpuContactPoint));
        for (std::size_t c = 0; c < points_.size(); ++c)
            for (int r = 0; r < 3; ++r) {
                deformation::ContactPoint& point = contact.points[c];
                point.impulse_Ns[r] = points_[c].impulse[r];
                point.away_m[r] = points_[c].away[r];
                impulse_Ns[static_cast<std::size_t>(point.instrument)][r] +=
                    static_cast<double>(points_[c].sum[r]) - static_cast<double>(points_[c].sum_rest[r]);
            }
    }
    exchange.contact_force_N = impulse_Ns[0] / -model_->tick_s;
    exchange.grasper_contact_force_N = impulse_Ns[1] / -model_->tick_s;
    deformation::slip_held(state, exchange, contact);
    deformation::remember_contacts(state, host_);
    if (state.status.ok && report[0] != INT_MAX) state.status = {false, "displacement_m", report[0], state.tick};
}

void Deformation::embed_points(const DeviceArray<float>& rest_m, const DeviceArray<std::int32_t>& owner,
                               const DeviceArray<std::int32_t>& count, std::int64_t most, DeviceArray<float>& world_m,
                               DeviceArray<float>* gradients) {
    device_->launch(embed_points_, most, kGroup, embedding_, phyxel_centres_, words_, arrays_->displacement_m,
                    gradient_, rest_m, owner, count, static_cast<std::int32_t>(most), world_m,
                    gradients != nullptr ? *gradients : world_m, gradients != nullptr ? 1 : 0);
}

void Deformation::embed_points(std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner,
                               std::span<Vec3f> world_m) {
    if (rest_m.empty()) return;
    const auto count = static_cast<std::int64_t>(rest_m.size());
    if (few_world_m_.size() < 3 * count) {
        few_rest_m_ = DeviceArray<float>(*device_, 6 * count);
        few_world_m_ = DeviceArray<float>(*device_, 6 * count);
        few_count_ = DeviceArray<std::int32_t>(*device_, 1);
    }
    const auto number = static_cast<std::int32_t>(count);
    few_count_.upload(*device_, {&number, 1});
    device_->write(few_rest_m_.buffer(), rest_m.data(), rest_m.size_bytes());
    embed_points(few_rest_m_, list_of(owner), few_count_, count, few_world_m_);
    device_->read(few_world_m_.buffer(), world_m.data(), world_m.size_bytes());
}

std::uint64_t Deformation::bytes() const {
    std::uint64_t total = 0;
    for (const Buffer* buffer : {&rest_.buffer(),          &mass_.buffer(),
                                 &gradient_.buffer(),      &moment_stress_.buffer(),
                                 &own_force_.buffer(),     &stiffening_.buffer(),
                                 &words_.buffer(),         &phyxel_centres_.buffer(),
                                 &hexel_centres_.buffer(), &outwards_.buffer(),
                                 &active_.buffer(),        &ghosts_.buffer(),
                                 &beside_.buffer(),        &report_.buffer(),
                                 &device_points_.buffer(), &rows_.buffer(),
                                 &psi_.buffer(),           &coupling_.buffer(),
                                 &capsules_.buffer(),      &is_near_.buffer(),
                                 &near_list_.buffer(),     &near_counts_.buffer(),
                                 &near_mask_.buffer(),     &near_found_.buffer(),
                                 &near_out_.buffer(),      &numbers_,
                                 &few_rest_m_.buffer(),    &few_world_m_.buffer(),
                                 &cells_.buffer(),         &values_.buffer()})
        total += buffer->bytes();
    return total;
}

}  // namespace calot::gpu
