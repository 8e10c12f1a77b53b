#pragma once
// State: everything that is saved, hashed, compared and replayed. What can be computed from it and the Model
// (moment matrices, temperatures, surface) lives in the rooms' own work structures.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/base/vec.h"
#include "calot/tissue/input.h"
#include "calot/tissue/model.h"

namespace calot::tissue {

/// The nine positive directions of the 18 links (faces, then edges). The link between cells c and c + d is bit
/// index(c) of State::links[direction]; the negative nine are the same bits seen from the other end.
inline constexpr std::array<Int3, 9> kLinkDirections{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};
inline constexpr int kFaceDirections = 3;  ///< the first three are faces, the other six edges

/// Where the energy went since the start [J].
struct EnergyBudget {
    double delivered = 0.0;  ///< by the generator, into the window of the field
    double outflow = 0.0;    ///< dissipated beyond the window
    double gas = 0.0;        ///< carried off by steam and gasified solids: sensible and latent
    double latent = 0.0;     ///< of `gas`, the latent part
    double surface = 0.0;    ///< to gas and held tissue by convection
    double perfusion = 0.0;  ///< to blood
    double debris = 0.0;     ///< left with crumbs that fell
    double tip = 0.0;        ///< net, from tissue and arcs into the hook's bare wire
    double transit = 0.0;    ///< under way between hexels of which one has still to take its part in the heat step;
                             ///< zero between heat steps
    // stored (sum of enthalpy) is computed when asked for; the imbalance is
    // delivered - accounted() - stored.
    double accounted() const { return outflow + gas + surface + perfusion + debris + tip + transit; }
};

/// The bare wire of the hook, as one lump of steel.
struct TipState {
    double temperature_K = 310.15;  ///< of the wire
    double char_kg = 0.0;           ///< burnt tissue that sticks to it
    double heat_W = 0.0;  ///< net, from tissue and arcs into the wire during the last heat step; negative: it heats tissue
    double lost_J = 0.0;  ///< since the start: from the wire to gas and up the shaft
};

/// What the generator and the hook are doing.
struct GeneratorState {
    double voltage_V = 0.0;       ///< RMS
    double current_A = 0.0;       ///< RMS
    double power_W = 0.0;         ///< into tissue
    double impedance_Ohm = 0.0;   ///< 0 = open circuit
    double peak_voltage_V = 0.0;  ///< of the waveform: RMS times the mode's crest factor
    std::int64_t limit = 0;       ///< what rules: 0 nothing (off, open circuit), 1 current, 2 power, 3 voltage
};

/// The field about the tip for one volt on the metal, as last solved.
struct FieldState {
    double tissue_S = 0.0;        ///< heat in hexels per V^2
    double elsewhere_S = 0.0;     ///< in organs that hold tissue and beyond the window
    double wire_S = 0.0;          ///< in the wire, by arcs
    double residual = 0.0;        ///< |b - A phi| / |b| of the last solve
    double imbalance = 0.0;       ///< greatest |V I - heat - outflow| / V I of any solve so far
    std::int64_t solved = 0;      ///< 1: metal touches tissue and the field is that of this contact
    std::int64_t contacts = 0;    ///< hexels that metal touches
    std::int64_t arcs = 0;        ///< hexels that arcs strike

