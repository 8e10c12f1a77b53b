#pragma once
// The table of keys: what a scene file may say, and how each value is stored.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "calot/scene/scene.h"

namespace calot::scene {

/// A value as it stands in the file, in the file's unit.
using Value = std::variant<bool, std::int64_t, double, std::string, Vec3>;

/// Unit of a key in the file: SI = file * factor + offset.
struct Unit {
    const char* name = "";
    double factor = 1.0;
    double offset = 0.0;
    double to_si(double value) const { return value * factor + offset; }
};

enum class KeyType { boolean, integer, number, vector, text, choice };

struct Key {
    std::string name;  ///< last part of the path
    KeyType type = KeyType::number;
    Unit unit;
    double low = 0.0, high = 0.0;      ///< inclusive, in the file's unit; of each component of a vector
    std::vector<std::string> choices;  ///< of KeyType::choice
    std::string documentation;
    bool required = false;  ///< in records (tables of an array)
    /// Nothing when the value is left to something else (drawn from the seed, ...).
    std::function<std::optional<Value>(const void* record)> get;
    std::function<void(void* record, const Value& value)> set;
};

/// A table of the file: "[sampling]". With `records`, an array of tables: "[[mesh]]".
struct Group {
    std::string path;
    std::string documentation;
    std::vector<Key> keys;
    /// Arrays of tables only; null otherwise.
    struct Records {
        std::function<std::size_t(const Scene&)> size;
        std::function<void(Scene&)> clear;
        std::function<void*(Scene&, const Place&)> append;
        std::function<void*(Scene&, std::size_t)> at;
    };
    std::optional<Records> records;
};

/// The groups of top-level keys ("" first), tables and arrays of tables, in the order of the printed defaults.
/// Materials of the scene are groups "materials.NAME".
std::vector<Group> groups(const Scene& scene);

/// The keys of one material.
Group material_group(const std::string& name, std::size_t index);

/// The table that describes the parametric patient.
Group triangle_group();

/// The file's value whose SI value is exactly `si`, in as few digits as possible.
double file_value(double si, const Unit& unit);

/// "a number from 0.05 to 10 mm"
std::string describe_expected(const Key& key);

}  // namespace calot::scene
