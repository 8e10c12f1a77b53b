// Whole runs: trends that every surgeon knows, and what experimenters have published.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calot/base/units.h"
#include "calot/validation/trial.h"

namespace calot::validation {

namespace {

const char* const kSuite = "coupled";
constexpr double kImbalance = 1e-3;
constexpr double kRest_N = 0.3;  ///< the weight of a diathermy pencil, 30 g, chosen: papers say "applied"

std::string power(double watts) {
    return fmt::format("script.burst[0].power_W={:g}", watts);
}
std::string mode(const char* word) {
    return fmt::format("script.burst[0].mode={}", word);
}

Case balance(const std::string& name, const std::vector<Trial>& trials) {
    double worst = 0.0;
    for (const Trial& trial : trials) worst = trial.stopped ? INFINITY : std::max(worst, trial.imbalance);
    Case result = below(kSuite, name + ": energy imbalance", worst, "1", kImbalance,
                        "delivered = outflow + gas + surface + perfusion + debris + stored");
    result.note = fmt::format("worst of {} runs", trials.size());
    return result;
}

/// Smallest ratio of one value to the one before it; steps of what was nothing before count as large.
double least_ratio(const Points& points) {
    double least = INFINITY;
    for (std::size_t k = 1; k < points.size(); ++k)
        least = std::min(least, points[k - 1].second > 0.0 ? points[k].second / points[k - 1].second
                                                           : (points[k].second > 0.0 ? 100.0 : 0.0));
    return least;
}

std::vector<Case> power_against_depth(const Options& options) {
    Points depth, volume;
    std::vector<Trial> trials;
    for (const double watts : {20.0, 35.0, 60.0, 100.0}) {
        trials.push_back(perform(options, {"stroke.toml", {power(watts), mode("cut")}, 0.0, {}}));
        depth.emplace_back(watts, trials.back().depth_mm);
        volume.emplace_back(watts, trials.back().removed_mm3);
    }
    Case removed = trend("more power cuts more", least_ratio(volume), 1.02, "least ratio",
                         "every textbook: power against depth of cut");
    removed.note = fmt::format("removed {:.1f}, {:.1f}, {:.1f}, {:.1f} mm3 of fat at 20, 35, 60, 100 W",
                               volume[0].second, volume[1].second, volume[2].second, volume[3].second);
    removed.figures.push_back({"A stroke over fat, cut",
                               "power, W",
                               "mm or mm3",
                               {{"removed volume, mm3", volume, false}, {"", volume, true}}});
    const double growth = depth.front().second > 0.0  ? depth.back().second / depth.front().second
                          : depth.back().second > 0.0 ? 100.0
                                                      : 0.0;
    Case deeper = trend("more power cuts deeper", std::min(growth, least_ratio(depth) >= 1.0 ? growth : 0.0), 1.2,
                        "100 W to 20 W", "every textbook: power against depth of cut");
    deeper.note = fmt::format("depth {:.1f}, {:.1f}, {:.1f}, {:.1f} mm; 0 where a step makes it shallower",
                              depth[0].second, depth[1].second, depth[2].second, depth[3].second);
    deeper.figures.push_back(
        {"Depth of a stroke over fat", "power, W", "depth, mm", {{"depth", depth, false}, {"", depth, true}}});
    return {removed, deeper, balance("power against depth", trials)};
}

std::vector<Case> cut_against_coag(const Options& options) {
    double removes = INFINITY, spreads = INFINITY;
    std::string removed, hurt;
    std::vector<Trial> trials;
    for (const double watts : {30.0, 40.0}) {
        const Trial cut = perform(options, {"stroke.toml", {power(watts), mode("cut")}, 0.0, {}});
        const Trial coag = perform(options, {"stroke.toml", {power(watts), mode("coag")}, 0.0, {}});
        removes = std::min(removes, cut.removed_mm3 / std::max(coag.removed_mm3, 1e-3));
        spreads = std::min(spreads, coag.damaged_mm3 / std::max(cut.damaged_mm3, 1e-3));
        removed += fmt::format("{}{:.1f} against {:.1f} mm3 of fat at {:g} W", removed.empty() ? "" : ", ",
                               cut.removed_mm3, coag.removed_mm3, watts);
        hurt += fmt::format("{}{:.1f} against {:.1f} mm3 left with Omega >= 1 at {:g} W", hurt.empty() ? "" : ", ",
                            coag.damaged_mm3, cut.damaged_mm3, watts);
        trials.push_back(cut);
        trials.push_back(coag);
    }
    const char* source = "every textbook: continuous wave vaporises, interrupted wave coagulates";
    Case more = trend("cut removes more than coag", removes, 1.05, "least ratio", source);
    more.note = removed;
    Case wider = trend("coag spreads more than cut", spreads, 1.05, "least ratio", source);
    wider.note = hurt;
    return {more, wider, balance("cut against coag", trials)};
}

std::vector<Case> longer_spreads(const Options& options) {
    Points damaged, reach;
    std::vector<Trial> trials;
    Figure figure{
        "After a spot of coagulation on liver", "distance from the metal, mm", "hottest so far, C", {}, false};
    for (const double seconds : {0.5, 1.0, 2.0}) {
        trials.push_back(perform(options, {"spot.toml",
                                           {power(20.0), fmt::format("script.burst[0].to={:g}", 0.1 + seconds),
                                            fmt::format("run.duration_s={:g}", 0.2 + seconds)},
                                           0.0,
                                           {}}));
        damaged.emplace_back(seconds, trials.back().damaged_mm3 + trials.back().removed_mm3);
        reach.emplace_back(seconds, trials.back().damage_mm);
        Points thinned;  // means over 0.3 mm
        for (double x = 0.0; x < 6.0; x += 0.3) {
            const double y = mean_at(trials.back().peak, x);
            if (std::isfinite(y)) thinned.emplace_back(x, y);
        }
        figure.curves.push_back({fmt::format("{:g} s", seconds), thinned, false});
    }
    Case result = trend("longer activation spreads more", least_ratio(damaged), 1.1, "least ratio",
                        "Sutton 2010, Hefermehl 2014: spread grows with time");
    result.note = fmt::format(
        "{:.1f}, {:.1f}, {:.1f} mm3 damaged or gone, up to {:.2f}, {:.2f}, {:.2f} mm beside the "
        "wire, after 0.5, 1, 2 s at 20 W",
        damaged[0].second, damaged[1].second, damaged[2].second, reach[0].second, reach[1].second, reach[2].second);
    result.figures.push_back(figure);
    return {result, balance("longer activation", trials)};
}

std::vector<Case> impedances(const Options& options) {
    const Trial liver = perform(options, {"spot.toml", {power(30.0)}, 0.0, {}});
    const Trial fat = perform(options, {"spot.toml", {power(30.0), "block.material=fat"}, 0.2, {}});
    Case tissue = trend("fat's impedance is far above liver's", fat.first_Ohm / liver.first_Ohm, 3.0, "ratio",
                        "conductivities 0.025 and 0.15 S/m: IT'IS database, Gabriel 1996");
    tissue.note = fmt::format("{:.0f} against {:.0f} Ohm at first contact", fat.first_Ohm, liver.first_Ohm);
    Case drying = trend("drying raises the impedance", liver.rise_of_impedance, 1.2, "to the least before",
                        "desiccated tissue insulates; generators end coagulation by it");
    drying.note = fmt::format("{:.0f} Ohm at first, {:.0f} at least, {:.0f} at last", liver.first_Ohm, liver.least_Ohm,
                              liver.last_Ohm);
    drying.figures.push_back(
        {"Impedance of a spot on liver, 30 W coag", "time, s", "Ohm", {{"impedance", liver.impedance, false}}});
    return {tissue, drying, balance("impedances", {liver, fat})};
}

/// Sutton et al. 2010. The abstract gives the tip after 5 s, the tissue at 1 cm after 10 s.
std::vector<Case> sutton(const Options& options) {
    double tip_C = 0.0, tissue_C = 0.0;
    Points at_1cm, at_metal, at_tip;
    const auto watch = [&](const simulation::Simulation& run) {
        const std::int64_t tick = run.state().tick;
        if (tick % 100 != 0) return;
        const Points surface = surface_temperature_C(run, false);
        double touching = -1e9;
        for (const auto& [x, y] : surface)
            if (x < 0.6) touching = std::max(touching, y);
        at_metal.emplace_back(run.time_s() - 0.3, touching);
        at_tip.emplace_back(run.time_s() - 0.3, celsius_from_kelvin(run.state().tip.temperature_K));
        at_1cm.emplace_back(run.time_s() - 0.3, mean_at(surface, 10.0));
        if (tick == 5300) tip_C = celsius_from_kelvin(run.state().tip.temperature_K);
        if (tick == 10300) tissue_C = at_1cm.back().second;
    };
    const Trial trial = perform(options, {"sutton-2010.toml", {}, 0.0, watch, kRest_N});
    const char* source = "Sutton et al. 2010, doi 10.1002/bjs.6901 (abstract)";
    Case tip = published("Sutton: tip after 5 s at 40 W", tip_C, 78.9 - 4.1, 78.9 + 4.1, "C", source);
    tip.note = "the wire; mean and standard deviation published";
    tip.figures.push_back({"Porcine muscle, 40 W: Sutton 2010",
                           "time, s",
                           "C",
                           {{"hottest tissue at the metal", at_metal, false},
                            {"the wire", at_tip, false},
                            {"1 cm away", at_1cm, false},
                            {"published", {{5.0, 78.9}, {10.0, 59.2}}, true}}});
    Case far = published("Sutton: tissue at 1 cm after 10 s at 40 W", tissue_C, 59.2 - 2.2, 59.2 + 2.2, "C", source);
    far.note = "surface 10 mm from the metal";
    return {tip, far, balance("Sutton 2010", {trial})};
}

/// Hefermehl et al. 2014: where an infrared camera sees 45 C.
std::vector<Case> hefermehl(const Options& options) {
    double after_1s = 0.0, after_2s = 0.0;
    Points seen;
    Figure profile{"Bovine muscle, 60 W: surface beside the metal", "distance, mm", "C", {}, false};
    const auto watch = [&](const simulation::Simulation& run) {
        if (run.state().tick % 100 != 0 || run.time_s() < 0.35) return;
        const Points surface = surface_temperature_C(run, false);
        double far = 0.0;
        for (const auto& [x, y] : surface)
            if (y >= 45.0) far = std::max(far, x);
        seen.emplace_back(run.time_s() - 0.3, far);
        const bool first = run.state().tick == 1300, second = run.state().tick == 2300;
        if (first) after_1s = far;
        if (second) after_2s = far;
        if (!first && !second) return;
        Points thinned;
        for (double x = 0.0; x < 12.0; x += 0.4)
            if (const double y = mean_at(surface, x); std::isfinite(y)) thinned.emplace_back(x, y);
        profile.curves.push_back({first ? "after 1 s" : "after 2 s", thinned, false});
    };
    const Trial trial = perform(options, {"hefermehl-2014.toml", {}, 0.0, watch, kRest_N});
    const char* source = "Hefermehl et al. 2014, BJU Int 114:245-252 (abstract)";
    Case one = published("Hefermehl: 45 C after 1 s at 60 W", after_1s, 3.5 - 2.3, 3.5 + 2.3, "mm", source);
    one.note = "mean and standard error published";
    profile.curves.push_back({"45 C", {{0.0, 45.0}, {12.0, 45.0}}, false});
    one.figures.push_back(profile);
    one.figures.push_back({"Spread of 45 C: Hefermehl 2014",
                           "time, s",
                           "mm",
                           {{"Calot", seen, false}, {"published (2 s: at least)", {{1.0, 3.5}, {2.0, 20.0}}, true}}});
    Case two = published("Hefermehl: 45 C after 2 s at 60 W", after_2s, 20.0, 30.0, "mm", source);
    two.note = "published: more than 20 mm; the band's upper end is the size of a specimen, chosen";
    return {one, two, balance("Hefermehl 2014", {trial})};
}

/// Matsuura et al. 2021: how hot the hook gets at 40 W, and how fast the tissue cools.
std::vector<Case> matsuura(const Options& options) {
    const char* source = "Matsuura et al. 2021, doi 10.31083/j.ejgo.2021.01.2311 (abstract)";
    std::vector<Trial> trials;
    std::vector<Case> cases;
    Figure figure{"Porcine muscle, 40 W: Matsuura 2021", "time after the pedal, s", "C", {}, false};
    for (const char* word : {"cut", "coag"}) {
        double tip_C = 0.0, cool_s = 4.0;  // the scene's end: not cool by then
        bool cool_yet = false;
        Points wire, tissue;
        const auto watch = [&](const simulation::Simulation& run) {
            const double tip = celsius_from_kelvin(run.state().tip.temperature_K);
            tip_C = std::max(tip_C, tip);
            const double since = run.time_s() - 1.2;
            if (since < 0.0 || run.state().tick % 50 != 0) return;
            double hottest = 0.0;
            for (const auto& [x, y] : surface_temperature_C(run, false)) hottest = std::max(hottest, y);
            wire.emplace_back(since, tip);
            tissue.emplace_back(since, hottest);
            if (hottest <= 60.0 && !cool_yet) {
                cool_s = since;
                cool_yet = true;
            }
        };
        trials.push_back(perform(options, {"matsuura-2021.toml", {mode(word)}, 0.0, watch}));
        const bool cut = std::string(word) == "cut";
        Case tip = published(fmt::format("Matsuura: hook at 40 W, {}", word), tip_C, 100.0, 300.0, "C", source);
        tip.note = "published: above 100 C at every length of activation; the upper end is chosen";
        Case cool = published(fmt::format("Matsuura: tissue cools to 60 C, {}", word), cool_s, cut ? 0.0 : 1.0,
                              cut ? 1.0 : 3.0, "s", source);
        cool.note = cut ? "hottest hexel of the surface; published: within 1 s"
                        : "hottest hexel of the surface; published: about 2 s, the band is 1 s on either side, chosen";
        if (!cool_yet) cool.note += "; not cool within the 4 s of the scene";
        cases.push_back(tip);
        cases.push_back(cool);
        figure.curves.push_back({fmt::format("wire, {}", word), wire, false});
        figure.curves.push_back({fmt::format("hottest tissue, {}", word), tissue, false});
    }
    cases[0].figures.push_back(figure);
    cases.push_back(balance("Matsuura 2021", trials));
    return cases;
}

/// Karaki et al. 2020: nothing, coagulation, cutting.
std::vector<Case> karaki(const Options& options) {
    const char* source = "Karaki et al. 2020, Comput Methods Biomech Biomed Eng 23:1317-1335 (abstract)";
    const char* names[] = {"no visible effect", "coagulation without cut", "coagulation and cut"};
    std::vector<Trial> trials;
    std::vector<Case> cases;
    Points removed, damaged;
    int wanted = 0;
    for (const double watts : {10.0, 25.0, 50.0}) {
        trials.push_back(perform(options, {"karaki-2020.toml", {power(watts)}, 0.0, {}}));
        const Trial& t = trials.back();
        // A track of 10 mm: visible from a strip half a millimetre wide and deep on, cut from a hexel's row on.
        const int effect = t.removed_mm3 > 10.0 * 0.36 ? 2 : t.damaged_mm3 > 10.0 * 0.25 ? 1 : 0;
        Case result = published(fmt::format("Karaki: {:g} W, {}", watts, names[wanted]), effect, wanted, wanted,
                                "effect 0-2", source);
        result.expected = wanted;
        result.error = std::abs(effect - wanted);
        result.tolerance = 0.0;
        result.note =
            fmt::format("{:.1f} mm3 damaged, {:.1f} mm3 removed: {}", t.damaged_mm3, t.removed_mm3, names[effect]);
        removed.emplace_back(watts, t.removed_mm3);
        damaged.emplace_back(watts, t.damaged_mm3);
        cases.push_back(result);
        ++wanted;
    }
    cases[0].figures.push_back(
        {"A blade over porcine liver: Karaki 2020",
         "power, W",
         "mm3",
         {{"damaged", damaged, false}, {"removed", removed, false}, {"", removed, true}, {"", damaged, true}}});
    const double width = trials[2].section_damage_mm / std::max(trials[1].section_damage_mm, 1e-3);
    Case little = published("Karaki: damage width, 50 W over 25 W", width, 0.7, 1.3, "1", source);
    little.note = fmt::format("{:.2f} over {:.2f} mm; published: power had little effect on it, read as within 30 %",
                              trials[2].section_damage_mm, trials[1].section_damage_mm);
    cases.push_back(little);
    cases.push_back(balance("Karaki 2020", trials));
    return cases;
}

/// Druzijanic et al. 2012: human peritoneum.
std::vector<Case> peritoneum(const Options& options) {
    const Trial trial = perform(options, {"peritoneum-2012.toml", {}, 0.0, {}});
    Case result = published("peritoneum: lateral damage of a cut", trial.section_damage_mm * 1e3, 0.5 * 216.0,
                            1.5 * 216.0, "um", "Druzijanic et al. 2012, PMC3468644 (abstract): mean 215.79 um");
    result.note = fmt::format(
        "mean of all sections across; the abstract gives a mean alone, the band is half of it on either side, chosen. "
        "{:.2f} mm3 removed, farthest damage {:.2f} mm",
        trial.removed_mm3, trial.damage_mm);
    return {result, balance("peritoneum 2012", {trial})};
}

}  // namespace

std::vector<Check> coupled_checks() {
    return {{kSuite, "power against depth", true, power_against_depth},
            {kSuite, "cut against coag", true, cut_against_coag},
            {kSuite, "longer activation", true, longer_spreads},
            {kSuite, "impedances", true, impedances},
            {kSuite, "Sutton 2010", false, sutton},
            {kSuite, "Hefermehl 2014", false, hefermehl},
            {kSuite, "Matsuura 2021", false, matsuura},
            {kSuite, "Karaki 2020", false, karaki},
            {kSuite, "peritoneum 2012", false, peritoneum}};
}

}  // namespace calot::validation