    double conductance_S() const { return tissue_S + elsewhere_S + wire_S; }  ///< 1 / R
};

/// Where current went that was not meant for it: by material, the first kStrayMaterials of Model::materials.
inline constexpr std::size_t kStrayMaterials = 16;
struct StrayCurrent {
    std::array<double, kStrayMaterials> power_W{};                   ///< now
    std::array<double, kStrayMaterials> energy_J{};                  ///< since the start
    std::array<double, kStrayMaterials> density_A_per_m2{};          ///< highest current density now, RMS
    std::array<double, kStrayMaterials> highest_density_A_per_m2{};  ///< and since the start
};

/// The grasper, and what it holds: material points of hexels that follow places between its jaws.
inline constexpr int kMostGrasped = 16;
struct GrasperState {
    std::int64_t present = 0;  ///< 1 = in the field in the last tick
    Pose pose;                 ///< of the last tick
    double jaw = 1.0;          ///< of the last tick: it takes hold when it closes, and lets go when it opens
    Vec3 force_N{0.0};         ///< reaction of tissue and organs on it, mean over the tick
    std::int64_t held = 0;     ///< points that it holds
    std::array<std::int64_t, kMostGrasped> hexel{};  ///< cell of each, ascending
    std::array<Vec3f, kMostGrasped> place_m{};       ///< where it is held, in the grasper's frame
};
static_assert(sizeof(GrasperState) == 8 + sizeof(Pose) + 8 + sizeof(Vec3) + 8 + kMostGrasped * (8 + sizeof(Vec3f)),
              "hashed as bytes: no padding");

/// Impulses at the points where instruments touched tissue in the last substep: where the next tick's solve starts.
inline constexpr int kMostContactPoints = 32;
struct ContactMemory {
    std::int64_t count = 0;
    std::array<std::int64_t, kMostContactPoints> hexel{};  ///< cell of each; a wedged hexel stands there twice
    std::array<Vec3f, kMostContactPoints> impulse_Ns{};    ///< on the tissue
};
static_assert(sizeof(ContactMemory) == 8 + kMostContactPoints * (8 + sizeof(Vec3f)), "hashed as bytes: no padding");

/// Numerical trouble stops a run in order.
struct Status {
    bool ok = true;
    const char* field = "";  ///< which
    std::int64_t cell = -1;  ///< where
    std::int64_t tick = -1;  ///< when
};

struct State {
    std::int64_t tick = 0;

    // --- Phyxels [phyxels.cells], written by deformation
    std::array<Array<float>, 3> displacement_m;  ///< u
    std::array<Array<float>, 3> velocity_m_per_s;
    std::array<BitArray, 9> links;  ///< live links; see kLinkDirections
    BitArray phyxel_present;        ///< has a main component and is simulated (ghosts not included)

    // --- Hexels [hexels.cells], written by thermal (and by deformation when crumbs fall)
    BitArray hexel_present;
    Array<float> enthalpy_J_per_m3;   ///< H, counted from body temperature
    Array<float> water_kg_per_m3;     ///< water left
    Array<float> peak_temperature_K;  ///< hottest so far: drives blanching, browning, char
    Array<float> damage;              ///< Omega, Arrhenius integral; saturates at 1e6

    // --- Electric field, written by electric: warm start of the next solve
    Int3 field_low{0};                               ///< hexel coordinates of the window's low corner
    Array<float> potential;                          ///< [window_cells^3] in units of the electrode's voltage, axes ordered as
                                                     ///< in Model::hexels (its fastest axis fastest)
    Array<float> joule_S_per_m3;                     ///< [window_cells^3] Joule heat of one volt [W/(m^3 V^2)], likewise
    FieldState field;
    /// For one volt: heat by material [W/V^2], and highest current density [A/(m^2 V)].
    std::array<double, kStrayMaterials> stray_S{}, stray_density_S_per_m2{};
    StrayCurrent stray;

    GeneratorState generator;
    TipState tip;  ///< written by thermal
    EnergyBudget energy_J;
    std::int64_t hexels_burnt = 0;   ///< gasified
    std::int64_t hexels_fallen = 0;  ///< in crumbs that came loose
    std::int64_t links_severed = 0;
    Vec3 hook_force_N{0.0};  ///< reaction of tissue and organs on the hook, mean over the tick
    Pose hook;               ///< of the last tick: its change is the instrument's velocity
    GrasperState grasper;
    ContactMemory contact;
    Status status;

    /// A fresh state: undeformed, at body temperature, all links alive.
    static State make(const Model& model);
};

/// A named piece of the state, for hashing, saving and comparing.
struct Field {
    const char* name;
    void* data;
    std::size_t bytes;
};

/// All fields in a fixed order. The names are those of the recordings and of what `replay --verify` reports.
std::vector<Field> fields(State& state);

/// Hash over all fields in order.
std::uint64_t hash(const State& state);
/// Hash of every field, in the order of fields().
std::vector<std::uint64_t> hash_fields(const State& state);

}  // namespace calot::tissue
