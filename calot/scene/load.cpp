// Files, bases and overrides.

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "calot/scene/read.h"
#include "calot/scene/suggest.h"

namespace calot::scene {

namespace {

constexpr std::size_t kMaxFileBytes = 4u << 20;

std::string read_text(const std::string& path, const Place& asked_by) {
    namespace fs = std::filesystem;
    std::error_code error;
    auto fail = [&](const std::string& why, const std::string& hint) {
        if (asked_by.line > 0) throw InputError(asked_by.file, asked_by.line, asked_by.column, why + ": " + path, hint);
        throw InputError(path, 0, 0, why, hint);
    };
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) {
        std::vector<std::string> beside;
        const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
        for (const auto& entry : fs::directory_iterator(folder, error))
            if (entry.path().extension() == ".toml") beside.push_back(entry.path().filename().string());
        std::sort(beside.begin(), beside.end());
        const std::string near = closest(fs::path(path).filename().string(), beside);
        fail("there is no such scene file",
             near.empty() ? "scenes that come with Calot are in scenes/"
                          : fmt::format("did you mean {}?", (folder / near).lexically_normal().string()));
    }
    if (fs::is_directory(status)) fail("this is a directory, not a scene file", "name a .toml file in it");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail(fmt::format("cannot read the scene file ({})", std::strerror(errno)), "check its permissions");
    std::string text(kMaxFileBytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad()) fail("cannot read the scene file", "check its disk");
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > kMaxFileBytes)
        fail("this is too large for a scene file (more than 4 MB)",
             "scenes are short TOML files; meshes stay in files of their own");
    return text;
}

toml::table parse_toml(const std::string& text, const std::string& name) {
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        throw InputError(
            name, static_cast<int>(error.source().begin.line), static_cast<int>(error.source().begin.column),
            fmt::format("this is not TOML: {}", error.description()), "https://toml.io shows the format in a page");
    }
}

void read_file(const std::string& path, const Place& asked_by, std::vector<std::string> chain, Scene& scene,
               Problems& problems);

/// The document's base first, then itself.
void read_with_bases(const std::string& text, const std::string& name, const std::string& directory,
                     std::vector<std::string> chain, Scene& scene, Problems& problems) {
    const toml::table document = parse_toml(text, name);
    if (const toml::node* base = document.at_path("scene.base").node()) {
        const Place place{name, static_cast<int>(base->source().begin.line),
                          static_cast<int>(base->source().begin.column)};
        if (!base->is_string())
            problems.add(place, "'scene.base' is no text", "give the path of a scene in quotes, relative to this one");
        else
            read_file(resolve_path(*base->value<std::string>(), directory), place, std::move(chain), scene, problems);
    }
    read_document(document, name, directory, scene, problems);
}

void read_file(const std::string& path, const Place& asked_by, std::vector<std::string> chain, Scene& scene,
               Problems& problems) {
    std::error_code error;
    const std::string canonical = std::filesystem::weakly_canonical(path, error).string();
    if (std::find(chain.begin(), chain.end(), canonical) != chain.end()) {
        chain.push_back(canonical);
        std::string round;
        for (const std::string& link : chain)
            round += (round.empty() ? "" : " -> ") + std::filesystem::path(link).filename().string();
        throw InputError(asked_by.file, asked_by.line, asked_by.column, "a scene cannot be its own base: " + round,
                         "remove one 'scene.base'");
    }
    if (chain.size() > 16)
        throw InputError(asked_by.file, asked_by.line, asked_by.column, "more than 16 bases on top of one another",
                         "flatten them");
    chain.push_back(canonical);
    const std::string text = read_text(path, asked_by);
    read_with_bases(text, path, std::filesystem::path(path).parent_path().string(), std::move(chain), scene, problems);
}

/// "script.key[2].roll_deg" -> group "script.key", index 2, key "roll_deg".
struct KeyPath {
    std::string group, key;
    int index = -1;
};

