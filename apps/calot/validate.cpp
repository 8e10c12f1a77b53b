// The oracle of the whole project: runs checks, prints a table, writes JSON and a page.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "calot/base/error.h"
#include "calot/base/parallel.h"
#include "commands.h"
#include "output_directory.h"
#include "validate_report.h"

namespace calot::app {

namespace {

using validation::Case;
using validation::Verdict;
namespace fs = std::filesystem;

/// The scenes of the experiments: as told, in the working directory, or beside the build that this program is of.
std::string find_scenes(const std::string& told) {
    const std::string marker = "spot.toml";
    if (!told.empty()) {
        if (fs::exists(fs::path(told) / marker)) return told;
        throw InputError(fmt::format("{} has no {}", told, marker), "--scenes names the folder scenes/validation");
    }
    std::error_code error;
    std::vector<fs::path> places{"scenes/validation"};
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    for (fs::path up = program.parent_path(); !up.empty() && up != up.root_path(); up = up.parent_path())
        places.push_back(up / "scenes/validation");
    for (const fs::path& place : places)
        if (fs::exists(place / marker, error)) return place.string();
    throw InputError("the scenes of the experiments were not found",
                     "start in Calot's folder, or name scenes/validation with --scenes");
}

validation::Spoil read_spoil(const std::vector<std::string>& texts) {
    validation::Spoil spoil;
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        char* end = nullptr;
        const double factor = equals == std::string::npos ? 0.0 : std::strtod(text.c_str() + equals + 1, &end);
        if (equals == std::string::npos || end == nullptr || *end != '\0' || !(factor >= 0.1 && factor <= 10.0) ||
            !spoil.set(text.substr(0, equals), factor)) {
            std::string names;
            for (const std::string& name : validation::Spoil::names()) names += (names.empty() ? "" : ", ") + name;
            throw InputError(fmt::format("cannot spoil '{}'", text),
                             "NAME=FACTOR, from 0.1 to 10, NAME one of " + names);
        }
    }
    return spoil;
}

/// A line about what is running, on a terminal; every check on a line of its own elsewhere.
class Ticker {
  public:
    Ticker(ProgressKind kind, std::size_t total) : total_(total) {
        bar_ = kind == ProgressKind::automatic && ::isatty(STDERR_FILENO);
        lines_ = kind == ProgressKind::plain;
    }
    void begin(const validation::Check& check, std::size_t index) {
        text_ = fmt::format("{:2d}/{} {}: {}", index + 1, total_, check.suite, check.name);
        if (lines_) fmt::print(stderr, "calot: {}\n", text_);
        share(0.0);
    }
    void share(double done) const {
        if (!bar_) return;
        fmt::print(stderr, "\r\033[K  {}{}", text_, done > 0.0 ? fmt::format("  {:.0f} %", 100.0 * done) : "");
        std::fflush(stderr);
    }
    void clear() const {
        if (bar_) fmt::print(stderr, "\r\033[K");
    }

  private:
    std::size_t total_;
    bool bar_ = false, lines_ = false;
    std::string text_;
};

void print_case(const Case& c, bool colours) {
    const char* colour = c.verdict == Verdict::fail      ? "\033[1;31m"
                         : c.verdict == Verdict::outside ? "\033[33m"
                                                         : "\033[32m";
    const std::string unit = c.unit == "1" ? "" : c.unit;
    fmt::print("  {}{:7}{} {:52} {:>10} {:<12.12} {:<22} {}\n", colours ? colour : "", word(c.verdict),
               colours ? "\033[0m" : "", c.name, number_text(c.value), unit, error_text(c),
               c.order ? fmt::format("order {:.2f}", *c.order) : "");
}

void write_json(const std::string& path, const std::string& text) {
    const std::string partial = fmt::format("{}.partial-{}", path, ::getpid());
    try {
        write_file(partial, text);
        fs::rename(partial, path);
    } catch (const std::exception&) {
        std::error_code error;
        fs::remove(partial, error);
        throw;
    }
}

}  // namespace

int validate(const ValidateOptions& options) {
    validation::Options how;
    how.quick = options.quick;
    how.scenes = find_scenes(options.scenes);
    how.spoil = read_spoil(options.spoil);
    if (!options.json.empty()) {
        const fs::path parent = fs::absolute(options.json).parent_path();
        if (!fs::is_directory(parent) || fs::is_directory(options.json))
            throw InputError(fmt::format("cannot write {}", options.json),
                             "--json names a file in a folder that exists");
    }
    std::optional<OutputDirectory> directory;
    if (!options.report.empty()) directory.emplace(options.report, options.force);
    std::optional<ThreadLimit> limit;
    if (options.threads > 0) limit.emplace(options.threads);

    std::vector<validation::Check> checks;
    for (validation::Check& check : validation::all_checks())
        if ((options.suite.empty() || check.suite == options.suite) && (check.quick || !options.quick))
            checks.push_back(std::move(check));
    Ticker ticker(options.progress, checks.size());
    how.progress = [&](double done) { ticker.share(done); };

    const auto start = std::chrono::steady_clock::now();
    const bool colours = ::isatty(STDOUT_FILENO);
    ValidationRecord record;
    record.quick = options.quick;
    for (const std::string& text : options.spoil) record.spoilt += (record.spoilt.empty() ? "" : ", ") + text;
    std::string suite;
    for (std::size_t k = 0; k < checks.size(); ++k) {
        ticker.begin(checks[k], k);
        std::vector<Case> cases = checks[k].run(how);
        ticker.clear();
        if (checks[k].suite != suite) fmt::print("{}{}\n", suite.empty() ? "" : "\n", checks[k].suite);
        suite = checks[k].suite;
        for (const Case& c : cases) print_case(c, colours);
        std::fflush(stdout);
        record.cases.insert(record.cases.end(), cases.begin(), cases.end());
    }
    record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    const int failed = record.count(Verdict::fail), outside = record.count(Verdict::outside);
    fmt::print("\n{} pass, {} fail", record.count(Verdict::pass), failed);
    if (const int band = record.count(Verdict::band); band + outside > 0)
        fmt::print("; published: {} within their band, {} outside", band, outside);
    fmt::print(" ({:.0f} s)\n", record.wall_s);
    if (!options.json.empty()) write_json(options.json, validation_json(record));
    if (directory) {
        write_file(directory->path("validation.json"), validation_json(record));
        write_file(directory->path("report.html"), validation_html(record));
        directory->commit();
        fmt::print("look at {}/report.html\n", options.report);
    }
    return failed > 0 ? kFailed : kDone;
}

}  // namespace calot::app
