#include "calot/scene/read.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "calot/scene/suggest.h"

namespace calot::scene {

namespace {

Place place_of(const toml::source_region& source, const std::string& file) {
    return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

std::string kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "text";
        case toml::node_type::integer:
            return "a whole number";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        default:
            return "a date or time";
    }
}

std::string join_path(const std::string& path, const std::string& name) {
    return path.empty() ? name : path + "." + name;
}

/// Within the key's range and finite, or a problem.
bool in_range(const Key& key, double value, const std::string& path, const Place& place, Problems& problems) {
    if (!std::isfinite(value)) {
        problems.add(place, fmt::format("'{}' is not finite", path), "give " + describe_expected(key));
        return false;
    }
    if (value < key.low || value > key.high) {
        problems.add(place, fmt::format("'{}' is {:g}, out of range", path, value), "give " + describe_expected(key));
        return false;
    }
    return true;
}

std::optional<double> number_of(const toml::node& node) {
    if (!node.is_number()) return std::nullopt;
    return node.value<double>();
}

std::optional<Value> read_choice(const Key& key, const std::string& word, const std::string& path, const Place& place,
                                 Problems& problems) {
    for (const std::string& choice : key.choices)
        if (choice == word) return Value(word);
    const std::string near = closest(word, key.choices);
    problems.add(place, fmt::format("'{}' is \"{}\", which it cannot be", path, word),
                 (near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near)) + "give " + describe_expected(key));
    return std::nullopt;
}

std::optional<Value> read_vector(const Key& key, const toml::array& array, const std::string& path, const Place& place,
                                 Problems& problems) {
    Vec3 vector(0.0);
    for (int c = 0; c < 3; ++c) {
        const auto number = number_of(array[static_cast<std::size_t>(c)]);
        if (!number) {
            problems.add(place, fmt::format("'{}' holds {}", path, kind_of(array[static_cast<std::size_t>(c)])),
                         "give " + describe_expected(key));
            return std::nullopt;
        }
        if (!in_range(key, *number, path, place, problems)) return std::nullopt;
        vector[c] = *number;
    }
    return Value(vector);
}

class DocumentReader {
  public:
    DocumentReader(Scene& scene, const std::string& file, const std::string& directory, Problems& problems)
        : scene_(scene), file_(file), directory_(directory), problems_(problems), groups_(groups(scene)) {}

    void read_table(const toml::table& table, const std::string& path) {
        for (auto&& [key, node] : table) {
            const std::string name(key.str());
            const std::string full = join_path(path, name);
            if (full == "scene.base") continue;  // done already: see load.cpp
            if (full == "materials") {
                if (const toml::table* materials = expect_table(node, full)) read_materials(*materials);
            } else if (const Group* group = find_group(full)) {
                if (group->records) {
                    read_records(*group, node);
                } else if (const toml::table* inner = expect_table(node, full)) {
                    read_table(*inner, full);
                }
            } else if (leads_to_group(full)) {
                if (const toml::table* inner = expect_table(node, full)) read_table(*inner, full);
            } else {
                read_key(path, name, key, node);
            }
        }
    }

  private:
    const Group* find_group(const std::string& path) const {
        for (const Group& group : groups_)
            if (group.path == path && !path.empty()) return &group;
        return nullptr;
    }
    bool leads_to_group(const std::string& path) const {
        for (const Group& group : groups_)
            if (group.path.compare(0, path.size() + 1, path + ".") == 0) return true;
        return false;
    }
    const toml::table* expect_table(const toml::node& node, const std::string& path) {
        if (node.is_table()) return node.as_table();
        problems_.add(place_of(node.source(), file_), fmt::format("'{}' is {}, not a table", path, kind_of(node)),
                      fmt::format("write [{}] on a line of its own, its keys below", path));
        return nullptr;
    }

    void read_key(const std::string& path, const std::string& name, const toml::key& key, const toml::node& node) {
        for (const Group& group : groups_) {
            if (group.path != path || group.records) continue;
            for (const Key& entry : group.keys)
                if (entry.name == name) {
                    set(entry, &scene_, node, join_path(path, name));
                    return;
                }
        }
        tell_unknown(path, name, place_of(key.source(), file_));
    }

    void set(const Key& key, void* record, const toml::node& node, const std::string& path) {
        if (const auto value = read_value(key, node, path, place_of(node.source(), file_), problems_))
            key.set(record, *value);
    }

