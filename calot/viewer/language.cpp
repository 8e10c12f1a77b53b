#include "calot/viewer/language.h"

#include <algorithm>
#include <filesystem>

#include <toml++/toml.h>

#include "calot/base/error.h"

namespace calot::viewer {

Language::Language(const std::string& directory, const std::string& name) : name_(name) {
    read(directory + "/en.toml");
    if (name != "en") read(directory + "/" + name + ".toml");
}

void Language::read(const std::string& path) {
    toml::table table;
    try {
        table = toml::parse_file(path);
    } catch (const toml::parse_error& error) {
        const auto& begin = error.source().begin;
        throw InputError(path, static_cast<int>(begin.line), static_cast<int>(begin.column),
                         std::string(error.description()), "a language file holds lines of the form  key = \"text\"");
    }
    for (const auto& [key, node] : table) {
        const auto text = node.value<std::string>();
        if (!text || !node.is_string())
            throw InputError(path, static_cast<int>(node.source().begin.line),
                             static_cast<int>(node.source().begin.column),
                             "\"" + std::string(key.str()) + "\" is no text",
                             "write it as  \"" + std::string(key.str()) + "\" = \"text\"");
        texts_[std::string(key.str())] = *text;
    }
}

const std::string& Language::operator()(const std::string& key) const {
    const auto found = texts_.find(key);
    return found != texts_.end() ? found->second : key;
}

std::vector<std::string> Language::available(const std::string& directory) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(directory, error))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace calot::viewer
