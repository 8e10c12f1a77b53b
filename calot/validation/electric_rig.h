#pragma once
// Blocks of tissue with metal on chosen hexels, for checks of the electric room.

#include <memory>
#include <string>
#include <utility>

#include "calot/anatomy/anatomy.h"
#include "calot/anatomy/block.h"
#include "calot/anatomy/shapes.h"
#include "calot/electric/work.h"
#include "calot/tissue/sampling.h"

namespace calot::electric {

struct Rig {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    tissue::Input input;
    WorkPtr work;

    explicit Rig(tissue::Model built, const Kernels& kernels = wide_kernels())
        : model(std::move(built)), state(tissue::State::make(model)), work(make_work(model, kernels)) {
        exchange.near.reserve(static_cast<std::size_t>(1) << 16);
        input.pedal = true;
        input.power_setting_W = 30.0;
    }
    void touch(const Int3& hexel, float gap_m = 0.0f) {
        tissue::NearHexel near;
        near.hexel = model.hexels.index(hexel);
        near.rest_m = Vec3f(model.hexels.centre_m(hexel));
        near.world_m = near.rest_m;
        near.bare_gap_m = gap_m;
        exchange.near.push_back(near);
    }
    void solve() { solve_now(model, state, exchange, input, *work); }
    double resistance_Ohm() const { return 1.0 / work->conductance_S; }
};

/// A box of hexels full of one tissue (material "fat"), insulated by a ring of empty cells, `hexels_per_edge` wide,
/// which numbers of hexels along the edges are multiples of. Nothing is held.
inline tissue::Model full_box(const Int3& hexels, double conductivity_S_per_m, int hexels_per_edge = 4,
                              double spacing_m = 0.6e-3) {
    anatomy::Anatomy anatomy;
    const Vec3 high = spacing_m * Vec3(hexels);
    anatomy.tissues.push_back({"box", "fat", anatomy::make_box(Vec3(0.0), high)});
    anatomy.field = Box{Vec3(0.0), high};
    auto materials = tissue::default_materials();
    materials[tissue::find_material(materials, "fat")].electric_conductivity_S_per_m = conductivity_S_per_m;
    return tissue::sample(anatomy, {.hexel_spacing_m = spacing_m, .hexels_per_edge = hexels_per_edge}, materials);
}

/// A deep block whose top face carries a disc of metal of radius `radius` hexels, centred between hexels; the window
/// cuts through tissue on all sides but the top.
inline Rig disc_rig(int window, double radius, double conductivity_S_per_m, double residual,
                    const Kernels& kernels = wide_kernels()) {
    tissue::Model model = full_box({window + 16, window + 16, window + 8}, conductivity_S_per_m);
    model.electric.window_cells = window;
    model.electric.relative_residual = residual;
    Rig rig(std::move(model), kernels);
    const int middle = 4 + (window + 16) / 2, top = 4 + window + 8 - 1;
    // The window starts well placed, so that none of its sides is the block's.
    rig.state.field_low = Int3(middle - window / 2, middle - window / 2, 16);
    const int reach = static_cast<int>(radius) + 1;
    for (int y = -reach; y < reach; ++y)
        for (int x = -reach; x < reach; ++x)
            if ((x + 0.5) * (x + 0.5) + (y + 0.5) * (y + 0.5) < radius * radius)
                rig.touch({middle + x, middle + y, top});
    return rig;
}

/// A block of fat, 24 x 24 x 9.6 mm, held below by a slab of liver; metal lies on 2 x 8 hexels of its top.
inline Rig held_rig(double residual, const Kernels& kernels = wide_kernels()) {
    tissue::Model model = tissue::sample(anatomy::make_block({.size_m = Vec3(0.024, 0.024, 0.0096)}), {});
    model.electric.window_cells = 48;  // all of it
    model.electric.relative_residual = residual;
    Rig rig(std::move(model), kernels);
    for (int y = 20; y < 28; ++y)
        for (int x = 23; x < 25; ++x) rig.touch({x, y, 19});
    return rig;
}

}  // namespace calot::electric
