// What a scene is made of, without running it.

#include <array>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calot/base/error.h"
#include "calot/base/units.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/topology.h"
#include "commands.h"
#include "memory.h"

namespace calot::app {

namespace {

using Json = nlohmann::ordered_json;

struct Count {
    std::int64_t hexels = 0, phyxels = 0, links = 0;
};

/// The material that most of a phyxel's hexels have; of equals the lower index.
tissue::MaterialIndex ruling_material(const tissue::Model& model, const tissue::State& state, const Int3& phyxel) {
    std::array<int, 256> votes{};
    const int m = model.hexels_per_edge;
    for (int z = 0; z < m; ++z)
        for (int y = 0; y < m; ++y)
            for (int x = 0; x < m; ++x) {
                const std::int64_t hexel = model.hexels.index(phyxel * m + Int3(x, y, z));
                if (state.hexel_present.test(hexel)) ++votes[model.hexel_material[static_cast<std::size_t>(hexel)]];
            }
    votes[tissue::kNoMaterial] = 0;
    return static_cast<tissue::MaterialIndex>(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

/// Slot 0 of the result: links to ghosts, and ghosts among the phyxels.
std::vector<Count> count(const tissue::Model& model, const tissue::State& state, std::int64_t& mixed_links) {
    std::vector<Count> counts(model.materials.size());
    std::vector<tissue::MaterialIndex> ruling(static_cast<std::size_t>(model.phyxels.cells), tissue::kNoMaterial);
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
        if (state.hexel_present.test(h)) ++counts[model.hexel_material[static_cast<std::size_t>(h)]].hexels;
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        if (state.phyxel_present.test(p)) {
            ruling[static_cast<std::size_t>(p)] = ruling_material(model, state, model.phyxels.coordinates(p));
            ++counts[ruling[static_cast<std::size_t>(p)]].phyxels;
        } else if (model.phyxel_ghost.test(p)) {
            ++counts[0].phyxels;
        }
    }
    for (std::size_t d = 0; d < tissue::kLinkDirections.size(); ++d) {
        const std::int64_t offset = model.phyxels.offset(tissue::kLinkDirections[d]);
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
            if (!state.links[d].test(p)) continue;
            const auto a = ruling[static_cast<std::size_t>(p)], b = ruling[static_cast<std::size_t>(p + offset)];
            if (a == b)
                ++counts[a].links;
            else if (a == tissue::kNoMaterial || b == tissue::kNoMaterial)
                ++counts[0].links;
            else
                ++mixed_links;
        }
    }
    return counts;
}

Json describe(const simulation::Setup& setup) {
    const tissue::Model& model = setup.model;
    tissue::State state = tissue::State::make(model);
    const std::int64_t loose = deformation::sever_initial_links(model, state);
    std::int64_t mixed_links = 0;
    const std::vector<Count> counts = count(model, state, mixed_links);
    const double hexel_m3 = model.hexel_volume_m3();

    Json out;
    out["scene"] = setup.name;
    out["seed"] = setup.seed;
    out["duration_s"] = setup.duration_s;
    out["hexel_spacing_m"] = model.hexels.spacing_m;
    out["phyxel_spacing_m"] = model.phyxels.spacing_m;
    out["hexels"] = state.hexel_present.count();
    out["phyxels"] = state.phyxel_present.count();
    out["ghost_phyxels"] = counts[0].phyxels;
    std::int64_t links = mixed_links;
    for (const Count& c : counts) links += c.links;
    out["links"] = {{"all", links}, {"between_materials", mixed_links}, {"to_ghosts", counts[0].links}};
    out["loose_hexels_left_out"] = loose;
    double volume = 0.0, mass = 0.0;
    Json materials = Json::array();
    for (std::size_t k = 1; k < counts.size(); ++k) {
        if (counts[k].hexels == 0) continue;
        const double v = static_cast<double>(counts[k].hexels) * hexel_m3, m = v * model.materials[k].density_kg_per_m3;
        volume += v;
        mass += m;
        materials.push_back({{"name", model.materials[k].name},
                             {"hexels", counts[k].hexels},
                             {"phyxels", counts[k].phyxels},
                             {"links", counts[k].links},
                             {"volume_m3", v},
                             {"mass_kg", m},
                             {"source", model.materials[k].source}});
    }
    out["materials"] = materials;
    out["volume_m3"] = volume;
    out["mass_kg"] = mass;
    out["added_mass_kg"] = deformation::added_mass_kg(deformation::make_work(model, state));
    out["time_steps"] = {{"tick_s", model.tick_s},
                         {"deformation_s", model.tick_s / model.deformation.substeps},
                         {"deformation_substeps", model.deformation.substeps},
                         {"electric_s", model.tick_s * model.frame_ticks},
                         {"thermal_s", model.tick_s * model.thermal.refresh_ticks}};
    out["lattice_cells"] = {{"hexels", model.hexels.cells}, {"phyxels", model.phyxels.cells}};
    const MemoryUse memory = memory_use(setup, state);
    out["memory_bytes"] = {
        {"state", memory.state},
        {"model", memory.model},
        {"work", Json::object()},
        {"all", memory.all()},
        {"pictures", memory.pictures},
        {"per_hexel_cell", static_cast<double>(memory.of_hexels) / static_cast<double>(model.hexels.cells)},
        {"per_phyxel_cell", static_cast<double>(memory.of_phyxels) / static_cast<double>(model.phyxels.cells)},
        {"limit_of_lattices", scene::memory_bytes(model.hexels.cells, model.phyxels.cells)}};
    for (const auto& [room, bytes] : memory.work_of_rooms) out["memory_bytes"]["work"][room] = bytes;
    Json organs = Json::array();
    for (const auto& organ : model.organs)
        organs.push_back({{"name", organ.name}, {"holds_tissue", organ.holds_tissue}});
    out["organs"] = organs;
    Json facts = Json::object();
    for (const auto& [name, value] : setup.anatomy.facts) facts[name] = value;
    out["facts"] = facts;
    Json landmarks = Json::object();
    for (const auto& [name, p] : setup.anatomy.landmarks_m) landmarks[name] = {p.x, p.y, p.z};
    out["landmarks_m"] = landmarks;
    return out;
}

/// 147233 -> "147,233"
std::string grouped(std::int64_t number) {
    std::string text = fmt::format("{}", number);
    for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
    return text;
}

void print_row(const std::string& label, const std::string& value) {
    fmt::print("  {:<26}{}\n", label, value);
}

void print_text(const Json& j) {
    fmt::print("{}  (seed {}, {:g} s)\n\n", j["scene"].get<std::string>(), j["seed"].get<std::uint64_t>(),
               j["duration_s"].get<double>());
    fmt::print("  {:<20}{:>12}{:>10}{:>10}{:>14}{:>12}\n", "tissue", "hexels", "phyxels", "links", "volume ml",
               "mass g");
    for (const Json& m : j["materials"])
        fmt::print("  {:<20}{:>12}{:>10}{:>10}{:>14.3f}{:>12.3f}\n", m["name"].get<std::string>(), grouped(m["hexels"]),
                   grouped(m["phyxels"]), grouped(m["links"]), m["volume_m3"].get<double>() * 1e6,
                   m["mass_kg"].get<double>() * 1e3);
    fmt::print("  {:<20}{:>12}{:>10}{:>10}{:>14.3f}{:>12.3f}\n\n", "all", grouped(j["hexels"]), grouped(j["phyxels"]),
               grouped(j["links"]["all"]), j["volume_m3"].get<double>() * 1e6, j["mass_kg"].get<double>() * 1e3);
    print_row("spacing", fmt::format("hexels {:g} mm, phyxels {:g} mm", j["hexel_spacing_m"].get<double>() * 1e3,
                                     j["phyxel_spacing_m"].get<double>() * 1e3));
    print_row("links across tissues", grouped(j["links"]["between_materials"]));
    print_row("held by",
              fmt::format("{} ghost phyxels, {} links", grouped(j["ghost_phyxels"]), grouped(j["links"]["to_ghosts"])));
    print_row("loose, left out", fmt::format("{} hexels", grouped(j["loose_hexels_left_out"])));
    print_row("added mass", fmt::format("{:.3g} g ({:.0f} % of the tissue), to keep stiff and light phyxels stable",
                                        j["added_mass_kg"].get<double>() * 1e3,
                                        100.0 * j["added_mass_kg"].get<double>() / j["mass_kg"].get<double>()));
    const Json& t = j["time_steps"];
    print_row("time steps", fmt::format("tick {:g} ms, deformation {:.4g} ms, electric {:g} ms, heat {:g} ms",
                                        t["tick_s"].get<double>() * 1e3, t["deformation_s"].get<double>() * 1e3,
                                        t["electric_s"].get<double>() * 1e3, t["thermal_s"].get<double>() * 1e3));
    print_row("lattices", fmt::format("{} cells of hexels, {} of phyxels", grouped(j["lattice_cells"]["hexels"]),
                                      grouped(j["lattice_cells"]["phyxels"])));
    const Json& memory = j["memory_bytes"];
    print_row("memory",
              fmt::format("{:.1f} MB: {:.0f} bytes a cell of hexels, {:.0f} of phyxels; pictures {:.1f} MB more",
                          memory["all"].get<double>() / 1e6, memory["per_hexel_cell"].get<double>(),
                          memory["per_phyxel_cell"].get<double>(), memory["pictures"].get<double>() / 1e6));
    if (!j["organs"].empty()) {
        std::string organs;
        for (const Json& organ : j["organs"]) organs += (organs.empty() ? "" : ", ") + organ["name"].get<std::string>();
        print_row("rigid organs", organs);
    }
    if (!j["facts"].empty()) fmt::print("\n  this patient\n");
    for (const auto& [name, value] : j["facts"].items()) print_row(name, fmt::format("{:.4g}", value.get<double>()));
    fmt::print("\n  landmarks, mm\n");
    for (const auto& [name, p] : j["landmarks_m"].items())
        print_row(name, fmt::format("{:8.2f} {:8.2f} {:8.2f}", p[0].get<double>() * 1e3, p[1].get<double>() * 1e3,
                                    p[2].get<double>() * 1e3));
}

}  // namespace

namespace {

/// One line a device, or as JSON.
void list_devices(bool as_json) {
    const std::vector<gpu::DeviceInfo> all = gpu::devices();
    Json list = Json::array();
    for (const gpu::DeviceInfo& d : all)
        list.push_back({{"device", list.size()},
                        {"api", d.api == gpu::Api::cuda ? "CUDA" : "OpenCL"},
                        {"name", d.name},
                        {"vendor", d.vendor},
                        {"version", d.version},
                        {"memory_bytes", d.memory_bytes},
                        {"compute_units", d.compute_units},
                        {"is_gpu", d.is_gpu}});
    if (as_json) {
        fmt::print("{}\n", list.dump(2, ' ', false, Json::error_handler_t::replace));
        return;
    }
    if (list.empty()) fmt::print("no driver of OpenCL or CUDA offers a device; the CPU computes\n");
    for (const Json& d : list)
        fmt::print("{:>3}  {:<7}{}  {}\n            {}, {} compute units, {} MB{}\n", d["device"].get<std::size_t>(),
                   d["api"].get<std::string>(), d["name"].get<std::string>(), d["vendor"].get<std::string>(),
                   d["version"].get<std::string>(), d["compute_units"].get<int>(),
                   d["memory_bytes"].get<std::uint64_t>() >> 20,
                   d["is_gpu"].get<bool>() ? "" : "; not a GPU: --backend auto does not take it");
}

}  // namespace

int inspect(const InspectOptions& options) {
    if (options.devices) {
        list_devices(options.json);
        return kDone;
    }
    if (options.scene.path.empty())
        throw InputError("there is no scene to inspect", "name one, or list devices with --devices");
    const simulation::Setup setup = build_setup(load_scene(options.scene));
    const Json description = describe(setup);
    if (options.json)
        fmt::print("{}\n", description.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        print_text(description);
    return kDone;
}

}  // namespace calot::app
