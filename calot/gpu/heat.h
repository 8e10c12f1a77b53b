#pragma once
// Heat on a device: what thermal/heat.h does, with the same operations (kernels/heat.cl).
//
// A device has no need to spread a heat step over the ticks of its interval: all of it runs in one tick, the one about
// which the host's parts lie (of 8 ticks the fourth). Its temperatures, and so its result, are those of the host's
// step but for what happened in between, hexels that burnt since.
//
//     tick   0        1        2        3                  4 ...                7
//                                       heat step
//                                       lists come back
//            a quarter of the hexels that are gas goes in every tick, taken from the list by the host
//
// Joule heat. On the host a hexel takes the heat of the tick in which its block has its turn, for all eight. Here the
// step gives what came since the step before, and as much ahead as the ticks that remain of the interval will bring if
// all stays as it is; EnergyBudget::transit remembers what that is wrong by. So the two agree while a current flows
// steadily, and what the generator gives arrives, however often it comes and goes. What hexels would have got that went
// since the field was solved counts as outflow. Between steps State is complete.
//
// On the host stay: the wire's temperature, the energy budget, which hexels are present (State::hexel_present is kept
// up with what goes), the list of those that are gas. What else State holds of hexels is on the device (gpu::Arrays).
//
// What crosses the bus in a step: up, what the wire touches; down, 60 bytes and 8 for every hexel that is gas or
// boiled.

#include <memory>
#include <vector>

#include "calot/gpu/arrays.h"
#include "calot/gpu/device.h"
#include "calot/gpu/kernels/heat_types.h"
#include "calot/thermal/heat.h"
#include "calot/thermal/tip.h"

namespace calot::gpu {

class Heat {
  public:
    /// `arrays` outlives it. Call look_at before the first tick.
    Heat(std::shared_ptr<Device> device, const tissue::Model& model, Arrays& arrays);

    /// After Arrays::upload: temperatures, and what is gas already.
    void look_at(const tissue::Model& model, tissue::State& state);

    /// thermal::conduct. `joule_S_per_m3`: heat of one volt in the window at State::field_low, whose sum is
    /// FieldState::tissue_S. Only enqueues.
    void conduct(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange,
                 const DeviceArray<float>& joule_S_per_m3);

    /// thermal::remove_vaporised, after conduct in every tick. Waits for the step where this tick had one.
    void remove_vaporised(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange);

    /// Tick within an interval of so many in which the step runs.
    static int step_tick(int refresh_ticks) { return refresh_ticks * 3 / 8; }

    /// [hexels.cells] of present hexels.
    const DeviceArray<float>& temperature_K() const { return temperature_K_; }
    /// [blocks] 1: took part in the last step.
    const DeviceArray<std::int32_t>& active() const { return active_; }

  private:
    struct Kernels {
        Kernel active, tip, flow, settle, look, totals, list, remove;
    };
    GpuHeatStep make_step(const tissue::Model& model, const tissue::State& state, double given_J) const;
    void enqueue_step(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                      const DeviceArray<float>& joule_S_per_m3);
    void enqueue_lists(const GpuHeatStep& step);
    void book(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange);
    void book_arcs(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange);
    void take_spent(const tissue::Model& model, tissue::State& state, std::int32_t count);
    void emit_steam(const tissue::Model& model, tissue::Exchange& exchange, std::int32_t count);

    std::shared_ptr<Device> device_;
    Arrays* arrays_;
    Kernels kernels_;
    GpuHeatStep constant_{};  ///< what is the same in every step
    double step_s_ = 0.0;     ///< length
    int substeps_ = 1;        ///< more than one where a step would not be stable
    thermal::Work host_;      ///< properties, what is gas and has still to go

    DeviceArray<GpuHeatMaterial> materials_;
    DeviceArray<GpuTouch> touched_;
    DeviceArray<float> temperature_K_, steam_kg_per_m3_;         ///< [hexels.cells]
    DeviceArray<std::int32_t> active_, warm_, counts_, places_;  ///< [blocks], places [blocks][2]
    DeviceArray<float> sums_;                                    ///< [blocks][HEAT_SUMS][2]
    DeviceArray<GpuHexelValue> spent_, boiled_;
    DeviceArray<GpuHeatTotals> totals_;
    DeviceArray<std::int32_t> removed_;

    bool pending_ = false;    ///< a step has been enqueued whose lists have not been looked at
    double given_J_ = 0.0;    ///< by Joule heat in the step under way
    GpuHeatTotals result_{};  ///< of the last step
    thermal::WireContact contact_;
    std::vector<GpuTouch> touch_list_;
    std::vector<GpuHexelValue> values_;
};

}  // namespace calot::gpu