KeyPath split(const std::string& path) {
    KeyPath parts;
    const std::size_t dot = path.rfind('.');
    parts.group = dot == std::string::npos ? "" : path.substr(0, dot);
    parts.key = dot == std::string::npos ? path : path.substr(dot + 1);
    const std::size_t bracket = parts.group.find('[');
    if (bracket != std::string::npos && parts.group.back() == ']') {
        const std::string digits = parts.group.substr(bracket + 1, parts.group.size() - bracket - 2);
        if (!digits.empty() && digits.size() < 7 && digits.find_first_not_of("0123456789") == std::string::npos)
            parts.index = std::stoi(digits);
        parts.group.resize(bracket);
    }
    return parts;
}

/// The value of an assignment as TOML; plain words stand for text.
std::optional<Value> read_assigned(const Key& key, const std::string& path, const std::string& value,
                                   const Place& place, Problems& problems) {
    toml::table parsed;
    bool whole = true;
    try {
        parsed = toml::parse("value = " + value);
        whole = parsed.size() == 1;
    } catch (const toml::parse_error&) {
        whole = false;
    }
    const bool wants_text = key.type == KeyType::text || key.type == KeyType::choice;
    if (wants_text && !(whole && parsed.get("value")->is_string())) {
        parsed = toml::table{{"value", value}};
    } else if (!whole) {
        problems.add(place, fmt::format("'{}' is not a value", value), "give " + describe_expected(key));
        return std::nullopt;
    }
    return read_value(key, *parsed.get("value"), path, place, problems);
}

std::string full_path(const Group& group, const Key& key) {
    return group.path.empty() ? key.name : group.path + (group.records ? "[0]." : ".") + key.name;
}

}  // namespace

Scene load(const std::string& path) {
    Scene scene;
    Problems problems;
    read_file(path, {}, {}, scene, problems);
    problems.throw_if_any();
    scene.file = path;
    check(scene);
    return scene;
}

Scene parse(const std::string& text, const std::string& name, const std::string& directory) {
    Scene scene;
    Problems problems;
    read_with_bases(text, name, directory, {}, scene, problems);
    problems.throw_if_any();
    scene.file = name;
    check(scene);
    return scene;
}

void override_value(Scene& scene, const std::string& assignment) {
    const Place place{"--set " + assignment, 0, 0};
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError(place.file, 0, 0, "this sets nothing",
                         "write --set key.path=value, as in --set deformation.damping_per_s=60");
    const std::string path = assignment.substr(0, equals), value = assignment.substr(equals + 1);
    const KeyPath parts = split(path);
    Problems problems;
    std::vector<std::string> all;
    for (const Group& group : groups(scene))
        for (const Key& key : group.keys) {
            all.push_back(full_path(group, key));
            if (group.path != parts.group || key.name != parts.key) continue;
            void* record = &scene;
            if (group.records) {
                const std::size_t size = group.records->size(scene);
                if (parts.index < 0 || static_cast<std::size_t>(parts.index) >= size)
                    throw InputError(place.file, 0, 0,
                                     parts.index < 0
                                         ? fmt::format("which of the {} tables [[{}]]?", size, group.path)
                                         : fmt::format("the scene has only {} tables [[{}]]", size, group.path),
                                     fmt::format("count from 0: --set {}[0].{}=...", group.path, key.name));
                record = group.records->at(scene, static_cast<std::size_t>(parts.index));
            } else if (parts.index >= 0) {
                throw InputError(place.file, 0, 0, fmt::format("[{}] is a single table", group.path),
                                 "leave the brackets out");
            }
            if (const auto read = read_assigned(key, path, value, place, problems)) {
                key.set(record, *read);
                if (group.path == "mesh")
                    static_cast<MeshEntry*>(record)->file = resolve_path(static_cast<MeshEntry*>(record)->file, "");
            }
            problems.throw_if_any();
            return;
        }
    const std::string near = closest(path, all);
    throw InputError(
        place.file, 0, 0, fmt::format("unknown key '{}'", path),
        (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) + "`calot scene --defaults` shows every key");
}

}  // namespace calot::scene
