#include "calot/validation/case.h"

#include <algorithm>
#include <cmath>

namespace calot::validation {

namespace {

struct Factor {
    const char* name;
    double Spoil::*member;
};
constexpr Factor kFactors[] = {{"youngs_modulus", &Spoil::youngs_modulus},
                               {"thermal_conductivity", &Spoil::thermal_conductivity},
                               {"electric_conductivity", &Spoil::electric_conductivity},
                               {"water", &Spoil::water},
                               {"damage", &Spoil::damage},
                               {"surface_radius", &Spoil::surface_radius}};

Verdict judge(const Case& result) {
    const bool good = std::isfinite(result.error) && result.error <= result.tolerance &&
                      (result.least_order == 0.0 || (result.order && *result.order >= result.least_order));
    return good ? Verdict::pass : Verdict::fail;
}

}  // namespace

const char* word(Kind kind) {
    switch (kind) {
        case Kind::analytic:
            return "analytic";
        case Kind::trend:
            return "trend";
        case Kind::published:
            break;
    }
    return "published";
}

const char* word(Verdict verdict) {
    switch (verdict) {
        case Verdict::pass:
            return "pass";
        case Verdict::fail:
            return "fail";
        case Verdict::band:
            return "band";
        case Verdict::outside:
            break;
    }
    return "outside";
}

Case compare(const std::string& suite, const std::string& name, double value, double expected, const std::string& unit,
             double tolerance, const std::string& source) {
    Case result;
    result.suite = suite;
    result.name = name;
    result.value = value;
    result.expected = expected;
    result.unit = unit;
    result.error = std::abs(value / expected - 1.0);
    result.tolerance = tolerance;
    result.source = source;
    result.verdict = judge(result);
    return result;
}

Case below(const std::string& suite, const std::string& name, double value, const std::string& unit, double tolerance,
           const std::string& source) {
    Case result;
    result.suite = suite;
    result.name = name;
    result.value = value;
    result.unit = unit;
    result.error = std::abs(value);
    result.tolerance = tolerance;
    result.source = source;
    result.verdict = judge(result);
    return result;
}

Case trend(const std::string& name, double value, double least, const std::string& unit, const std::string& source) {
    Case result;
    result.suite = "coupled";
    result.name = name;
    result.kind = Kind::trend;
    result.value = value;
    result.expected = least;
    result.unit = unit;
    result.error = std::isfinite(value) ? std::max(0.0, least - value) : INFINITY;
    result.source = source;
    result.verdict = judge(result);
    return result;
}

Case published(const std::string& name, double value, double low, double high, const std::string& unit,
               const std::string& source) {
    Case result;
    result.suite = "coupled";
    result.name = name;
    result.kind = Kind::published;
    result.value = value;
    result.expected = 0.5 * (low + high);
    result.unit = unit;
    result.tolerance = 0.5 * (high - low) / result.expected;
    result.error = std::abs(value / result.expected - 1.0);
    result.range = {low, high};
    result.source = source;
    result.verdict = value >= low && value <= high ? Verdict::band : Verdict::outside;
    return result;
}

double observed_order(const Points& error_at_cells) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& [cells, error] : error_at_cells) {
        const double a = std::log(cells), b = std::log(std::max(std::abs(error), 1e-300));
        n += 1, x += a, y += b, xx += a * a, xy += a * b;
    }
    return -(n * xy - x * y) / (n * xx - x * x);
}

void converge(Case& result, const Points& error_at_cells, double least_order, const std::string& across) {
    result.order = observed_order(error_at_cells);
    result.least_order = least_order;
    Figure figure{result.name + ": convergence", across, "relative error", {}, true};
    Curve seen{"seen", {}, true};
    for (const auto& [cells, error] : error_at_cells) seen.points.emplace_back(cells, std::abs(error));
    if (least_order > 0.0) {  // the line of the least order wanted, through the coarsest
        Curve line{"order " + std::to_string(least_order).substr(0, 3), {}, false};
        const auto [n0, e0] = seen.points.front();
        for (const auto& [cells, error] : seen.points)
            line.points.emplace_back(cells, e0 * std::pow(n0 / cells, least_order));
        figure.curves.push_back(line);
    }
    figure.curves.push_back(seen);
    result.figures.push_back(figure);
    result.verdict = judge(result);
}

bool Spoil::set(const std::string& name, double factor) {
    for (const Factor& f : kFactors)
        if (name == f.name) {
            this->*f.member = factor;
            return true;
        }
    return false;
}

std::vector<std::string> Spoil::names() {
    std::vector<std::string> all;
    for (const Factor& f : kFactors) all.emplace_back(f.name);
    return all;
}

std::vector<std::string> suites() {
    return {"deformation", "heat", "electric", "phase", "surface", "coupled"};
}

std::vector<Check> all_checks() {
    std::vector<Check> all;
    for (const auto& checks :
         {deformation_checks(), heat_checks(), electric_checks(), phase_checks(), surface_checks(), coupled_checks()})
        all.insert(all.end(), checks.begin(), checks.end());
    return all;
}

}  // namespace calot::validation
