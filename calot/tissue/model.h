#pragma once
// Model: everything that stays constant after set-up. The mutable counterpart is tissue/state.h.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "calot/anatomy/shape.h"
#include "calot/base/array.h"
#include "calot/base/lattice.h"
#include "calot/base/vec.h"
#include "calot/tissue/material.h"

namespace calot::tissue {

enum class ElasticLaw { stable_neo_hookean, saint_venant_kirchhoff };
enum class PhaseModel {
    water_then_solids,  ///< water boils at 100 C, dry solids heat on, char, gasify
    threshold           ///< one gasification temperature and latent heat (Pan et al. 2019)
};

/// Deformation (physics: docs/physics.md section 2).
struct DeformationParameters {
    ElasticLaw law = ElasticLaw::stable_neo_hookean;
    double volume_stiffness_Pa = 0.0;   ///< k_v of Eq. (8), Saint Venant-Kirchhoff only
    double hourglass_alpha = 0.6;       ///< share of E in the hourglass control, 0.3 to 0.6
    double damping_per_s = 80.0;        ///< gamma: velocity decays by exp(-gamma dt)
    double time_step_safety = 0.7;      ///< dt <= safety * s / c_L of the softest tissue
    double mass_fraction_floor = 0.25;  ///< phyxels are never lighter than this share of a full cell
    double singular_ratio = 0.03;       ///< lambda_min/lambda_max of A below which own stress is zero
    double tear_stretch = 2.5;   ///< tissue stretched beyond this tears; chosen: fat parts at about twice its length
    Vec3 gravity_m_per_s2{0.0};  ///< default none: the rest shape is the anatomy as it hangs
    int substeps = 0;            ///< per tick; 0 = derived from the softest tissue's wave speed (set by tissue::sample)
};

/// Electric field (section 5).
struct ElectricParameters {
    int window_cells = 32;            ///< edge of the cubic window about the tip, hexels
    double relative_residual = 1e-2;  ///< conjugate gradients stop here
    int max_iterations = 100;         ///< of a whole solve at once (electric::solve_now); runs spread theirs over ticks
    double contact_gap_m = 0.05e-3;   ///< bare metal this close to a hexel's surface carries current into it

    // The generator (electric/generator.h): constant current, then constant power, then constant voltage.
    double voltage_limit_V = 700.0;  ///< RMS, in every mode
    double current_limit_A = 2.0;    ///< RMS
    /// By GeneratorMode (cut, blend, coag): peak voltage and peak over RMS.
    std::array<double, 3> peak_voltage_V{1000.0, 1600.0, 4500.0};
    std::array<double, 3> crest_factor{1.4142135623730951, 2.5, 6.5};

    // Arcs (electric/contact.h)
    double arc_threshold_V = 200.0;       ///< peak; below, no arc strikes between metal and tissue
    double arc_field_V_per_m = 2.6e6;     ///< and this much more per metre of gas between them
    double arc_resistance_Ohm = 1000.0;   ///< of one arc to one hexel
    double arc_resistance_Ohm_per_m = 1e6;
    double arc_wire_share = 0.5;          ///< of an arc's heat (electric/contact.h)
    double arc_conductivity_S_per_m = 0.02;  ///< of a dried hexel that arcs burn through
    double char_density_kg_per_m3 = 400.0;
    double char_conductivity_S_per_m = 0.05;  ///< of what sticks to the wire
    double bare_area_m2 = 50e-6;              ///< of the wire, over which char spreads

    /// The return electrode. Far away in all directions when it has no place.
    bool return_placed = false;
    Vec3 return_m{0.0};
    double return_radius_m = 0.06;  ///< of a disc with a pad's area
};

/// Heat (section 6).
struct ThermalParameters {
    PhaseModel phase_model = PhaseModel::water_then_solids;
    int refresh_ticks = 8;                   ///< conduction is stepped every so many ticks
    double body_temperature_K = 310.15;      ///< T_0, also of arterial blood
    double gas_temperature_K = 306.15;       ///< insufflated carbon dioxide
    double gas_transfer_W_per_m2K = 20.0;    ///< h_c of faces towards gas
    double held_transfer_W_per_m2K = 500.0;  ///< h_c of faces towards the organs that hold the tissue
    double blood_density_kg_per_m3 = 1050.0;
    double blood_specific_heat_J_per_kgK = 3617.0;
    double boiling_temperature_K = 373.15;
    double threshold_temperature_K = 373.15;  ///< T_v of PhaseModel::threshold
    /// Between bare metal and wet tissue that it presses on; chosen within what is measured at soft contacts.
    double tip_transfer_W_per_m2K = 5000.0;
    /// Of the solids that turn to gas beside the wire, this share stays on it; chosen: a dissection then leaves a film
    /// of a tenth of a millimetre.
    double tip_char_share = 0.01;
};

/// Contact between instruments and tissue (section 8).
struct ContactParameters {
    double stiffness_N_per_m =
        600.0;               ///< penalty per touched hexel of 0.6 mm; softer lets a 1 mm tip slip between hexels
    double friction = 0.15;  ///< Coulomb coefficient of wet tissue on steel
};

/// A rigid organ: tissue is held where it meets one that holds, instruments collide with it, it is drawn.
struct RigidOrgan {
    std::string name;
    MaterialIndex material = kNoMaterial;  ///< for its look
    bool holds_tissue = true;
    std::shared_ptr<const anatomy::Shape> shape;
};

struct Model {
    // --- Lattices. hexels.size == m * phyxels.size; hexel (x,y,z) belongs to phyxel (x/m, y/m, z/m).
    Lattice hexels;
    Lattice phyxels;
    int hexels_per_edge = 4;  ///< m in {1, 2, 4}: m^3 hexels a phyxel fit one 64-bit occupancy word

    std::vector<Material> materials;  ///< slot 0 = none

    // --- Hexels
    Array<MaterialIndex> hexel_material;  ///< [hexels.cells] material at the start, kNoMaterial = no tissue
    BitArray hexel_initial;               ///< [hexels.cells] present at the start
    BitArray
        hexel_held;  ///< [hexels.cells] empty cells inside an organ that holds: faces towards them are held, not gas

    // --- Phyxels
    BitArray phyxel_initial;  ///< [phyxels.cells] has hexels at the start
    BitArray phyxel_ghost;    ///< [phyxels.cells] fixed cells outside the tissue (u = 0) that hold their neighbours

    std::vector<RigidOrgan> organs;

    DeformationParameters deformation;
    ElectricParameters electric;
    ThermalParameters thermal;
    ContactParameters contact;

    double tick_s = 1e-3;
    /// Period of the schedule that spreads work over ticks. At ticks that are multiples of it State is complete: a run
    /// that is saved there goes on bit for bit. In between, what is half done lies in the rooms' Work.
    static constexpr int frame_ticks = 8;

    int hexels_per_phyxel() const { return hexels_per_edge * hexels_per_edge * hexels_per_edge; }
    double hexel_volume_m3() const { return hexels.spacing_m * hexels.spacing_m * hexels.spacing_m; }
    /// Phyxel cell that owns a hexel cell.
    std::int64_t phyxel_of(const Int3& hexel) const {
        return phyxels.index(hexel.x / hexels_per_edge, hexel.y / hexels_per_edge, hexel.z / hexels_per_edge);
    }
};

}  // namespace calot::tissue
