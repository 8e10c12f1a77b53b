#pragma once
// Scene files: TOML text -> validated Scene -> simulation::Setup.
//
// Every key, with its unit, range, default and documentation, stands in one table (keys.cpp). Reading, validation,
// overrides from the command line, the documented defaults and the text kept in recordings all come from it.

#include <cstdint>
#include <string>
#include <vector>

#include "calot/anatomy/block.h"
#include "calot/anatomy/calots_triangle.h"
#include "calot/anatomy/mesh_shape.h"
#include "calot/effects/smoke.h"
#include "calot/instruments/hook.h"
#include "calot/simulation/setup.h"
#include "calot/tissue/sampling.h"

namespace calot::scene {

/// Where a piece of a scene was written: messages point there. Line 0: nowhere (a default, a program).
struct Place {
    std::string file;
    int line = 0;
    int column = 0;
};

enum class AnatomyKind { calots_triangle, block, meshes };

/// A position told relative to a landmark of the anatomy.
struct Anchor {
    std::string landmark;  ///< empty: the world's origin
    Vec3 offset_m{0.0};
    Place place;
};

struct ScriptKey {
    double time_s = 0.0;
    Anchor tip;
    double roll_rad = 0.0;
};

struct ScriptBurst {
    simulation::Burst burst;
    std::string preset = "none";  ///< a GeneratorPreset that gave mode and power
    Place place;
};

/// A tissue or an organ from a closed triangle mesh.
struct MeshEntry {
    std::string name;
    std::string file;  ///< as written: relative to the scene file
    std::string material = "fat";
    std::string role =
        "tissue";          ///< "tissue", "organ" (rigid, holds the tissue it meets), "obstacle" (rigid, holds nothing)
    double unit_m = 1e-3;  ///< length of a unit of the file
    Vec3 rotation_rad{0.0};  ///< about x, then y, then z
    Vec3 translation_m{0.0};
    std::string content;  ///< hash of the file's bytes, hexadecimal; empty: not compared
    Place place;
};

/// Something in a scene that is allowed, yet hardly meant.
struct Warning {
    Place place;
    std::string text;
};

/// How pictures are taken.
struct Picture {
    int width = 960;
    int height = 720;
    int frames_per_second = 25;
    std::string quality = "medium";
    int stills = 8;
};

struct Scene {
    Scene();  ///< all defaults

    std::string name = "unnamed";
    std::string description;

    AnatomyKind kind = AnatomyKind::calots_triangle;
    std::uint64_t seed = 1;                ///< of the patient
    anatomy::TriangleParameters triangle;  ///< its seed is the one above
    anatomy::BlockParameters block;
    std::vector<MeshEntry> meshes;

    tissue::SamplingParameters sampling;
    tissue::DeformationParameters deformation;
    tissue::ElectricParameters electric;
    tissue::ThermalParameters thermal;
    tissue::ContactParameters contact;
    effects::SmokeParameters smoke;
    std::vector<tissue::Material> materials;  ///< slot 0 = none
    std::vector<std::string> material_like;   ///< for each: the material it was derived from, empty if built in

    instruments::HookShape hook;
    Anchor trocar;
    Anchor return_electrode;
    Anchor camera_eye, camera_target;
    double field_of_view_deg = 60.0;
    Picture picture;

    double duration_s = 10.0;
    double max_memory_GB = 4.0;
    std::vector<ScriptKey> script;
    std::vector<ScriptBurst> bursts;

    std::vector<Warning> warnings;  ///< found while reading
    std::string directory;          ///< paths of meshes are relative to this
    std::string file;       ///< where it was read from
};

/// Reads a scene file, with its bases. Throws InputError; its text holds every error found, each with its line.
Scene load(const std::string& path);

/// The same from text. `name` stands for the file in messages; relative paths start at `directory`.
Scene parse(const std::string& text, const std::string& name, const std::string& directory);

/// Sets one value: "deformation.damping_per_s=60", "script.key[2].roll_deg=90". Throws InputError naming the
/// assignment.
void override_value(Scene& scene, const std::string& assignment);

/// Checks what no single key can say (order of keyframes, overlap of bursts, ...). Part of load, parse and build.
void check(const Scene& scene);

/// The anatomy alone. Throws InputError (unreadable or unusable mesh, ...). `reports`: what was found in each mesh, and
/// done about it; filled as far as it got, also when this throws.
anatomy::Anatomy build_anatomy(const Scene& scene, std::vector<anatomy::MeshReport>* reports = nullptr);

/// Everything a simulation starts from. Throws InputError, pointing into the scene file where it can.
simulation::Setup build(const Scene& scene, std::vector<anatomy::MeshReport>* reports = nullptr);

/// Memory that hexels and phyxels of such lattices take in all [bytes], an upper estimate.
std::int64_t memory_bytes(std::int64_t hexel_cells, std::int64_t phyxel_cells);

/// The scene as canonical text, every value written out: parse(text(s)) builds the same Setup, bit for bit.
std::string text(const Scene& scene);

/// A scene with every key, its default, unit, range and meaning.
std::string defaults_text();

}  // namespace calot::scene
