// A scene as text: canonical for recordings, documented for people.

#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "calot/base/hash.h"
#include "calot/scene/keys.h"
#include "calot/scene/mesh_file.h"

namespace calot::scene {

namespace {

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
        else
            out += c;
    }
    return out + "\"";
}

std::string toml_text(const Value& value) {
    struct Visitor {
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
        std::string operator()(double v) const { return fmt::format("{}", v); }
        std::string operator()(const std::string& v) const { return quoted(v); }
        std::string operator()(const Vec3& v) const { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }
    };
    return std::visit(Visitor{}, value);
}

std::string header(const Group& group) {
    if (group.path.empty()) return "";
    return group.records ? fmt::format("[[{}]]\n", group.path) : fmt::format("[{}]\n", group.path);
}

void append_values(std::string& out, const Group& group, const void* record) {
    out += header(group);
    for (const Key& key : group.keys)
        if (const auto value = key.get(record)) out += fmt::format("{} = {}\n", key.name, toml_text(*value));
}

std::string comment(const std::string& text) {
    std::string out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) out += "# " + line + "\n";
    return out;
}

/// "0.05 to 10 mm", "\"cut\", \"blend\", \"coag\"" or nothing.
std::string range_of(const Key& key) {
    const std::string unit = *key.unit.name ? fmt::format(" {}", key.unit.name) : std::string();
    switch (key.type) {
        case KeyType::integer:
        case KeyType::number:
        case KeyType::vector:
            return fmt::format("{:g} to {:g}{}", key.low, key.high, unit);
        case KeyType::choice: {
            std::string words;
            for (const std::string& choice : key.choices) words += (words.empty() ? "\"" : ", \"") + choice + "\"";
            return words;
        }
        default:
            return "";
    }
}

/// A key with its documentation above. Keys without a default are commented out.
void append_documented(std::string& out, const Key& key, const void* record, const std::string& in_front) {
    const std::string range = range_of(key);
    const auto value = key.get(record);
    std::string text = key.documentation;
    if (!value) text += " Not given: drawn from the seed.";
    if (!range.empty()) text += (text.empty() ? "" : "  ") + fmt::format("({})", range);
    if (!text.empty()) out += comment(text);
    if (value)
        out += fmt::format("{}{} = {}\n", in_front, key.name, toml_text(*value));
    else
        out += fmt::format("# {} = {}\n", key.name,
                           key.type == KeyType::boolean ? "false" : fmt::format("{:g}", 0.5 * (key.low + key.high)));
}

}  // namespace

std::string text(const Scene& scene) {
    Scene complete = scene;
    for (MeshEntry& mesh : complete.meshes)
        if (mesh.content.empty()) mesh.content = content_of_file(mesh.file);
    std::string out;
    for (const Group& group : groups(complete)) {
        if (group.records) {
            const std::size_t size = group.records->size(complete);
            // An empty array cannot be told from the default by leaving it out.
            for (std::size_t k = 0; k < size; ++k) append_values(out, group, group.records->at(complete, k));
            continue;
        }
        append_values(out, group, &complete);
        if (group.path.rfind("materials.", 0) == 0) {
            const auto index = tissue::find_material(complete.materials, group.path.substr(10));
            if (!complete.material_like[index].empty())
                out += fmt::format("like = {}\n", quoted(complete.material_like[index]));
        }
    }
    return out;
}

std::string defaults_text() {
    Scene scene;
    std::string out = comment("Every key of a scene with its default. Leave out what you do not change.") + "\n";
    MeshEntry example;
    example.file = "organ.stl";
    const std::vector<Group> all = groups(scene);
    for (const Group& group : all) {
        if (&group != &all.front()) out += "\n";
        out += comment(group.documentation);
        const bool absent = group.records && group.records->size(scene) == 0;
        const std::string in_front = absent ? "# " : "";
        const void* record = group.path == "mesh" ? &example : static_cast<const void*>(&scene);
        ScriptBurst burst;
        burst.burst.to_s = 1.0;
        if (group.path == "script.burst") record = &burst;
        ScriptGrasperKey grasp;
        if (group.path == "script.grasper") record = &grasp;
        if (group.records && !absent) record = group.records->at(scene, 0);
        if (group.path == "materials.fat")
            out += comment(
                "Tissues. A new one starts from another: [materials.tumour], like = \"fat\", then what differs.");
        out += in_front + header(group);
        for (const Key& key : group.keys) append_documented(out, key, record, in_front);
    }
    return out;
}

}  // namespace calot::scene
