#pragma once
// The electric field about the tip on a device: what electric/solve.h does, with the same operations and on the same
// schedule of a frame, so that its results are the host's up to rounding (kernels/field_*.cl).
//
// Conjugate gradients with the host's preconditioner: on the finest level Jacobi and the coarse correction are added,
// below it is a V-cycle. A device wants that even more than a host does: what costs there is the launches, and a
// V-cycle down from the finest level has three more of them, the widest ones. Levels of up to kSmallItems cells are
// done by one work-group in one launch. An iteration is eight launches for a window of 48^3 cells; none of them returns
// anything: steps and the end of the iteration are decided on the device.
//
// On the host stay: where the window goes, what current may enter (from the near hexels), the generator, FieldState.
// What crosses the bus in a solve: up, 20 bytes for every hexel that current may enter; down, 56 bytes and 12 for every
// material.

#include <memory>
#include <vector>

#include "calot/electric/window.h"
#include "calot/gpu/arrays.h"
#include "calot/gpu/device.h"
#include "calot/gpu/kernels/field_types.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::gpu {

class Field {
  public:
    /// `arrays` outlives it.
    Field(std::shared_ptr<Device> device, const tissue::Model& model, const Arrays& arrays);

    /// State::potential and State::joule_S_per_m3, both ways. Between frames only.
    void upload(const tissue::State& state);
    void download(tissue::State& state) const;

    /// electric::step_field. Waits in the last tick of a frame in which a field was solved. Exchange::joule says what
    /// there is and where; its densities are those of joule_S_per_m3().
    void step(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, const tissue::Input& input);
    /// electric::solve_now: a whole solve in this very tick.
    void solve_now(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                   const tissue::Input& input);

    /// [window_cells^3] of one volt.
    const DeviceArray<float>& joule_S_per_m3() const { return joule_; }
    /// Iterations of the last solve.
    int iterations() const { return iterations_; }

  private:
    struct Kernels {
        Kernel gather, enter, burn, connect, faces, weights, aggregate, aggregate_small, guess, begin, begin_scalars,
            start, norms, restrict, descend, small_cycle, ascend, beta, direction, apply, alpha, advance, weigh, scale,
            heat, heat_sums;
    };
    void find_kernels();
    void make_levels(int cells);
    void gather(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                const tissue::Input& input);
    void list_entries(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                      double reach_gap_m);
    void assemble(const tissue::Model& model);
    void prepare(const tissue::State& state);
    void begin(const tissue::Model& model);
    void iterate(int count);
    void finish(const tissue::Model& model, tissue::State& state);
    void keep_heat(const tissue::Model& model, tissue::State& state, const GpuFieldScalars& scalars);

    const GpuLevel& fine() const { return levels_.level[0]; }
    /// Which vector of a level has its solution after the coarse cycle.
    int result_of(int level) const { return level == levels_.count - 1 ? LEVEL_SOLUTION : LEVEL_SCRATCH; }

    std::shared_ptr<Device> device_;
    const Arrays* arrays_;
    Kernels kernels_;
    GpuLevels levels_{};
    float wet_limit_K_ = 0.0f;
    std::int32_t materials_ = 0;

    DeviceArray<GpuConductor> conductors_;             ///< [materials]
    DeviceArray<float> rest_;                          ///< [hexels.cells] conductivity at body temperature
    DeviceArray<float> grid_;                          ///< vectors of all levels
    DeviceArray<float> sigma_, metal_, wire_, x_, p_;  ///< of the finest level; metal: g, wire: its share of the heat
    DeviceArray<std::int32_t> entered_;
    DeviceArray<float> parts_;
    DeviceArray<GpuFieldSum> heat_parts_, heat_sums_;
    DeviceArray<GpuFieldScalars> scalars_;
    DeviceArray<GpuEntry> entries_;
    DeviceArray<float> potential_, joule_;  ///< [window_cells^3]

    // The present solve
    bool solving_ = false;
    electric::Window window_;
    GpuWindow gpu_window_{};
    GpuPoles poles_{};
    Vec3 centre_{0.0};  ///< of the entries, window coordinates
    std::vector<GpuEntry> entry_list_;
    BitArray listed_;                    ///< cells of the entries
    std::vector<GpuFieldSum> sum_list_;  ///< what came back
    int iterations_ = 0;
};

}  // namespace calot::gpu
