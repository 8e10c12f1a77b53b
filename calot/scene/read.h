#pragma once
// From TOML nodes to a Scene, by the table of keys.

#include <optional>
#include <string>

#include <toml++/toml.h>

#include "calot/scene/keys.h"
#include "calot/scene/problems.h"

namespace calot::scene {

/// The value a node holds for a key; nothing, and a problem told, when it does not fit. `path` names it in messages.
std::optional<Value> read_value(const Key& key, const toml::node& node, const std::string& path, const Place& place,
                                Problems& problems);

/// Sets all that a document says. Arrays of tables replace those that the scene had.
void read_document(const toml::table& document, const std::string& file, const std::string& directory, Scene& scene,
                   Problems& problems);

/// A mesh's path, absolute.
std::string resolve_path(const std::string& path, const std::string& directory);

}  // namespace calot::scene
