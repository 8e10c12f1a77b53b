// calot materials: what tissues are made of, and where the numbers come from.

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calot/base/error.h"
#include "calot/scene/suggest.h"
#include "calot/tissue/material.h"
#include "commands.h"

namespace calot::app {

namespace {

using tissue::Material;
using tissue::MaterialField;

std::vector<Material> chosen_materials(const std::string& name) {
    std::vector<Material> all = tissue::default_materials();
    all.erase(all.begin());  // "none"
    if (name.empty()) return all;
    std::vector<std::string> names;
    for (const Material& material : all) {
        if (material.name == name) return {material};
        names.push_back(material.name);
    }
    const std::string near = scene::closest(name, names);
    throw InputError("there is no tissue \"" + name + "\"",
                     near.empty() ? "tissues: " + scene::join(names) : "did you mean \"" + near + "\"?");
}

std::string number(double value) {
    return value != 0.0 && (value >= 1e6 || value < 1e-3) ? fmt::format("{:.4g}", value) : fmt::format("{:g}", value);
}

void print_material(const Material& material, std::set<std::string>& cited) {
    fmt::print("{}\n", material.name);
    for (const MaterialField& field : tissue::material_fields()) {
        const std::string source = tissue::material_source(material, field);
        cited.insert(source);
        fmt::print("  {:<39} {:>10} {:<12} {:<20} [{}]\n", field.key, number(field.value(material)), field.unit,
                   fmt::format("{} to {}", number(field.low), number(field.high)), source);
    }
    fmt::print("\n");
}

std::string json_of(const std::vector<Material>& materials) {
    using Json = nlohmann::ordered_json;
    Json j, list = Json::array(), references;
    for (const Material& material : materials) {
        Json values;
        for (const MaterialField& field : tissue::material_fields())
            values[field.key] = {{"value", field.value(material)},
                                 {"unit", field.unit},
                                 {"low", field.low},
                                 {"high", field.high},
                                 {"meaning", field.meaning},
                                 {"source", tissue::material_source(material, field)}};
        list.push_back({{"name", material.name}, {"values", values}});
    }
    for (const tissue::Reference& reference : tissue::material_references()) references[reference.key] = reference.text;
    j["materials"] = list;
    j["references"] = references;
    return j.dump(2);
}

}  // namespace

int materials(const MaterialsOptions& options) {
    const std::vector<Material> chosen = chosen_materials(options.name);
    if (options.json) {
        fmt::print("{}\n", json_of(chosen));
        return kDone;
    }
    fmt::print(
        "Values that scenes may override in [materials.NAME], units, plausible ranges of soft tissue, sources.\n\n");
    std::set<std::string> cited;
    for (const Material& material : chosen) print_material(material, cited);
    fmt::print("meaning\n");
    for (const MaterialField& field : tissue::material_fields()) fmt::print("  {:<39} {}\n", field.key, field.meaning);
    fmt::print("\nsources\n");
    for (const tissue::Reference& reference : tissue::material_references())
        if (cited.count(reference.key) > 0) fmt::print("  [{}] {}\n", reference.key, reference.text);
    return kDone;
}

}  // namespace calot::app
