#pragma once
// Reads the tables of a task file, collecting what is wrong with them.

#include <optional>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "calot/scene/problems.h"

namespace calot::training {

/// One table of the file. Keys that nobody asked for are reported by finish().
class TableReader {
  public:
    TableReader(const toml::table& table, std::string path, std::string file, scene::Problems& problems)
        : table_(table), path_(std::move(path)), file_(std::move(file)), problems_(problems) {}

    std::string text(const char* key, bool required = false, const std::string& otherwise = "");
    std::optional<double> number(const char* key, double low, double high, bool required = false);
    bool boolean(const char* key, bool otherwise);
    std::vector<std::string> texts(const char* key);
    std::optional<std::vector<double>> numbers(const char* key, std::size_t count);
    /// Tables of an array of tables.
    std::vector<const toml::table*> tables(const char* key);

    /// The key is read elsewhere.
    void knows(const char* key) { known_.emplace_back(key); }

    scene::Place place(const char* key) const;
    void problem(const char* key, const std::string& message, const std::string& hint = "");
    void finish();
    const std::string& file() const { return file_; }

  private:
    const toml::node* take(const char* key, bool required);

    const toml::table& table_;
    std::string path_, file_;
    scene::Problems& problems_;
    std::vector<std::string> known_;
};

}  // namespace calot::training
