#pragma once
// What the oracle compares, and what came out.
//
//   analytic    against a closed form or a converged reference: error below a tolerance, and, where the lattice is
//               refined, an observed order of convergence of at least `least_order`
//   trend       what every surgeon knows must hold: `value` is the smallest step of a series in the right direction
//   published   against what others measured: inside their band or outside it. Experiments on tissue disagree with one
//               another by more than a model should be bent; so a value outside a band fails nothing, and is told.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace calot::validation {

enum class Kind { analytic, trend, published };
enum class Verdict { pass, fail, band, outside };

const char* word(Kind kind);
const char* word(Verdict verdict);

using Points = std::vector<std::pair<double, double>>;

/// A line of a plot, or marks.
struct Curve {
    std::string name;
    Points points;
    bool marks = false;
};

/// A plot of the report.
struct Figure {
    std::string title, x_label, y_label;
    std::vector<Curve> curves;
    bool logarithmic = false;  ///< both axes
};

struct Case {
    std::string suite, name;
    Kind kind = Kind::analytic;
    double value = 0.0;
    double expected = 0.0;  ///< a trend's: the least; a published band's: its middle
    std::string unit;       ///< "1" for plain numbers
    double error = 0.0;     ///< relative to `expected`; how far beyond the bound or the band for the other kinds
    double tolerance = 0.0;
    std::optional<double> order;
    double least_order = 0.0;
    std::optional<std::pair<double, double>> range;  ///< the published band
    Verdict verdict = Verdict::fail;
    std::string source;
    std::string note;
    std::vector<Figure> figures;
};

/// value against expected, relative.
Case compare(const std::string& suite, const std::string& name, double value, double expected, const std::string& unit,
             double tolerance, const std::string& source);
/// An error that is none at best: `value` must stay below `tolerance`.
Case below(const std::string& suite, const std::string& name, double value, const std::string& unit, double tolerance,
           const std::string& source);
/// `value` must be at least `least`.
Case trend(const std::string& name, double value, double least, const std::string& unit, const std::string& source);
/// Inside [low, high] or outside.
Case published(const std::string& name, double value, double low, double high, const std::string& unit,
               const std::string& source);

/// Observed order of errors over cells across a feature: the slope of log(error), by least squares.
double observed_order(const Points& error_at_cells);
/// Adds order and plot of a refinement to a case, and asks for `least_order`.
void converge(Case& result, const Points& error_at_cells, double least_order, const std::string& across);

/// Factors on parameters of the simulated side alone. With any but 1 the oracle must object: so it can be seen to look.
struct Spoil {
    double youngs_modulus = 1.0, thermal_conductivity = 1.0, electric_conductivity = 1.0, water = 1.0, damage = 1.0;
    double surface_radius = 1.0;
    /// "electric_conductivity=2"; false: there is no such parameter.
    bool set(const std::string& name, double factor);
    static std::vector<std::string> names();
};

struct Options {
    bool quick = false;
    std::string scenes = "scenes/validation";  ///< where the published experiments' scenes are
    Spoil spoil;
    std::function<void(double share)> progress;  ///< within a check, may be empty
};

/// A run that yields some cases.
struct Check {
    std::string suite, name;
    bool quick = true;  ///< part of the short form
    std::function<std::vector<Case>(const Options&)> run;
};

std::vector<Check> deformation_checks();
std::vector<Check> heat_checks();
std::vector<Check> electric_checks();
std::vector<Check> phase_checks();
std::vector<Check> surface_checks();
std::vector<Check> coupled_checks();
/// All, in the order of the suites.
std::vector<Check> all_checks();
std::vector<std::string> suites();

}  // namespace calot::validation
