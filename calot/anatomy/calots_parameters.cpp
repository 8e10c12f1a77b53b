// What varies from patient to patient, with published ranges.

#include <fmt/format.h>

#include "calot/anatomy/calots_triangle.h"
#include "calot/base/error.h"
#include "calot/base/random.h"
#include "calot/base/units.h"

namespace calot::anatomy {

namespace {

constexpr double mm = kMillimetre;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

// Shares of patients.
// Cystic artery crossing the duct in front or below it: 0.3 % (Fateh 2012) to 4.9 % (Andall et al. 2016, review of 9800
// cases); in front of the common hepatic duct 17.9 % (Andall). Chosen 0.15, so that trainees meet it.
constexpr double kAnteriorShare = 0.15;
// Double cystic artery: 8.9 % (Andall et al. 2016), 12.2 % (Ding et al. 2007), 13 % [11, 16] (meta-analysis, Clin Ter
// 2024;175:184).
constexpr double kDoubleShare = 0.10;

double uniform(std::uint64_t seed, std::uint64_t stream) {
    return Random(seed, stream).uniform();
}

}  // namespace

const std::vector<TriangleQuantity>& triangle_quantities() {
    using P = TriangleParameters;
    static const std::vector<TriangleQuantity> quantities{
        {"duct_length", &P::duct_length_m, 24 * mm, 38 * mm, 20 * mm, 40 * mm,
         "usually 2 to 4 cm (Priya et al. 2023, Folia Morphol 82:498)"},
        {"duct_diameter", &P::duct_diameter_m, 2.8 * mm, 4.4 * mm, 2 * mm, 5 * mm,
         "lumen 2 to 3 mm, whole 1 to 5 mm; drawn where the lattice resolves it"},
        {"duct_angle", &P::duct_angle_rad, 8 * kDegree, 28 * kDegree, 0, 40 * kDegree,
         "chosen: infundibulum pulled to the side opens the angle to the common duct"},
        {"artery_diameter", &P::artery_diameter_m, 1.6 * mm, 2.3 * mm, 1.2 * mm, 3 * mm,
         "mean 1.91 mm (Clin Ter 2024;175:184), 1.6 mm, 1 to 5 (Dandekar & Dandekar 2016)"},
        {"artery_gap", &P::artery_gap_m, 9 * mm, 13 * mm, 7 * mm, 15 * mm,
         "chosen; the artery runs above the duct in 94.7 % (Fateh 2012)"},
        {"common_duct_diameter", &P::common_duct_diameter_m, 5 * mm, 7 * mm, 4 * mm, 9 * mm,
         "2 to 8 mm (Gulwani, PathologyOutlines)"},
        {"gallbladder_length", &P::gallbladder_length_m, 72 * mm, 100 * mm, 60 * mm, 120 * mm,
         "7.5 to 12 cm; 10 cm by 4 cm depending on filling (Gulwani)"},
        {"gallbladder_width", &P::gallbladder_width_m, 30 * mm, 38 * mm, 25 * mm, 42 * mm, "3 to 4 cm (as above)"},
        {"fat_thickness", &P::fat_thickness_m, 2.4 * mm, 4.4 * mm, 2 * mm, 6 * mm,
         "chosen: from slender to heavy patients"},
        {"lobule_size", &P::lobule_size_m, 4.6 * mm, 6.4 * mm, 3 * mm, 8 * mm, "chosen from laparoscopic pictures"},
        {"lobule_height", &P::lobule_height_m, 1.0 * mm, 1.7 * mm, 0, 2.2 * mm, "chosen from laparoscopic pictures"},
    };
    return quantities;
}

TriangleParameters draw_triangle(const TriangleParameters& parameters) {
    TriangleParameters drawn = parameters;
    std::uint64_t stream = 0;
    for (const TriangleQuantity& q : triangle_quantities()) {
        // A stream for each value: giving one, or adding one at the end, leaves the others as they were.
        const double value = q.drawn_low + (q.drawn_high - q.drawn_low) * uniform(parameters.seed, ++stream);
        std::optional<double>& member = drawn.*q.member;
        if (!member) member = value;
        // A ten-billionth of slack for values that came from millimetres or degrees.
        const double slack = 1e-10 + 1e-10 * q.most;
        if (!(*member >= q.least - slack && *member <= q.most + slack))
            throw InputError(fmt::format("{} of Calot's triangle is {:g}", q.name, *member),
                             fmt::format("use {:g} to {:g} (SI units)", q.least, q.most));
    }
    if (!drawn.artery_anterior) drawn.artery_anterior = uniform(parameters.seed, 1001) < kAnteriorShare;
    if (!drawn.double_artery) drawn.double_artery = uniform(parameters.seed, 1002) < kDoubleShare;
    return drawn;
}

}  // namespace calot::anatomy
