#include "output_directory.h"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "calot/base/error.h"

namespace calot::app {

namespace fs = std::filesystem;

namespace {

/// Only what Calot wrote may be replaced: --out ~ --force must not cost anybody their files.
bool is_earlier_output(const fs::path& directory) {
    std::error_code error;
    return fs::is_empty(directory, error) || fs::exists(directory / "summary.json", error) ||
           fs::exists(directory / "recording.calot", error) ||
           fs::exists(directory / "validation.json", error);
}

}  // namespace

OutputDirectory::OutputDirectory(const std::string& directory, bool force) : force_(force) {
    fs::path path = fs::absolute(directory).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    if (directory.empty() || !path.has_filename())
        throw InputError(fmt::format("'{}' cannot be an output directory", directory),
                         "give the name of a directory to create");
    final_ = path;
    refuse_if_taken();
    std::error_code error;
    fs::create_directories(final_.parent_path(), error);
    if (error)
        throw InputError(
            fmt::format("cannot create the directory {}: {}", final_.parent_path().string(), error.message()),
            "choose another with --out");
    for (int attempt = 0;; ++attempt) {
        partial_ = final_;
        partial_ += fmt::format(".partial-{}{}", ::getpid(), attempt > 0 ? fmt::format("-{}", attempt) : "");
        if (fs::create_directory(partial_, error)) break;
        if (error || attempt > 100)
            throw InputError(fmt::format("cannot create the directory {}: {}", partial_.string(), error.message()),
                             "choose another with --out");
    }
}

OutputDirectory::~OutputDirectory() {
    std::error_code error;
    if (!committed_ && fs::is_empty(partial_, error)) fs::remove(partial_, error);
}

void OutputDirectory::refuse_if_taken() const {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(final_, error);
    if (status.type() == fs::file_type::not_found) return;
    if (!fs::is_directory(fs::status(final_, error)))
        throw InputError(fmt::format("{} exists and is not a directory", final_.string()), "choose another with --out");
    if (!force_)
        throw InputError(fmt::format("{} exists", final_.string()),
                         "--force replaces it once the new one is complete; or choose another with --out");
    if (!is_earlier_output(final_))
        throw InputError(fmt::format("{} is not an output of Calot (it has no summary.json); it will not be replaced",
                                     final_.string()),
                         "choose another with --out, or remove it yourself");
}

std::string OutputDirectory::subdirectory(const std::string& name) {
    fs::create_directories(partial_ / name);
    return path(name);
}

void OutputDirectory::commit() {
    refuse_if_taken();
    fs::path old;
    if (fs::exists(final_)) {
        old = final_;
        old += fmt::format(".old-{}", ::getpid());
        fs::rename(final_, old);
    }
    fs::rename(partial_, final_);
    committed_ = true;
    std::error_code error;
    if (!old.empty()) fs::remove_all(old, error);
}

void write_file(const std::string& path, const std::string& content) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), std::fclose);
    if (!file || std::fwrite(content.data(), 1, content.size(), file.get()) != content.size() ||
        std::fflush(file.get()) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot write " + path);
}

}  // namespace calot::app
