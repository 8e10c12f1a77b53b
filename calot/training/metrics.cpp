#include "calot/training/metrics.h"

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "calot/base/units.h"

namespace calot::training {

namespace {

constexpr double kPercent = 100.0;
constexpr double kMm = 1e3;
constexpr double kMm3 = 1e9;
constexpr double kToCelsius = -kKelvinAtZeroCelsius;

constexpr const char* kStrasberg = "Strasberg & Brunt 2010, J Am Coll Surg 211:132 (critical view of safety)";
constexpr const char* kSanford =
    "Sanford & Strasberg 2014, J Am Coll Surg 218:170 (0 to 2 points a criterion), thresholds chosen";
constexpr const char* kMotion = "Datta et al. 2001, J Am Coll Surg 193:479 (hand motion analysis)";
constexpr const char* kSparc = "Balasubramanian et al. 2015, J NeuroEng Rehabil 12:112";
constexpr const char* kArrhenius = "Henriques & Moritz 1947; parameters per tissue in `calot scene --defaults`";
constexpr const char* kFuse = "Feldman et al. 2012, The SAGES FUSE manual: activate only in contact, in short bursts";

}  // namespace

const std::vector<Metric>& metric_table() {
    using B = Better;
    static const std::vector<Metric> table{
        {"time_s", "Time", "s", 1, 0, B::less, "ticks * 1 ms, from the first tick to the end", ""},
        {"duct_exposed", "Cystic duct exposed, towards the lens", "%", kPercent, 0, B::more,
         "surface hexels of the duct that face the laparoscope (within 60 degrees) with 1.5 mm of free space along "
         "their outward normal / all such hexels",
         kStrasberg},
        {"artery_exposed", "Cystic artery exposed, towards the lens", "%", kPercent, 0, B::more, "as for the duct",
         kStrasberg},
        {"duct_freed", "Cystic duct freed, all round", "%", kPercent, 0, B::more,
         "surface hexels of the duct, all round, with 1.5 mm of free space along their outward normal / all that no "
         "organ covers",
         kStrasberg},
        {"artery_freed", "Cystic artery freed, all round", "%", kPercent, 0, B::more, "as for the duct", kStrasberg},
        {"triangle_cleared", "Calot's triangle cleared of fat", "%", kPercent, 0, B::more,
         "fat hexels removed / fat hexels at the start, of those that lie between duct and artery as the laparoscope "
         "sees them (same x, y between the two)",
         kStrasberg},
        {"cvs_points", "Critical view of safety, two of its three criteria", "of 4", 1, 0, B::more,
         "two structures: 2 points when duct and artery are both exposed to 60 %, 1 at 30 %; triangle: 2 points when "
         "60 % of its fat is gone, 1 at 30 %. The cystic plate (third criterion) is not in the scene",
         kSanford},
        {"fat_removed_m3", "Fat removed", "mm³", kMm3, 0, B::neither, "fat hexels burnt or fallen * volume of a hexel",
         ""},
        {"hook_path_m", "Path of the hook", "mm", kMm, 0, B::less, "sum over ticks of |change of the tip's position|",
         kMotion},
        {"hook_movements", "Movements of the hook", "", 1, 0, B::less,
         "spans of at least 0.3 s in which the tip is faster than 5 mm/s (speed over 20 ms)", kMotion},
        {"hook_smoothness", "Smoothness of the hook (SPARC)", "", 1, 0, B::more,
         "spectral arc length of the tip's speed profile, up to 10 Hz or where its spectrum stays below 0.05 of its "
         "start; mean over movements, weighted by their duration; about -1.4 is as smooth as a reach can be",
         kSparc},
        {"grasper_path_m", "Path of the grasper", "mm", kMm, 0, B::less, "as for the hook", kMotion},
        {"grasper_smoothness", "Smoothness of the grasper (SPARC)", "", 1, 0, B::more, "as for the hook", kSparc},
        {"activations", "Activations", "", 1, 0, B::neither, "times that the pedal goes down", kFuse},
        {"activation_s", "Activation time", "s", 1, 0, B::less, "ticks with the pedal down", kFuse},
        {"activation_contact_s", "Activation time with contact", "s", 1, 0, B::neither,
         "ticks with the pedal down and a current into tissue", kFuse},
        {"activation_open_s", "Activation time without contact", "s", 1, 0, B::less,
         "ticks with the pedal down and no current: the open electrode may spark to what it should not", kFuse},
        {"longest_activation_s", "Longest activation", "s", 1, 0, B::less, "longest span with the pedal down", kFuse},
        {"activation_under_traction", "Activation under traction", "%", kPercent, 0, B::more,
         "share of activation time with contact in which the hook pulls towards its trocar with at least 0.05 N",
         kFuse},
        {"energy_J", "Energy delivered", "J", 1, 0, B::less, "integral of the generator's power", ""},
        {"duct_energy_J", "Electric heat in the duct", "J", 1, 0, B::less,
         "integral of sigma |grad phi|^2 over the duct's hexels", ""},
        {"artery_energy_J", "Electric heat in the artery", "J", 1, 0, B::less, "as for the duct", ""},
        {"duct_current_density_A_per_m2", "Greatest current density in the duct", "mA/mm²", 1e-3, 0, B::less,
         "sqrt(sigma q), q the electric heat per volume of a hexel, sigma as it is then", ""},
        {"artery_current_density_A_per_m2", "Greatest current density in the artery", "mA/mm²", 1e-3, 0, B::less,
         "as for the duct", ""},
        {"duct_peak_K", "Hottest spot of the duct", "°C", 1, kToCelsius, B::less,
         "greatest peak temperature of its hexels", ""},
        {"artery_peak_K", "Hottest spot of the artery", "°C", 1, kToCelsius, B::less,
         "greatest peak temperature of its hexels", ""},
        {"liver_peak_K", "Hottest spot at the liver", "°C", 1, kToCelsius, B::less,
         "greatest peak temperature of hexels that touch the liver; the liver itself is rigid and holds no hexels", ""},
        {"duct_injured_m3", "Duct injured", "mm³", kMm3, 0, B::less,
         "hexels with Arrhenius integral Omega >= 1, or burnt away, * volume of a hexel", kArrhenius},
        {"artery_injured_m3", "Artery injured", "mm³", kMm3, 0, B::less, "as for the duct", kArrhenius},
        {"duct_burnt_m3", "Duct burnt away", "mm³", kMm3, 0, B::less,
         "hexels of the duct that are gone * volume of a hexel", ""},
        {"artery_burnt_m3", "Artery burnt away", "mm³", kMm3, 0, B::less,
         "hexels of the artery that are gone * volume of a hexel", ""},
        {"liver_injured_m3", "Tissue at the liver injured", "mm³", kMm3, 0, B::less,
         "hexels that touch the liver with Omega >= 1 * volume of a hexel", kArrhenius},
        {"hidden_injury_m3", "Injury that nobody saw", "mm³", kMm3, 0, B::less,
         "hexels of duct and artery with Omega >= 1 that are still there and not exposed * volume of a hexel",
         kArrhenius},
        {"organ_touch_s", "Energised contact with an organ", "s", 1, 0, B::less,
         "ticks with the pedal down and bare metal within 0.1 mm of liver, gallbladder, bile duct or bowel (looked at "
         "every 4th tick)",
         kFuse},
        {"hot_touch_s", "Hot tip on duct or artery", "s", 1, 0, B::less,
         "ticks in contact with duct or artery with the pedal up and the wire at 60 C or more: it stays hot for "
         "seconds",
         "Govekar et al. 2011, Surg Endosc 25:3499 (residual heat of laparoscopic energy devices)"},
        {"bleeding_s", "Bleeding", "s", 1, 0, B::less,
         "time since the first cubic millimetre of the artery burnt away: a hole through its wall", ""},
        {"bile_leak_s", "Bile leak", "s", 1, 0, B::less, "time since the first cubic millimetre of the duct burnt away",
         ""},
        {"force_peak_N", "Greatest force on the hook", "N", 1, 0, B::less,
         "greatest |F| of tissue and organs on the hook, mean over a tick", ""},
        {"pull_peak_N", "Greatest pull", "N", 1, 0, B::neither, "greatest -F.u, u from the tip towards the trocar", ""},
        {"gentle_contact", "Gentle contact", "%", kPercent, 0, B::more,
         "share of the time in contact with |F| below 0.5 N", ""},
        {"targets_touched", "Targets touched", "", 1, 0, B::more,
         "places of the task that the tip came to, in contact with tissue", ""},
        {"targets_left", "Targets left", "", 1, 0, B::less, "places of the task less those touched", ""},
    };
    return table;
}

const Metric* find_metric(const std::string& name) {
    for (const Metric& metric : metric_table())
        if (name == metric.name) return &metric;
    return nullptr;
}

std::string shown(const Metric& metric, double value) {
    if (std::isnan(value)) return "–";
    const double number = value * metric.factor + metric.offset;
    std::string text;
    if (std::abs(number) >= 100.0 || number == std::floor(number))
        text = fmt::format("{:.0f}", number);
    else if (std::abs(number) >= 10.0)
        text = fmt::format("{:.1f}", number);
    else
        text = fmt::format("{:.2f}", number);
    return *metric.unit ? text + " " + metric.unit : text;
}

}  // namespace calot::training
