#include "calot/anatomy/calots_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "calot/anatomy/calots_parts.h"
#include "calot/base/error.h"
#include "calot/base/hash.h"
#include "calot/base/parallel.h"
#include "calot/base/random.h"

namespace calot::anatomy {

namespace {

constexpr double mm = 1e-3;

const Shape& organ(const Anatomy& anatomy, const std::string& name) {
    for (const Organ& o : anatomy.organs)
        if (o.name == name) return *o.shape;
    throw std::runtime_error("no organ " + name);
}
const Shape& tissue(const Anatomy& anatomy, std::size_t k) {
    return *anatomy.tissues[k].shape;
}

/// Distances at fixed points all over the field, as bytes.
std::uint64_t fingerprint(const Anatomy& anatomy) {
    std::vector<double> values;
    Random random(11);
    for (int k = 0; k < 3000; ++k) {
        const Vec3 p(random.uniform(-0.05, 0.04), random.uniform(-0.03, 0.03), random.uniform(-0.02, 0.02));
        for (const auto& t : anatomy.tissues) values.push_back(t.shape->distance_m(p));
        for (const auto& o : anatomy.organs) values.push_back(o.shape->distance_m(p));
    }
    for (const auto& [name, p] : anatomy.landmarks_m) values.insert(values.end(), {p.x, p.y, p.z});
    for (const auto& [name, value] : anatomy.facts) values.push_back(value);
    return hash_bytes(values.data(), values.size() * sizeof(double));
}

/// Smallest distance between the surfaces of two tubes.
double gap_m(const std::vector<TubePoint>& a, const std::vector<TubePoint>& b) {
    double gap = 1e9;
    for (const TubePoint& p : resample(a, 120))
        for (const TubePoint& q : resample(b, 120))
            gap = std::min(gap, glm::length(p.position_m - q.position_m) - p.radius_m - q.radius_m);
    return gap;
}

/// What must hold for every patient's centre lines.
void expect_valid_layout(const TriangleLayout& layout) {
    for (const auto& artery : layout.arteries) EXPECT_GT(gap_m(artery, layout.duct), 0.2 * mm);
    const double duct = length_m(layout.duct),
                 bladder = length_m(layout.gallbladder) + layout.gallbladder.back().radius_m;
    EXPECT_GT(duct, *layout.patient.duct_length_m);            // its ends are inside the organs
    EXPECT_LT(duct, *layout.patient.duct_length_m + 12 * mm);  // 3 mm in the neck, to the axis of the common duct
    EXPECT_NEAR(bladder, *layout.patient.gallbladder_length_m, 2 * mm);
    for (const TubePoint& p : layout.duct) {
        EXPECT_GT(2 * p.radius_m, 1.7 * mm);  // published: 1 to 5 mm, with the folds' waves of 8 %
        EXPECT_LT(2 * p.radius_m, 5.5 * mm);
    }
    EXPECT_LT(layout.neck_m.x, 0.0);
    EXPECT_GT(layout.junction_m.x, 0.0);
    EXPECT_GT(layout.liver_point_m.y, layout.arteries[0][16].position_m.y);
}

/// What must hold for every patient. Tolerances: caches of the organs are off by up to 0.1 mm.
void expect_valid(const Anatomy& anatomy, const TriangleLayout& layout) {
    const auto& fact = anatomy.facts;
    // Drawn sizes come out of the finished solids.
    EXPECT_NEAR(fact.at("duct_length_mm"), *layout.patient.duct_length_m / mm, 1.0);
    EXPECT_NEAR(fact.at("gallbladder_length_mm"), *layout.patient.gallbladder_length_m / mm, 2.0);
    // 2 to 55 mm (Dandekar & Dandekar 2016); it crosses a triangle of at least 20 mm.
    EXPECT_GT(fact.at("artery_length_mm"), 15.0);
    EXPECT_LT(fact.at("artery_length_mm"), 55.0);
    // Duct and artery are hidden at the start, by a few millimetres, wherever they pass the field.
    EXPECT_GT(fact.at("fat_over_duct_least_mm"), 1.5);
    EXPECT_LT(fact.at("fat_over_duct_mm"), 9.5);
    EXPECT_GT(fact.at("fat_over_artery_least_mm"), 1.5);
    EXPECT_LT(fact.at("fat_over_artery_mm"), 9.5);
    // Along their free parts duct and artery are wrapped in fat all round.
    const Shape &fat = tissue(anatomy, 0), &duct = tissue(anatomy, 1), &artery = tissue(anatomy, 2);
    for (const auto* line : {&layout.duct, &layout.arteries[0]})
        for (const TubePoint& p : resample(*line, 21)) {
            const bool free = (line == &layout.duct ? duct : artery).distance_m(p.position_m) < -0.8 * p.radius_m;
            if (free) {
                EXPECT_LT(fat.distance_m(p.position_m), 0.0);
            }
        }
    // They end in organs.
    EXPECT_LT(organ(anatomy, "gallbladder").distance_m(layout.duct.front().position_m), 0.0);
    EXPECT_LT(organ(anatomy, "common_duct").distance_m(layout.duct.back().position_m), 0.0);
    for (const auto& line : layout.arteries)
        EXPECT_LT(organ(anatomy, "gallbladder").distance_m(line.back().position_m), 0.0);
    EXPECT_LT(organ(anatomy, "hepatic_artery").distance_m(layout.arteries[0].front().position_m), 0.0);
    // Landmarks are where they claim to be.
    const auto& at = anatomy.landmarks_m;
    for (const char* name : {"duct_start", "duct_middle", "duct_end"})
        EXPECT_LT(duct.distance_m(at.at(name)), 0.0) << name;
    for (const char* name : {"artery_start", "artery_middle", "artery_end"})
        EXPECT_LT(artery.distance_m(at.at(name)), 0.0) << name;
    for (const char* name : {"fat_window", "front_of_duct", "front_of_artery", "between"})
        EXPECT_NEAR(fat.distance_m(at.at(name)), 0.0, 0.01 * mm) << name;
    EXPECT_NEAR(at.at("front_of_duct").x, at.at("duct_middle").x, 1e-12);
    EXPECT_LT(at.at("gallbladder_neck").x, at.at("duct_middle").x);
    EXPECT_LT(at.at("duct_middle").x, at.at("common_duct").x);
    EXPECT_GT(at.at("artery_middle").y, at.at("duct_middle").y);
    EXPECT_LT(glm::length(at.at("triangle")), 6 * mm);  // the origin is the middle of the triangle
    // Instruments and eye have free way to the field.
    for (const char* from : {"trocar", "camera"})
        for (int k = 0; k < 50; ++k) {
            const Vec3 p = glm::mix(at.at(from), at.at("fat_window") + Vec3(0, 0, 1 * mm), k / 49.0);
            for (const Organ& o : anatomy.organs) EXPECT_GT(o.shape->distance_m(p), 0.0) << from << " " << o.name;
        }
}

}  // namespace

TEST(CalotsTriangle, EveryPatientIsValidAndNoTwoAreAlike) {
    constexpr int kPatients = 100;
    std::set<std::uint64_t> fingerprints;
    int anterior = 0, doubled = 0;
    for (std::uint64_t seed = 1; seed <= kPatients; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const TriangleLayout layout = lay_out(draw_triangle({.seed = seed}));
        expect_valid_layout(layout);
        anterior += *layout.patient.artery_anterior;
        doubled += *layout.patient.double_artery;
        if (seed % 3 != 1) continue;  // the whole anatomy of every third
        const Anatomy anatomy = make_calots_triangle({.seed = seed});
        expect_valid(anatomy, layout);
        fingerprints.insert(fingerprint(anatomy));
    }
    EXPECT_EQ(fingerprints.size(), (kPatients + 2) / 3);
    // 15 and 10 of a hundred are expected; five standard deviations either way.
    EXPECT_NEAR(anterior, 15, 18);
    EXPECT_GT(anterior, 0);
    EXPECT_NEAR(doubled, 10, 15);
    EXPECT_GT(doubled, 0);
}

TEST(CalotsTriangle, EveryVariantIsValidAtTheEndsOfItsRanges) {
    for (const TriangleQuantity& q : triangle_quantities())
        for (const double value : {q.least, q.most})
            for (const bool anterior : {false, true}) {
                SCOPED_TRACE(std::string(q.name) + " = " + std::to_string(value) + (anterior ? ", anterior" : ""));
                TriangleParameters parameters{.seed = 3, .artery_anterior = anterior, .double_artery = true};
                parameters.*q.member = value;
                const TriangleLayout layout = lay_out(draw_triangle(parameters));
                expect_valid_layout(layout);
                if (anterior == (value == q.most)) expect_valid(make_calots_triangle(parameters), layout);
            }
}

TEST(CalotsTriangle, GivingOneValueChangesNoOther) {
    const TriangleParameters all = draw_triangle({.seed = 5});
    const TriangleParameters some = draw_triangle({.seed = 5, .duct_length_m = 0.03, .double_artery = true});
    EXPECT_EQ(*some.duct_length_m, 0.03);
    for (const TriangleQuantity& q : triangle_quantities()) {
        if (q.member != &TriangleParameters::duct_length_m) {
            EXPECT_EQ(*(all.*q.member), *(some.*q.member)) << q.name;
        }
        EXPECT_GE(*(all.*q.member), q.drawn_low);
        EXPECT_LE(*(all.*q.member), q.drawn_high);
        EXPECT_LE(q.least, q.drawn_low);
        EXPECT_GE(q.most, q.drawn_high);
    }
    EXPECT_EQ(*all.artery_anterior, *some.artery_anterior);
}

TEST(CalotsTriangle, RefusesSizesOutOfRange) {
    EXPECT_THROW(make_calots_triangle({.duct_length_m = 0.1}), InputError);
    EXPECT_THROW(make_calots_triangle({.fat_thickness_m = std::nan("")}), InputError);
}

TEST(CalotsTriangle, SameSeedSameBytes) {
    const std::uint64_t once = fingerprint(make_calots_triangle({.seed = 42}));
    const ThreadLimit one(1);
    EXPECT_EQ(fingerprint(make_calots_triangle({.seed = 42})), once);
}

TEST(CalotsTriangle, DistancesAreBounds) {
    const Anatomy anatomy = make_calots_triangle({.seed = 2, .double_artery = true});
    Random random(9);
    for (int k = 0; k < 20000; ++k) {
        const Vec3 p(random.uniform(-0.06, 0.05), random.uniform(-0.04, 0.04), random.uniform(-0.03, 0.03));
        const double reach = random.uniform() < 0.5 ? 0.5 * mm : 10 * mm;
        const Vec3 q =
            p + Vec3(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach));
        auto check = [&](const Shape& shape, const std::string& name) {
            ASSERT_LE(std::abs(shape.distance_m(p) - shape.distance_m(q)), kDistanceSlack * glm::length(p - q) + 1e-9)
                << name;
        };
        for (const auto& t : anatomy.tissues) check(*t.shape, t.name);
        for (const auto& o : anatomy.organs) check(*o.shape, o.name);
    }
}

}  // namespace calot::anatomy
