#include "calot/scene/keys.h"

#include <cstdlib>

#include <fmt/format.h>

#include "calot/scene/keys_build.h"

// clang-format off: a table, one key after the other
namespace calot::scene {

namespace {

Group scene_group() {
    Group group{"scene", "base = \"other.toml\" starts from another scene instead of the defaults.", {}, {}};
    KeyTable<Scene> t(group);
    t.text("name", [](Scene& s) -> auto& { return s.name; }, "Name of the scene, for people.");
    t.text("description", [](Scene& s) -> auto& { return s.description; }, "What the scene is for, in a sentence.");
    return group;
}

Group anatomy_group() {
    Group group{"anatomy", "Which tissue lies in the operating field.", {}, {}};
    KeyTable<Scene> t(group);
    t.choice("kind", {"calots_triangle", "block", "meshes"}, [](Scene& s) -> auto& { return s.kind; },
      "A parametric patient, a plain block, or your own closed triangle meshes.");
    t.integer("seed", kNoUnit, 0, 9e18, [](Scene& s) -> auto& { return s.seed; },
      "Every seed is another patient. `calot simulate --seed N` sets it, too.");
    return group;
}

Group block_group() {
    Group group{"block", "The block, where anatomy.kind = \"block\": its top in the plane z = 0.", {}, {}};
    KeyTable<Scene> t(group);
    t.vector("size_mm", kMm, 0.2, 500, [](Scene& s) -> auto& { return s.block.size_m; }, "Edges along x, y and z.");
    t.text("material", [](Scene& s) -> auto& { return s.block.material; }, "Name of a material, see [materials].");
    t.boolean("held_below", [](Scene& s) -> auto& { return s.block.held_below; }, "Whether a rigid slab holds it.");
    return group;
}

Group mesh_group() {
    Group group{
        "mesh",
        "A tissue or organ from a closed triangle mesh (STL, OBJ, PLY, glTF), where anatomy.kind = \"meshes\".\n"
        "Any number of [[mesh]] tables; where tissues overlap, the last one wins.",
        {},
        {}};
    using M = MeshEntry;
    KeyTable<M> t(group);
    t.text("file", [](M& m) -> auto& { return m.file; }, "Path, relative to the scene file.").required = true;
    t.text("name", [](M& m) -> auto& { return m.name; }, "Name for people; empty: that of the file.");
    t.text("material", [](M& m) -> auto& { return m.material; }, "Name of a material, see [materials].");
    t.word("role", {"tissue", "organ", "obstacle"}, [](M& m) -> auto& { return m.role; },
      "Deformable tissue, a rigid organ that holds the tissue it meets, or a rigid obstacle that holds nothing.");
    t.number("unit_mm", kMm, 1e-6, 1e6, [](M& m) -> auto& { return m.unit_m; },
      "Millimetres that a unit of the file's coordinates stands for.");
    t.vector("rotation_deg", kDegree, -360, 360, [](M& m) -> auto& { return m.rotation_rad; },
      "Turned about x, then y, then z, before it is moved.");
    t.vector("translation_mm", kMm, -1000, 1000, [](M& m) -> auto& { return m.translation_m; }, "Then moved by this.");
    t.text("content", [](M& m) -> auto& { return m.content; },
      "Hash of the file (recordings hold it): the scene is refused when the file has changed. Empty: not checked.");
    group.records = Group::Records{[](const Scene& s) { return s.meshes.size(); }, [](Scene& s) { s.meshes.clear(); },
                                   [](Scene& s, const Place& place) -> void* {
                                       s.meshes.emplace_back().place = place;
                                       return &s.meshes.back();
                                   },
                                   [](Scene& s, std::size_t k) -> void* { return &s.meshes[k]; }};
    return group;
}

Group sampling_group() {
    Group group{
        "sampling", "How finely tissue is divided: hexels hold heat, phyxels (cubes of hexels) deform.", {}, {}};
    KeyTable<Scene> t(group);
    t.number("hexel_spacing_mm", kMm, 0.05, 10, [](Scene& s) -> auto& { return s.sampling.hexel_spacing_m; },
      "Edge of a hexel. Half of it makes eight times as many.");
    t.integer("hexels_per_edge", kNoUnit, 1, 4, [](Scene& s) -> auto& { return s.sampling.hexels_per_edge; },
      "Hexels along the edge of a phyxel: 1, 2 or 4.");
    return group;
}

Group hook_group() {
    Group group{
        "hook", "The electro-hook: an insulated shaft through a trocar, a bare L-shaped wire at its end.", {}, {}};
    KeyTable<Scene> t(group);
    t.number("shaft_diameter_mm", kMm, 1, 20, [](Scene& s) -> auto& { return s.hook.shaft_diameter_m; }, "");
    t.number("shaft_length_mm", kMm, 50, 600, [](Scene& s) -> auto& { return s.hook.shaft_length_m; }, "");
    t.number("wire_diameter_mm", kMm, 0.2, 5, [](Scene& s) -> auto& { return s.hook.wire_diameter_m; }, "");
    t.number("heel_length_mm", kMm, 1, 50, [](Scene& s) -> auto& { return s.hook.heel_length_m; },
      "Along the shaft, from its end to the bend.");
    t.number("foot_length_mm", kMm, 1, 30, [](Scene& s) -> auto& { return s.hook.foot_length_m; },
      "Across, from the bend to the tip.");
    t.number("insulated_heel_mm", kMm, 0, 50, [](Scene& s) -> auto& { return s.hook.insulated_heel_m; },
      "Part of the heel that is insulated as well.");
    t.text("trocar", [](Scene& s) -> auto& { return s.trocar.landmark; },
      "Landmark about which the shaft pivots; empty: the origin.");
    t.vector("trocar_offset_mm", kMm, -500, 500, [](Scene& s) -> auto& { return s.trocar.offset_m; },
      "The pivot, from that landmark: x to the patient's left, y cranial, z anterior.");
    return group;
}

Group camera_group() {
    Group group{"camera", "The laparoscope.", {}, {}};
    KeyTable<Scene> t(group);
    t.text("eye", [](Scene& s) -> auto& { return s.camera_eye.landmark; }, "Landmark; empty: the origin.");
    t.vector("eye_offset_mm", kMm, -500, 500, [](Scene& s) -> auto& { return s.camera_eye.offset_m; },
      "Where the lens is, from that landmark.");
    t.text("target", [](Scene& s) -> auto& { return s.camera_target.landmark; }, "Landmark; empty: the origin.");
    t.vector("target_offset_mm", kMm, -500, 500, [](Scene& s) -> auto& { return s.camera_target.offset_m; },
      "What it looks at, from that landmark.");
    t.number("field_of_view_deg", named("degrees"), 10, 120, [](Scene& s) -> auto& { return s.field_of_view_deg; },
      "Across the round image.");
    return group;
}

Group picture_group() {
    Group group{"picture", "Stills and video.", {}, {}};
    KeyTable<Scene> t(group);
    t.integer("width", named("pixels"), 64, 4096, [](Scene& s) -> auto& { return s.picture.width; }, "An even number.");
    t.integer("height", named("pixels"), 64, 4096, [](Scene& s) -> auto& { return s.picture.height; },
      "An even number.");
    t.integer("frames_per_second", named("1/s"), 1, 120, [](Scene& s) -> auto& { return s.picture.frames_per_second; },
      "Of the video.");
    t.word("quality", {"low", "medium", "high"}, [](Scene& s) -> auto& { return s.picture.quality; }, "");
    t.integer("stills", kNoUnit, 0, 200, [](Scene& s) -> auto& { return s.picture.stills; },
      "Single pictures, evenly over the run; the report shows them.");
    return group;
}

Group run_group() {
    Group group{"run", "", {}, {}};
    KeyTable<Scene> t(group);
    t.number("duration_s", kSecond, 0.001, 3600, [](Scene& s) -> auto& { return s.duration_s; }, "Simulated time.");
    t.number("max_memory_GB", named("GB"), 0.01, 4096, [](Scene& s) -> auto& { return s.max_memory_GB; },
      "Scenes that would need more are refused before they fill the machine.");
    return group;
}

Group script_key_group() {
    Group group{
        "script.key",
        "The hand: where the middle of the hook's foot is at a time. The way between is smooth; before the first\n"
        "and after the last it rests.",
        {},
        {}};
    using K = ScriptKey;
    KeyTable<K> t(group);
    t.number("t", kSecond, 0, 3600, [](K& k) -> auto& { return k.time_s; },
      "Time, later than the key before.").required = true;
    t.text("at", [](K& k) -> auto& { return k.tip.landmark; },
      "Landmark (`calot inspect` lists them); empty: the origin.");
    t.vector("offset_mm", kMm, -500, 500, [](K& k) -> auto& { return k.tip.offset_m; },
      "From that landmark: x to the patient's left, y cranial, z anterior.");
    t.number("roll_deg", kDegree, -720, 720, [](K& k) -> auto& { return k.roll_rad; },
      "Turn about the shaft; at 0 the foot points down.");
    group.records = Group::Records{[](const Scene& s) { return s.script.size(); }, [](Scene& s) { s.script.clear(); },
                                   [](Scene& s, const Place& place) -> void* {
                                       s.script.emplace_back().tip.place = place;
                                       return &s.script.back();
                                   },
                                   [](Scene& s, std::size_t k) -> void* { return &s.script[k]; }};
    return group;
}

Group script_burst_group() {
    Group group{"script.burst", "The foot: from when to when the pedal is down.", {}, {}};
    using B = ScriptBurst;
    KeyTable<B> t(group);
    t.number("from", kSecond, 0, 3600, [](B& b) -> auto& { return b.burst.from_s; }, "").required = true;
    t.number("to", kSecond, 0, 3600, [](B& b) -> auto& { return b.burst.to_s; }, "").required = true;
    std::vector<std::string> presets{"none"};
    for (const tissue::GeneratorPreset& preset : tissue::kGeneratorPresets) presets.emplace_back(preset.name);
    Key& preset = t.word("preset", presets, [](B& b) -> auto& { return b.preset; },
      "A usual setting of mode and power; the two keys below override it.");
    preset.set = [](void* record, const Value& value) {
        B& b = *static_cast<B*>(record);
        b.preset = std::get<std::string>(value);
        for (const tissue::GeneratorPreset& known : tissue::kGeneratorPresets)
            if (b.preset == known.name) {
                b.burst.mode = known.mode;
                b.burst.power_W = known.power_W;
            }
    };
    t.number("power_W", named("W"), 0.1, 300, [](B& b) -> auto& { return b.burst.power_W; },
      "The generator's setting.");
    t.choice("mode", {"cut", "blend", "coag"}, [](B& b) -> auto& { return b.burst.mode; }, "");
    t.boolean("wiped", [](B& b) -> auto& { return b.burst.wiped; }, "The hook is wiped clean of char just before.");
    group.records = Group::Records{[](const Scene& s) { return s.bursts.size(); }, [](Scene& s) { s.bursts.clear(); },
                                   [](Scene& s, const Place& place) -> void* {
                                       s.bursts.emplace_back().place = place;
                                       return &s.bursts.back();
                                   },
                                   [](Scene& s, std::size_t k) -> void* { return &s.bursts[k]; }};
    return group;
}

}  // namespace

std::vector<Group> physics_groups();  // keys_physics.cpp

std::vector<Group> groups(const Scene& scene) {
    std::vector<Group> all{scene_group(), anatomy_group(), triangle_group(), block_group(), sampling_group()};
    for (Group& group : physics_groups()) all.push_back(std::move(group));
    all.push_back(hook_group());
    all.push_back(camera_group());
    all.push_back(picture_group());
    all.push_back(run_group());
    for (std::size_t k = 1; k < scene.materials.size(); ++k) all.push_back(material_group(scene.materials[k].name, k));
    all.push_back(mesh_group());
    all.push_back(script_key_group());
    all.push_back(script_burst_group());
    return all;
}

double file_value(double si, const Unit& unit) {
    const double inverse = (si - unit.offset) / unit.factor;
    for (int digits = 1; digits <= 17; ++digits) {
        const double value = std::strtod(fmt::format("{:.{}g}", inverse, digits).c_str(), nullptr);
        if (unit.to_si(value) == si) return value;
    }
    // The inverse is a last digit off: one of its neighbours is the file's value, if the SI value came from a file.
    double below = inverse, above = inverse;
    for (int step = 0; step < 16; ++step) {
        below = std::nextafter(below, -1e300);
        above = std::nextafter(above, 1e300);
        if (unit.to_si(below) == si) return below;
        if (unit.to_si(above) == si) return above;
    }
    return inverse;
}

std::string describe_expected(const Key& key) {
    const std::string unit = *key.unit.name ? fmt::format(" {}", key.unit.name) : std::string();
    switch (key.type) {
        case KeyType::boolean:
            return "true or false";
        case KeyType::integer:
            return fmt::format("a whole number from {:g} to {:g}{}", key.low, key.high, unit);
        case KeyType::number:
            return fmt::format("a number from {:g} to {:g}{}", key.low, key.high, unit);
        case KeyType::vector:
            return fmt::format("three numbers [x, y, z], each from {:g} to {:g}{}", key.low, key.high, unit);
        case KeyType::text:
            return "text in quotes";
        case KeyType::choice: {
            std::string words;
            for (const std::string& choice : key.choices) words += (words.empty() ? "\"" : ", \"") + choice + "\"";
            return "one of " + words;
        }
    }
    return "";
}

}  // namespace calot::scene