    /// "Unknown key", with the likeliest mend.
    void tell_unknown(const std::string& path, const std::string& name, const Place& place) {
        std::vector<std::string> here;
        std::string elsewhere;
        for (const Group& group : groups_) {
            for (const Key& key : group.keys) {
                if (group.path == path)
                    here.push_back(key.name);
                else if (key.name == name && elsewhere.empty())
                    elsewhere = group.path.empty() ? "the top"
                                : group.records    ? "[[" + group.path + "]]"
                                                   : "[" + group.path + "]";
            }
            // Tables that could stand here.
            const std::string prefix = path.empty() ? "" : path + ".";
            if (group.path.size() > prefix.size() && group.path.compare(0, prefix.size(), prefix) == 0) {
                const std::string next =
                    group.path.substr(prefix.size(), group.path.find('.', prefix.size()) - prefix.size());
                if (std::find(here.begin(), here.end(), next) == here.end()) here.push_back(next);
            }
        }
        const std::string near = closest(name, here);
        std::string hint;
        if (!near.empty())
            hint = fmt::format("did you mean '{}'?", near);
        else if (!elsewhere.empty())
            hint = fmt::format("'{}' belongs into {}", name, elsewhere);
        else
            hint = fmt::format("{} knows {}", path.empty() ? "a scene" : "[" + path + "]", join(here));
        problems_.add(place, fmt::format("unknown key '{}'", join_path(path, name)),
                      hint + " (`calot scene --defaults` shows every key)");
    }

    void read_records(const Group& group, const toml::node& node) {
        const toml::array* array = node.as_array();
        if (!array || (!array->empty() && !node.is_array_of_tables())) {
            problems_.add(place_of(node.source(), file_),
                          fmt::format("'{}' is {}, not tables", group.path, kind_of(node)),
                          fmt::format("write [[{}]] on a line of its own, its keys below; once for each", group.path));
            return;
        }
        group.records->clear(scene_);
        for (auto&& element : *array) read_record(group, *element.as_table());
    }

    void read_record(const Group& group, const toml::table& table) {
        const Place place = place_of(table.source(), file_);
        void* record = group.records->append(scene_, place);
        for (auto&& [key, node] : table) {
            const bool known = std::any_of(group.keys.begin(), group.keys.end(),
                                           [&, name = key.str()](const Key& entry) { return entry.name == name; });
            if (!known) tell_unknown(group.path, std::string(key.str()), place_of(key.source(), file_));
        }
        // In the order of the table of keys: a preset comes before what overrides it.
        for (const Key& key : group.keys)
            if (const toml::node* node = table.get(key.name)) set(key, record, *node, group.path + "." + key.name);
        for (const Key& key : group.keys)
            if (key.required && !table.contains(key.name))
                problems_.add(place, fmt::format("[[{}]] has no '{}'", group.path, key.name),
                              "give " + describe_expected(key));
        if (group.path == "mesh") {
            MeshEntry& mesh = *static_cast<MeshEntry*>(record);
            if (!mesh.file.empty()) mesh.file = resolve_path(mesh.file, directory_);
        }
    }

