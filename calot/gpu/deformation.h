#pragma once
// Deformation on a device: what calot/deformation does to the phyxels of a running simulation, kernel by kernel the
// same arithmetic in the same order. Where a device rounds as the host does, results are the same to the bit.
//
// Phyxels live on the device: displacement, velocity, gradients, rest properties, masses, links. Over the bus go, in
// every tick, the near hexels and the contact points with the shares of what carries them; where something burns, which
// phyxels it was. The host keeps the bits (hexels, phyxels, links: tissue::State's) by the same rules, and with them
// searches what hangs on nothing any more: that follows chains of cells, and a device would have to be waited for.

#include <memory>
#include <span>
#include <vector>

#include "calot/deformation/near_kernel.h"
#include "calot/deformation/work.h"
#include "calot/gpu/arrays.h"
#include "calot/gpu/scan.h"

namespace calot::gpu {

class Deformation {
  public:
    /// `arrays` and `model` must outlive it.
    Deformation(std::shared_ptr<Device> device, const tissue::Model& model, Arrays& arrays);

    /// Begins from a state, which `arrays` already hold.
    void take(const tissue::State& state);

    // The parts of a tick, in the order of simulation/step.cpp. `state` is the host's: of its big arrays the bits must
    // be current.

    /// deformation::find_near: fills Exchange::near. Waits for the device.
    void find_near(tissue::Exchange& exchange, const deformation::NearReach& reach);
    /// deformation::advance, enqueued: nobody waits.
    void advance(const tissue::State& state, const tissue::Exchange& exchange);
    /// What the host wants to know of it: forces on the instruments, contact memory, slip, trouble. Waits.
    void finish_advance(tissue::State& state, tissue::Exchange& exchange);
    /// deformation::tear_overstretched and sever_burnt_links, for Exchange::removed_hexels that `hexel_present` on host
    /// and device already lack. Hexels that tear off or fall leave on both sides.
    void tear_and_sever(tissue::State& state, tissue::Exchange& exchange);

    /// Places points in the world (deformation::embed_points). On the device, places are x y z one after another,
    /// owners hexel cells, `count` one number: at most `most`. `gradients`, F in columns, nine numbers a point, may be
    /// null.
    void embed_points(const DeviceArray<float>& rest_m, const DeviceArray<std::int32_t>& owner,
                      const DeviceArray<std::int32_t>& count, std::int64_t most, DeviceArray<float>& world_m,
                      DeviceArray<float>* gradients = nullptr);
    /// The same for a few points of the host.
    void embed_points(std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner, std::span<Vec3f> world_m);

    // For kernels that include embedding.h.
    const GpuEmbedding& embedding() const { return embedding_; }
    const DeviceArray<float>& phyxel_centres() const { return phyxel_centres_; }
    const DeviceArray<std::uint32_t>& words() const { return words_; }  ///< [WORD_PLANES][phyxels.cells]
    const DeviceArray<float>& gradient() const { return gradient_; }    ///< G, [9][phyxels.cells]

    // For tests and figures.
    /// What the host keeps: bits, link words, moments and mirrors are current, nothing else.
    const deformation::Work& host_work() const { return host_; }
    const DeviceArray<float>& moment_stress() const { return moment_stress_; }  ///< M, [9][phyxels.cells]
    const DeviceArray<float>& rest() const { return rest_; }                    ///< [REST_PLANES][phyxels.cells]
    const DeviceArray<float>& mass() const { return mass_; }                    ///< [MASS_PLANES][phyxels.cells]
    std::uint64_t bytes() const;

  private:
    GpuSweep sweep() const;
    void prepare_contacts(const tissue::State& state, const tissue::Exchange& exchange, const GpuSweep& sweep);
    void run_gradients(const GpuSweep& sweep, const DeviceArray<std::int32_t>& cells, std::int64_t count, int whole);
    GpuTopology topology() const;
    void upload_numbers();
    void drop_hexels(std::span<const std::int64_t> hexels, std::size_t first);
    void sever(std::span<const std::int64_t> removed);
    void drop_phyxels(const tissue::State& state, std::span<const std::int64_t> changed);
    void refresh(std::span<const std::int64_t> changed);
    /// Into scratch.
    const DeviceArray<std::int32_t>& list_of(std::span<const std::int64_t> cells);
    std::uint32_t mirror_word(std::int64_t cell) const;
    std::uint32_t carrier_word(const tissue::State& state, std::int64_t cell) const;
    GpuNear near_parameters(const deformation::Capsules& capsules) const;
    void reserve_near(std::int64_t phyxels, std::int64_t hexels);

    std::shared_ptr<Device> device_;
    const tissue::Model* model_;
    Arrays* arrays_;
    deformation::Work host_;
    GpuEmbedding embedding_{};

    Kernel raise_masses_, motion_, return_ghost_impulses_, move_ghosts_, gradients_, couple_points_, place_held_,
        solve_contacts_, embed_points_, near_phyxels_, list_phyxels_, near_hexels_, list_hexels_, keep_main_,
        sever_faces_, sever_edges_, drop_phyxels_, drop_hexels_, refresh_rest_, refresh_masses_;
    Scan scan_;

    // [planes][phyxels.cells], types.h
    DeviceArray<float> rest_, mass_, gradient_, moment_stress_, own_force_, stiffening_;
    DeviceArray<std::uint32_t> words_;
    DeviceArray<float> phyxel_centres_, hexel_centres_, outwards_;  ///< along the axes; kRowOutward
    DeviceArray<std::int32_t> active_, ghosts_, beside_;            ///< cells, ascending
    DeviceArray<std::int32_t> report_;                              ///< lowest bad cell, torn phyxels: count, cells

    GpuContact contact_{};
    std::vector<GpuContactPoint> points_;
    DeviceArray<std::uint32_t> device_points_;  ///< GpuContactPoint
    DeviceArray<std::int32_t> rows_;
    DeviceArray<float> psi_, coupling_;

    DeviceArray<std::uint32_t> capsules_;
    DeviceArray<std::int32_t> is_near_, near_list_, near_total_, near_counts_, near_hexel_total_;
    DeviceArray<std::uint32_t> near_mask_, near_found_, near_out_;  ///< the last two: GpuNearHexel
    std::vector<GpuNearHexel> found_;
    std::int64_t most_near_phyxels_ = 0, most_near_hexels_ = 0;

    std::vector<std::int32_t> torn_;               ///< phyxels of the last tick, ascending
    Buffer numbers_;                               ///< NUMBER_*, real
    std::vector<std::int64_t> noted_;              ///< scratch: cells
    std::vector<std::int32_t> list_;               ///< scratch
    DeviceArray<std::int32_t> cells_;              ///< scratch: lists of cells from the host
    DeviceArray<float> values_;                    ///< scratch
    DeviceArray<float> few_rest_m_, few_world_m_;  ///< of embed_points for the host
    DeviceArray<std::int32_t> few_count_;
};

}  // namespace calot::gpu
