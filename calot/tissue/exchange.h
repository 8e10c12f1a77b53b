#pragma once
// Exchange: what physics rooms hand to one another within a tick. Rooms do not include each other; they meet here and
// in State. Scratch: never saved, rebuilt every tick. All vectors are reserved at set-up and never grow inside a step.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "calot/base/array.h"
#include "calot/base/vec.h"
#include "calot/tissue/input.h"
#include "calot/tissue/model.h"

namespace calot::tissue {

enum class Instrument : std::uint8_t { hook, grasper };
inline constexpr int kInstruments = 2;

/// A rounded cylinder in world space, a piece of an instrument.
struct Capsule {
    Vec3 a_m{0.0};
    Vec3 b_m{0.0};
    double radius_m = 0.0;
    bool bare = false;  ///< metal without insulation: carries current, gets hot
    Vec3 velocity_a_m_per_s{0.0};
    Vec3 velocity_b_m_per_s{0.0};
    Instrument instrument = Instrument::hook;
    bool solid = true;  ///< collides; jaws that hold do not, what they hold follows them anyway
};

/// A surface hexel close to an instrument, with its place in world space.
struct NearHexel {
    std::int64_t hexel = 0;  ///< cell
    Vec3f rest_m{0.0f};
    Vec3f world_m{0.0f};
    float bare_gap_m = 1e9f;  ///< distance from its surface to the nearest bare metal; <= 0 touches
    float distance_m = 1e9f;  ///< from its centre to the surface of the nearest capsule, negative inside
    Vec3f outward{0.0f};      ///< unit, away from the tissue (estimated from absent neighbours); 0 where they balance
};

/// A one-sided constraint at a near hexel, linearised at the start of the tick and enforced in every substep.
struct Contact {
    std::int32_t near = 0;              ///< index into Exchange::near
    Vec3f normal{0.0f};                 ///< unit, out of the instrument
    float gap_m = 0.0f;                 ///< at the start of the tick, negative = penetration
    Vec3f tool_velocity_m_per_s{0.0f};  ///< of the instrument's surface there
    Instrument instrument = Instrument::hook;
};

/// Mass that left a hexel as steam or smoke during this tick.
struct GasEvent {
    std::int64_t hexel = 0;
    float steam_kg = 0.0f;
    float smoke_kg = 0.0f;
    float temperature_K = 373.15f;
};

/// Joule heat in a box of hexels, from the last electric solve: a view of State::joule_S_per_m3. Empty (size 0) when no
/// current flows.
struct JouleHeat {
    Int3 low{0};                    ///< hexel coordinates of the box's low corner
    Int3 size{0};
    Int3 stride{0};                 ///< offset in `density` of one step along x, y, z; rows lie as in Model::hexels
    std::span<const float> density; ///< [size.x * size.y * size.z], times `scale` in W/m^3
    float scale = 1.0f;             ///< from the field of one volt to the present voltage: V^2
    double total_W = 0.0;           ///< sum of density * hexel volume
    double outflow_W = 0.0;         ///< dissipated outside the tissue's hexels, in held organs and beyond the window;
                                    ///< the generator delivers total_W + outflow_W + wire_W
    double wire_W = 0.0;            ///< in the wire, by arcs

    /// Place in `density` of a hexel in the box.
    std::int64_t index(const Int3& hexel) const {
        const Int3 c = hexel - low;
        return std::int64_t{c.x} * stride.x + std::int64_t{c.y} * stride.y + std::int64_t{c.z} * stride.z;
    }
    /// Sets low, size and stride, with the axes in the order of a lattice's, fastest first.
    void place(const Lattice& lattice, const Int3& low_corner, const Int3& extent);
};

struct Exchange {
    // simulation/instruments -> all: the instruments in world space, this tick: the hook's capsules, then the grasper's
    std::vector<Capsule> capsules;
    GrasperInput grasper;  ///< of this tick, for what it holds

    // deformation (embedding) -> instruments, electric
    std::vector<NearHexel> near;

    // instruments -> deformation
    std::vector<Contact> contacts;
    // deformation -> simulation: force of the tissue on the hook, mean over substeps
    Vec3 contact_force_N{0.0};
    // instruments -> simulation: force of rigid organs on the hook
    Vec3 organ_force_N{0.0};
    // the same two, on the grasper; the first with what it holds
    Vec3 grasper_contact_force_N{0.0};
    Vec3 grasper_organ_force_N{0.0};

    // electric -> thermal
    JouleHeat joule;

    // thermal -> deformation, surface, effects: this tick
    std::vector<std::int64_t> removed_hexels;  ///< burnt by thermal, then crumbs appended by deformation
    std::vector<GasEvent> gas;
    // deformation -> surface: rest boxes are enough; phyxels whose links changed this tick
    std::vector<std::int64_t> changed_phyxels;
};

/// Reserves every vector for the most that a tick can bring, so that nothing grows inside a step. Removed hexels and
/// changed phyxels are bounded by what exists. Of near hexels, the nearest kNearCapacity are kept.
void reserve_exchange(const Model& model, Exchange& exchange);
inline constexpr std::int64_t kNearCapacity = 4096;
/// Gas events of a tick; smoke of what lies beyond is not drawn (its energy is booked all the same).
inline constexpr std::int64_t kGasCapacity = 16384;

}  // namespace calot::tissue