    void read_materials(const toml::table& materials) {
        // In the order of the file, since a new material may start from another new one.
        std::vector<std::pair<toml::key, const toml::node*>> entries;
        for (auto&& [key, node] : materials) entries.emplace_back(key, &node);
        std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
            return a.first.source().begin.line < b.first.source().begin.line;
        });
        for (const auto& [key, node] : entries) {
            const std::string name(key.str());
            const toml::table* table = expect_table(*node, "materials." + name);
            if (!table || !derive_material(name, *table, place_of(key.source(), file_))) continue;
            groups_ = groups(scene_);
            const Group& group = *find_group("materials." + name);
            for (auto&& [inner_key, inner] : *table) {
                if (inner_key.str() == "like") continue;
                const Key* found = nullptr;
                for (const Key& entry : group.keys)
                    if (entry.name == inner_key.str()) found = &entry;
                if (found) {
                    set(*found, &scene_, inner, group.path + "." + found->name);
                    warn_if_implausible(name, found->name, place_of(inner.source(), file_));
                } else {
                    tell_unknown(group.path, std::string(inner_key.str()), place_of(inner_key.source(), file_));
                }
            }
        }
    }

    /// Values that no soft tissue has.
    void warn_if_implausible(const std::string& name, const std::string& key, const Place& place) {
        const tissue::Material& material = scene_.materials[tissue::find_material(scene_.materials, name)];
        for (const tissue::MaterialField& field : tissue::material_fields())
            if (key == field.key && !field.plausible(material))
                scene_.warnings.push_back(
                    {place, fmt::format("materials.{}.{} is {:g}; soft tissue lies in {:g} to {:g} {} (`calot materials "
                                        "{}` has sources)",
                                        name, key, field.value(material), field.low, field.high, field.unit, name)});
    }

    /// Makes sure that the material exists: known ones do, new ones say which they are like. False when it does not.
    bool derive_material(const std::string& name, const toml::table& table, const Place& place) {
        const tissue::MaterialIndex index = tissue::find_material(scene_.materials, name);
        const toml::node* like = table.get("like");
        const bool built_in = index != tissue::kNoMaterial && scene_.material_like[index].empty();
        if (!like) {
            if (index != tissue::kNoMaterial) return true;
            problems_.add(place, fmt::format("unknown material '{}'", name),
                          did_you_mean(name) + "a new material needs like = \"fat\" or another to start from");
            return false;
        }
        const std::string model = like->value_or(std::string());
        const tissue::MaterialIndex from = tissue::find_material(scene_.materials, model);
        if (built_in || from == tissue::kNoMaterial || from == index) {
            problems_.add(place_of(like->source(), file_),
                          built_in ? fmt::format("'{}' is built in and cannot be like another material", name)
                                   : fmt::format("'{}' cannot be like '{}', which is no other material", name, model),
                          built_in ? "leave 'like' out, or give the new material a name of its own"
                                   : did_you_mean(model) + "materials: " + join(material_names()));
            return false;
        }
        if (scene_.materials.size() > 200) {
            problems_.add(place, "more than 200 materials", "leave some out");
            return false;
        }
        tissue::Material material = scene_.materials[from];
        material.name = name;
        if (index == tissue::kNoMaterial) {
            scene_.materials.push_back(material);
            scene_.material_like.push_back(model);
        } else {
            scene_.materials[index] = material;
            scene_.material_like[index] = model;
        }
        return true;
    }
    std::vector<std::string> material_names() const {
        std::vector<std::string> names;
        for (std::size_t k = 1; k < scene_.materials.size(); ++k) names.push_back(scene_.materials[k].name);
        return names;
    }
    std::string did_you_mean(const std::string& name) const {
        const std::string near = closest(name, material_names());
        return near.empty() ? "" : fmt::format("did you mean '{}'? ", near);
    }

    Scene& scene_;
    const std::string& file_;
    const std::string& directory_;
    Problems& problems_;
    std::vector<Group> groups_;
};

}  // namespace

std::optional<Value> read_value(const Key& key, const toml::node& node, const std::string& path, const Place& place,
                                Problems& problems) {
    switch (key.type) {
        case KeyType::boolean:
            if (node.is_boolean()) return Value(*node.value<bool>());
            break;
        case KeyType::integer:
            if (const auto value = node.value<std::int64_t>(); node.is_integer() && value)
                return in_range(key, static_cast<double>(*value), path, place, problems) ? std::optional<Value>(*value)
                                                                                         : std::nullopt;
            break;
        case KeyType::number:
            if (const auto value = number_of(node))
                return in_range(key, *value, path, place, problems) ? std::optional<Value>(*value) : std::nullopt;
            break;
        case KeyType::vector:
            if (const toml::array* array = node.as_array(); array && array->size() == 3)
                return read_vector(key, *array, path, place, problems);
            if (const toml::array* array = node.as_array()) {
                problems.add(place, fmt::format("'{}' has {} elements", path, array->size()),
                             "give " + describe_expected(key));
                return std::nullopt;
            }
            break;
        case KeyType::text:
            if (const auto value = node.value<std::string>(); node.is_string() && value) return Value(*value);
            break;
        case KeyType::choice:
            if (const auto value = node.value<std::string>(); node.is_string() && value)
                return read_choice(key, *value, path, place, problems);
            break;
    }
    problems.add(place, fmt::format("'{}' is {}", path, kind_of(node)), "give " + describe_expected(key));
    return std::nullopt;
}

void read_document(const toml::table& document, const std::string& file, const std::string& directory, Scene& scene,
                   Problems& problems) {
    DocumentReader(scene, file, directory, problems).read_table(document, "");
}

std::string resolve_path(const std::string& path, const std::string& directory) {
    const std::filesystem::path written(path);
    if (written.is_absolute()) return written.lexically_normal().string();
    return std::filesystem::absolute(std::filesystem::path(directory) / written).lexically_normal().string();
}

}  // namespace calot::scene
