#include "calot/training/task_read.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/scene/suggest.h"
#include "calot/training/task.h"

namespace calot::training {

scene::Place TableReader::place(const char* key) const {
    const toml::node* node = table_.get(key);
    const toml::source_region& source = node != nullptr ? node->source() : table_.source();
    return {file_, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

void TableReader::problem(const char* key, const std::string& message, const std::string& hint) {
    problems_.add(place(key), message, hint);
}

const toml::node* TableReader::take(const char* key, bool required) {
    known_.emplace_back(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr && required) problem(key, fmt::format("{} has no '{}'", path_, key), "add it");
    return node;
}

std::string TableReader::text(const char* key, bool required, const std::string& otherwise) {
    const toml::node* node = take(key, required);
    if (node == nullptr) return otherwise;
    if (const auto value = node->value<std::string>(); value && node->is_string()) return *value;
    problem(key, fmt::format("'{}' is no text", key), "put it in quotes");
    return otherwise;
}

std::optional<double> TableReader::number(const char* key, double low, double high, bool required) {
    const toml::node* node = take(key, required);
    if (node == nullptr) return std::nullopt;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (value && *value >= low && *value <= high) return value;
    problem(key, fmt::format("'{}' is no number from {:g} to {:g}", key, low, high));
    return std::nullopt;
}

bool TableReader::boolean(const char* key, bool otherwise) {
    const toml::node* node = take(key, false);
    if (node == nullptr) return otherwise;
    if (node->is_boolean()) return *node->value<bool>();
    problem(key, fmt::format("'{}' is neither true nor false", key));
    return otherwise;
}

std::vector<std::string> TableReader::texts(const char* key) {
    std::vector<std::string> found;
    const toml::node* node = take(key, false);
    if (node == nullptr) return found;
    if (const toml::array* array = node->as_array()) {
        for (const toml::node& item : *array)
            if (item.is_string()) found.push_back(*item.value<std::string>());
        if (found.size() == array->size()) return found;
    }
    problem(key, fmt::format("'{}' is no list of texts", key), "write [\"...\", \"...\"]");
    return {};
}

std::optional<std::vector<double>> TableReader::numbers(const char* key, std::size_t count) {
    const toml::node* node = take(key, false);
    if (node == nullptr) return std::nullopt;
    std::vector<double> found;
    if (const toml::array* array = node->as_array())
        for (const toml::node& item : *array)
            if (item.is_number()) found.push_back(*item.value<double>());
    const bool good = found.size() == count &&
                      std::all_of(found.begin(), found.end(), [](double x) { return std::abs(x) <= 1000.0; });
    if (good) return found;
    problem(key, fmt::format("'{}' is no list of {} numbers from -1000 to 1000", key, count));
    return std::nullopt;
}

std::vector<const toml::table*> TableReader::tables(const char* key) {
    std::vector<const toml::table*> found;
    const toml::node* node = take(key, false);
    if (node == nullptr) return found;
    if (const toml::array* array = node->as_array())
        for (const toml::node& item : *array)
            if (const toml::table* table = item.as_table()) found.push_back(table);
    if (found.empty()) problem(key, fmt::format("'{}' is no array of tables", key), fmt::format("write [[{}]]", key));
    return found;
}

void TableReader::finish() {
    for (const auto& [key, node] : table_) {
        const std::string name(key.str());
        if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
        const std::string near = scene::closest(name, known_);
        problems_.add({file_, static_cast<int>(key.source().begin.line), static_cast<int>(key.source().begin.column)},
                      fmt::format("{} has no key '{}'", path_, name),
                      near.empty() ? "keys: " + scene::join(known_) : fmt::format("did you mean '{}'?", near));
    }
}

namespace {

constexpr double kAny = 1e12;

/// A metric's name, checked; its values in the file are in the unit in which it is shown.
const Metric* read_metric(TableReader& table) {
    const std::string name = table.text("metric", true);
    const Metric* metric = find_metric(name);
    if (metric != nullptr || name.empty()) return metric;
    std::vector<std::string> names;
    for (const Metric& known : metric_table()) names.emplace_back(known.name);
    const std::string near = scene::closest(name, names);
    table.problem(
        "metric", fmt::format("there is no metric '{}'", name),
        (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) + "`calot tasks --metrics` lists them");
    return nullptr;
}

double to_si(const Metric& metric, double shown) {
    return (shown - metric.offset) / metric.factor;
}

Bound read_bound(TableReader& table) {
    Bound bound;
    const Metric* metric = read_metric(table);
    const auto least = table.number("at_least", -kAny, kAny), most = table.number("at_most", -kAny, kAny);
    if (!least && !most) table.problem("metric", "a bound needs 'at_least' or 'at_most'");
    if (metric == nullptr) return bound;
    bound.metric = metric->name;
    if (least) bound.at_least = to_si(*metric, *least);
    if (most) bound.at_most = to_si(*metric, *most);
    return bound;
}

ScoreItem read_item(TableReader& table) {
    ScoreItem item;
    const Metric* metric = read_metric(table);
    const auto weight = table.number("weight", 0.0, 1000.0, true);
    const auto worst = table.number("worst", -kAny, kAny, true), best = table.number("best", -kAny, kAny, true);
    item.tip = table.text("tip");
    if (worst && best && *worst == *best) table.problem("best", "'worst' and 'best' are the same");
    if (metric == nullptr || !weight || !worst || !best) return item;
    item.metric = metric->name;
    item.weight = *weight;
    item.worst = to_si(*metric, *worst);
    item.best = to_si(*metric, *best);
    return item;
}

Limit read_limit(TableReader& table) {
    Limit limit;
    limit.bound = read_bound(table);
    limit.message = table.text("message", true);
    limit.cap = table.number("cap", 0.0, 100.0).value_or(100.0);
    limit.ends = table.boolean("ends", false);
    return limit;
}

TargetPlace read_target(TableReader& table) {
    TargetPlace target;
    target.landmark = table.text("at");
    if (const auto offset = table.numbers("offset_mm", 3))
        target.offset_m = 1e-3 * Vec3((*offset)[0], (*offset)[1], (*offset)[2]);
    target.radius_m = 1e-3 * table.number("radius_mm", 0.1, 50.0).value_or(2.0);
    return target;
}

Patient read_patient(TableReader& table) {
    Patient patient;
    patient.seed = static_cast<std::uint64_t>(table.number("seed", 0.0, 9e15, true).value_or(1.0));
    patient.name = table.text("name", false, fmt::format("patient {}", patient.seed));
    patient.difficulty = static_cast<int>(table.number("difficulty", 1.0, 3.0).value_or(1.0));
    return patient;
}

template <class T>
void read_all(TableReader& top, const char* key, scene::Problems& problems, std::vector<T>& out,
              T (*read)(TableReader&)) {
    for (const toml::table* table : top.tables(key)) {
        TableReader reader(*table, fmt::format("[[{}]]", key), top.file(), problems);
        out.push_back(read(reader));
        reader.finish();
    }
}

void read_head(const toml::table& document, const std::string& path, scene::Problems& problems, Task& task) {
    const toml::table* head = document["task"].as_table();
    if (head == nullptr) {
        problems.add({path, 1, 1}, "there is no table [task]", "a task begins with [task], title and goal");
        return;
    }
    TableReader table(*head, "[task]", path, problems);
    task.title = table.text("title", true);
    task.goal = table.text("goal", true);
    const std::string scene = table.text("scene", true);
    task.scene = (std::filesystem::path(path).parent_path() / scene).lexically_normal().string();
    task.assignments = table.texts("set");
    task.hints = table.texts("hints");
    task.time_limit_s = table.number("time_limit_s", 1.0, 3600.0).value_or(0.0);
    table.finish();
}

}  // namespace

Task parse_task(const std::string& text, const std::string& path) {
    Task task;
    task.name = std::filesystem::path(path).stem().string();
    task.path = path;
    task.text = text;
    toml::table document;
    try {
        document = toml::parse(text, path);
    } catch (const toml::parse_error& error) {
        throw InputError(
            path, static_cast<int>(error.source().begin.line), static_cast<int>(error.source().begin.column),
            fmt::format("this is not TOML: {}", error.description()), "https://toml.io shows the format in a page");
    }
    scene::Problems problems;
    TableReader top(document, "a task", path, problems);
    read_head(document, path, problems, task);
    top.knows("task");
    read_all(top, "patient", problems, task.patients, read_patient);
    read_all(top, "end", problems, task.end, read_bound);
    read_all(top, "limit", problems, task.limits, read_limit);
    read_all(top, "score", problems, task.score, read_item);
    read_all(top, "target", problems, task.targets, read_target);
    top.finish();
    problems.throw_if_any();
    if (task.score.empty())
        throw InputError(path, 0, 0, "the task scores nothing", "add [[score]] tables: metric, weight, worst, best");
    return task;
}

}  // namespace calot::training
