#pragma once
// Where a run writes: a temporary directory beside the final one, renamed when complete.

#include <filesystem>
#include <string>

namespace calot::app {

class OutputDirectory {
  public:
    /// Creates "DIR.partial-N" beside `directory`. Throws InputError when `directory` exists (with `force`: when it is
    /// not an earlier output of Calot), or nothing can be written there.
    OutputDirectory(const std::string& directory, bool force);
    /// Without commit(): removes the temporary directory if nothing was written into it, and keeps it otherwise.
    ~OutputDirectory();
    OutputDirectory(const OutputDirectory&) = delete;
    OutputDirectory& operator=(const OutputDirectory&) = delete;

    /// Path of an output while the run is going on.
    std::string path(const std::string& name) const { return (partial_ / name).string(); }
    /// The same after commit().
    std::string final_path(const std::string& name) const { return (final_ / name).string(); }
    const std::filesystem::path& partial() const { return partial_; }
    /// A directory inside, created.
    std::string subdirectory(const std::string& name);

    /// Puts everything under its final name; an earlier output is removed only then.
    void commit();

  private:
    void refuse_if_taken() const;
    std::filesystem::path final_, partial_;
    bool force_ = false;
    bool committed_ = false;
};

/// Writes a whole file. Throws std::system_error naming it when that fails (disk full, ...).
void write_file(const std::string& path, const std::string& content);

}  // namespace calot::app
