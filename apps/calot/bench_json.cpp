#include "bench_json.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calot/base/error.h"

namespace calot::app {

namespace {

using Json = nlohmann::ordered_json;

/// A tenth of a nanosecond is enough.
double rounded(double us) {
    return std::round(us * 1e4) / 1e4;
}
/// 0 stands for "there is none".
Json or_null(double value) {
    return value > 0.0 ? Json(rounded(value)) : Json(nullptr);
}

Json stages_json(const std::array<StageTimes, simulation::kStages>& stages) {
    Json out;
    for (std::size_t k = 0; k < stages.size(); ++k)
        out[simulation::kStageNames[k]] = {{"mean", rounded(stages[k].mean)},
                                           {"median", rounded(stages[k].median)},
                                           {"p99", rounded(stages[k].p99)},
                                           {"max", rounded(stages[k].max)}};
    return out;
}

Json tick_json(const TickResult& tick) {
    Json worst = Json::array();
    for (const TickEvent& event : tick.worst)
        worst.push_back({{"tick", event.tick}, {"us", rounded(event.us)}, {"cause", event.cause}});
    Json histogram;
    histogram["edges_us"] = tick.bin_edges_us;
    for (std::size_t k = 0; k < simulation::kStages; ++k) histogram[simulation::kStageNames[k]] = tick.histogram[k];
    histogram["tick"] = tick.histogram[simulation::kStages];
    return {
        {"scene", tick.scene},
        {"phyxels", tick.phyxels},
        {"hexels", tick.hexels},
        {"threads", tick.threads},
        {"simulated_s", tick.simulated_s},
        {"median_us", rounded(tick.median_us)},
        {"p99_us", rounded(tick.p99_us)},
        {"p999_us", rounded(tick.p999_us)},
        {"max_us", rounded(tick.max_us)},
        {"late", tick.late},
        {"passes", tick.passes},
        {"least_us",
         {{"median", rounded(tick.least.median)}, {"p99", rounded(tick.least.p99)}, {"max", rounded(tick.least.max)}}},
        {"stages_us", stages_json(tick.stages_us)},
        {"burning", {{"ticks", tick.burning_ticks}, {"p99_us", rounded(tick.burning_p99_us)}}},
        {"removed", tick.removed},
        {"severed", tick.severed},
        {"most_removed_in_a_second", tick.most_removed_in_a_second},
        {"worst", worst},
        {"histogram", histogram}};
}

Json machine_json(const Machine& machine) {
    return {{"processor", machine.processor},
            {"instruction_set", machine.instruction_set},
            {"cores", machine.cores},
            {"memory_GB", std::round(machine.memory_GB * 10.0) / 10.0},
            {"system", machine.system},
            {"compiler", machine.compiler},
            {"calot", CALOT_VERSION},
            {"scheduling", machine.scheduling},
            {"memory_locked", machine.memory_locked},
            {"load_at_start", machine.load}};
}

Json ceilings_json(const Ceilings& ceilings) {
    Json bandwidth = Json::array(), arithmetic = Json::array();
    for (const Bandwidth& b : ceilings.bandwidth)
        bandwidth.push_back({{"megabytes", b.megabytes},
                             {"threads", b.threads},
                             {"read_GB_per_s", rounded(b.read_GB_per_s)},
                             {"copy_GB_per_s", rounded(b.copy_GB_per_s)}});
    for (const ArithmeticRate& a : ceilings.arithmetic)
        arithmetic.push_back({{"threads", a.threads},
                              {"multiply_add_GFlop_per_s", rounded(a.separate_GFlop_per_s)},
                              {"fused_GFlop_per_s", rounded(a.fused_GFlop_per_s)}});
    return {{"bandwidth", bandwidth},
            {"arithmetic", arithmetic},
            {"empty_parallel_loop_us", rounded(ceilings.parallel_for_us)}};
}

/// Numbers in few digits: files stay small.
Json short_list(const std::vector<double>& values) {
    Json out = Json::array();
    for (const double value : values) out.push_back(std::round(value * 1e4) / 1e4);
    return out;
}

Json device_json(const DeviceBench& device) {
    Json costs = Json::array();
    for (const DeviceCost& c : device.costs) {
        Json kernels = Json::object();
        for (const auto& [kernel, us] : c.kernel_us) kernels[kernel] = rounded(us);
        costs.push_back({{"name", c.name},
                         {"size", c.size},
                         {"us", rounded(c.us)},
                         {"kernels_us", rounded(c.kernels_us)},
                         {"transfers_us", rounded(c.transfers_us)},
                         {"launches", rounded(c.launches)},
                         {"reads", rounded(c.reads)},
                         {"bytes_up", rounded(c.bytes_up)},
                         {"bytes_down", rounded(c.bytes_down)},
                         {"by_kernel_us", kernels}});
    }
    return {{"name", device.name},
            {"launch_us", rounded(device.launch_us)},
            {"round_trip_us", rounded(device.round_trip_us)},
            {"up_GB_per_s", rounded(device.up_GB_per_s)},
            {"down_GB_per_s", rounded(device.down_GB_per_s)},
            {"copy_GB_per_s", rounded(device.copy_GB_per_s)},
            {"costs", costs}};
}

}  // namespace

std::string bench_json(const BenchResults& results) {
    Json out;
    out["machine"] = machine_json(results.machine);
    out["ceilings"] = ceilings_json(results.ceilings);
    out["kernels"] = Json::array();
    for (const KernelResult& k : results.kernels)
        out["kernels"].push_back({{"name", k.name},
                                  {"size", k.size},
                                  {"threads", k.threads},
                                  {"us", rounded(k.us)},
                                  {"reference_us", or_null(k.reference_us)},
                                  {"floor_us", or_null(k.floor_us)}});
    out["tick"] = Json::array();
    for (const TickResult& tick : results.tick) out["tick"].push_back(tick_json(tick));
    if (!results.device.name.empty()) out["device"] = device_json(results.device);
    out["paper"] = Json::array();
    for (const PaperRow& row : results.paper)
        out["paper"].push_back({{"table", row.table},
                                {"size", row.size},
                                {"stage", row.stage},
                                {"ours_ms", rounded(row.ours_ms)},
                                {"published_ms", or_null(row.published_ms)}});
    out["scale"] = {{"sizes", results.scale.sizes},
                    {"us", short_list(results.scale.us)},
                    {"exponent", rounded(results.scale.exponent)}};
    Json samples = Json::object();
    for (const auto& [name, set] : samples_of(results)) {
        samples[name]["us"] = short_list(set.us);
        if (!set.yardstick_us.empty()) samples[name]["yardstick_us"] = short_list(set.yardstick_us);
    }
    out["samples"] = samples;
    out["notes"] = results.notes;
    out["wall_s"] = std::round(results.wall_s * 10.0) / 10.0;
    out["quick"] = results.quick;
    return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

SampleSet samples_of(const BenchResults& results) {
    SampleSet set;
    for (const KernelResult& k : results.kernels)
        set[fmt::format("{} | {} {} | {} thread(s)", k.name, k.size, k.unit, k.threads)] = {k.samples_us,
                                                                                            k.yardstick_us};
    for (const TickResult& tick : results.tick) {
        const std::string name = fmt::format("tick | {} | {} thread(s)", tick.scene, tick.threads);
        set[name + " | median"] = {tick.block_median_us, {}};
        set[name + " | p99"] = {tick.block_p99_us, {}};
    }
    return set;
}

SampleSet read_samples(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw InputError(path, 0, 0, "cannot read this file", "give a file that calot bench --json wrote");
    SampleSet set;
    try {
        const Json json = Json::parse(file);
        for (const auto& [name, entry] : json.at("samples").items()) {
            Samples& samples = set[name];
            samples.us = entry.at("us").get<std::vector<double>>();
            if (entry.contains("yardstick_us")) samples.yardstick_us = entry["yardstick_us"].get<std::vector<double>>();
        }
    } catch (const nlohmann::json::exception& error) {
        throw InputError(path, 0, 0, fmt::format("this is no result of a benchmark: {}", error.what()),
                         "give a file that calot bench --json wrote");
    }
    return set;
}

}  // namespace calot::app
