// The oracle itself: verdicts, orders, and that a spoilt simulation is noticed.

#include <gtest/gtest.h>

#include <cmath>

#include "calot/validation/case.h"
#include "calot/validation/closed_forms.h"

namespace calot::validation {

namespace {

std::vector<Case> run(const std::vector<Check>& checks, const std::string& name, const Options& options) {
    for (const Check& check : checks)
        if (check.name == name) return check.run(options);
    ADD_FAILURE() << "no check " << name;
    return {};
}

int failures(const std::vector<Case>& cases) {
    int count = 0;
    for (const Case& c : cases) count += c.verdict == Verdict::fail;
    return count;
}

}  // namespace

TEST(Oracle, JudgesByToleranceOrderAndBand) {
    EXPECT_EQ(compare("heat", "a", 1.009, 1.0, "1", 0.01, "").verdict, Verdict::pass);
    EXPECT_EQ(compare("heat", "a", 1.011, 1.0, "1", 0.01, "").verdict, Verdict::fail);
    EXPECT_EQ(compare("heat", "a", NAN, 1.0, "1", 0.01, "").verdict, Verdict::fail);
    EXPECT_EQ(trend("a", 1.0, 1.0, "1", "").verdict, Verdict::pass);
    EXPECT_EQ(trend("a", 0.99, 1.0, "1", "").verdict, Verdict::fail);
    EXPECT_EQ(trend("a", NAN, 1.0, "1", "").verdict, Verdict::fail);
    EXPECT_EQ(published("a", 5.0, 4.0, 6.0, "mm", "").verdict, Verdict::band);
    EXPECT_EQ(published("a", 6.1, 4.0, 6.0, "mm", "").verdict, Verdict::outside);
    Case result = compare("heat", "a", 1.001, 1.0, "1", 0.01, "");
    converge(result, {{4, 0.16}, {8, 0.04}, {16, 0.01}}, 1.5, "cells");
    EXPECT_NEAR(*result.order, 2.0, 1e-12);
    EXPECT_EQ(result.verdict, Verdict::pass);
    converge(result, {{4, 0.04}, {8, 0.02}, {16, 0.01}}, 1.5, "cells");
    EXPECT_EQ(result.verdict, Verdict::fail) << "converges too slowly";
}

TEST(Oracle, ClosedFormsHaveTheirKnownValues) {
    EXPECT_NEAR(square_torsion_constant(), 0.1406, 5e-5);  // Timoshenko & Goodier 1970
    EXPECT_NEAR(cooled_slab(1.0, 0.0, 0.5), 1.0, 1e-2);    // the start, whose series converges slowly
    EXPECT_NEAR(cooled_sphere(1e-3, 10.0, 0.0), std::exp(-3.0 * 1e-3 * 10.0), 1e-3);  // lumped
    EXPECT_NEAR(cooled_slab(1e-3, 10.0, 0.0), std::exp(-1e-3 * 10.0), 1e-3);
    EXPECT_NEAR(layered_disc_factor(1.0, 1.0, 3.0), 1.0, 1e-12);
    // A thick insulator below a thin layer: R grows; a metal below: R falls; far below neither matters.
    EXPECT_GT(layered_disc_factor(1.0, 0.01, 1.0), 2.0);
    EXPECT_LT(layered_disc_factor(1.0, 100.0, 1.0), 0.8);
    EXPECT_NEAR(layered_disc_factor(1.0, 100.0, 300.0), 1.0, 3e-3);
    const double lambda = stefan_lambda(1.0);
    EXPECT_NEAR(lambda * std::exp(lambda * lambda) * std::erf(lambda), 1.0 / std::sqrt(M_PI), 1e-9);
}

/// Every parameter that can be spoilt makes a case fail that passes without.
TEST(Oracle, NoticesASpoiltSimulation) {
    struct Row {
        std::vector<Check> checks;
        const char *check, *parameter;
        double factor;
    };
    for (const Row& row :
         {Row{deformation_checks(), "cube", "youngs_modulus", 1.1},
          Row{heat_checks(), "heated half-space", "thermal_conductivity", 2.0},
          Row{electric_checks(), "point electrode", "electric_conductivity", 2.0},
          Row{phase_checks(), "lumped boil-off", "water", 0.9}, Row{phase_checks(), "Arrhenius damage", "damage", 1.1},
          Row{surface_checks(), "sphere", "surface_radius", 1.05}}) {
        Options options;
        options.quick = true;
        EXPECT_EQ(failures(run(row.checks, row.check, options)), 0) << row.check;
        ASSERT_TRUE(options.spoil.set(row.parameter, row.factor));
        EXPECT_GT(failures(run(row.checks, row.check, options)), 0) << row.check << " with " << row.parameter;
    }
    EXPECT_FALSE(Spoil().set("colour", 2.0));
}

}  // namespace calot::validation
