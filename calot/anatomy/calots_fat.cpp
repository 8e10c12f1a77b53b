// The fat of Calot's triangle: a saddle slung between the gallbladder's neck, the liver's edge and the common duct,
// soft ridges over duct and artery, lobules all over.
//
//   section (y, z):      liver /        A ridge is a swept ball that reaches back to the peritoneum: behind its axis
//                  ___    ___ /         only the distance in the picture's plane counts. Ridges are blended, so that
//                 (   \__/   (          between them the front sags.
//      front  <-  ( duct  art.|  back
//                  \__________|

#include <algorithm>
#include <cmath>

#include "calot/anatomy/calots_parts.h"
#include "calot/anatomy/noise.h"
#include "calot/anatomy/shapes.h"
#include "calot/base/units.h"

namespace calot::anatomy {

namespace {

constexpr double mm = kMillimetre;
using Vec2 = glm::dvec2;

/// How much wider a ridge gets per depth behind its axis: the fat thins out towards what it lies on.
constexpr double kSkirt = 0.34;

class Ridge {
  public:
    /// Along `points`, from them back to z = `back_m`.
    Ridge(const std::vector<TubePoint>& points, double back_m) : bounds_{Vec3(1e9), Vec3(-1e9)} {
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Vec3 at = points[k].position_m;
            const double radius = points[k].radius_m, wide = radius + kSkirt * std::max(at.z - back_m, 0.0);
            bounds_.low = glm::min(bounds_.low, Vec3(at.x - wide, at.y - wide, back_m));
            bounds_.high = glm::max(bounds_.high, Vec3(at.x + wide, at.y + wide, at.z + radius));
            if (k == 0) continue;
            const TubePoint &a = points[k - 1], &b = points[k];
            const Vec2 ab(b.position_m - a.position_m);
            if (glm::dot(ab, ab) == 0.0) continue;
            pieces_.push_back({Vec2(a.position_m), ab, 1.0 / glm::dot(ab, ab), a.position_m.z,
                               b.position_m.z - a.position_m.z, a.radius_m, b.radius_m - a.radius_m});
        }
    }
    /// Not divided by its slope (FatShape does that for all).
    double distance_m(const Vec3& p) const {
        double nearest = 1e9;
        for (const Piece& s : pieces_) {
            const Vec2 ap = Vec2(p) - s.a;
            const double u = std::clamp(glm::dot(ap, s.ab) * s.inverse_square, 0.0, 1.0);
            const Vec2 off = ap - u * s.ab;
            const double before = p.z - (s.z + u * s.z_growth), front = std::max(before, 0.0);
            const double radius = s.radius + u * s.radius_growth + kSkirt * (front - before);
            nearest = std::min(nearest, std::sqrt(glm::dot(off, off) + front * front) - radius);
        }
        return nearest;
    }
    const Box& bounds_m() const { return bounds_; }

  private:
    struct Piece {
        Vec2 a, ab;
        double inverse_square, z, z_growth, radius, radius_growth;
    };
    std::vector<Piece> pieces_;
    Box bounds_;
};

/// An organ that the fat clings to, and how wide the fillet between them is.
struct Footing {
    ShapePtr organ;
    double blend_m;
};

class FatShape final : public Shape {
  public:
    FatShape(std::vector<Ridge> ridges, std::vector<Footing> footings, double lobule_size_m, double lobule_height_m,
             std::uint32_t seed)
        : ridges_(std::move(ridges)),
          footings_(std::move(footings)),
          lobule_size_(lobule_size_m),
          lobule_height_(lobule_height_m),
          seed_(seed),
          bounds_{Vec3(1e9), Vec3(-1e9)} {
        for (const Ridge& ridge : ridges_) {
            bounds_.low = glm::min(bounds_.low, ridge.bounds_m().low);
            bounds_.high = glm::max(bounds_.high, ridge.bounds_m().high);
        }
        const double margin = kBlend + kFoldHeight + lobule_height_;
        bounds_.low -= Vec3(margin, margin, 0.0);
        bounds_.high += margin;
    }
    Box bounds_m() const override { return bounds_; }

    double distance_m(const Vec3& p) const override {
        double smooth = 1e9;
        for (const Ridge& ridge : ridges_) smooth = smooth_min(smooth, ridge.distance_m(p), kBlend);
        // It runs out softly on what it lies on, instead of standing on it like a block.
        const double body = smooth;
        for (const Footing& f : footings_)
            smooth = std::min(smooth, smooth_min(body, f.organ->distance_m(p) + kFootingDepth, f.blend_m));
        // Lobules and folds grow outwards from the smooth body and fade away from its surface.
        // They go flat where the feet run out.
        const double rim = std::clamp(1.2 - (body - smooth) / kRim, 0.0, 1.0);
        const double fade = rim * (1.0 - std::min(std::abs(smooth) / kBand, 1.0));
        double grown = smooth;
        if (fade > 0.0) {
            const double lobules =
                lobule_noise(p / lobule_size_, seed_) + 0.22 * lobule_noise(p / (0.42 * lobule_size_), seed_ + 1);
            const double folds = 0.5 + 0.5 * gradient_noise(p / kFoldSize, seed_ + 2);
            grown -= std::min(2.0 * fade, 1.0) * (lobule_height_ * lobules + kFoldHeight * folds);
        }
        // Far away, the smooth body less all that may grow on it is the better bound.
        const double bound = std::max(grown / kSlope, (smooth - 1.22 * lobule_height_ - kFoldHeight) / kRidgeSlope);
        return std::max(bound, box_distance_m(bounds_, p));
    }

  private:
    static constexpr double kBlend = 7 * mm;  ///< width of the seams between ridges
    static constexpr double kFoldHeight = 1.6 * mm, kFoldSize = 13 * mm;
    static constexpr double kBand = 6 * mm;      ///< lobules reach so far from the smooth surface
    static constexpr double kRim = 3 * mm;       ///< the same for feet, in what they add
    static constexpr double kRidgeSlope = 1.15;  ///< of ridges and feet
    static constexpr double kSlope = 2.2;        ///< of the grown surface; the distance is divided by it

    /// So far inside the organs the fat's feet end: beyond the depth to which organs are cut out of it, so that no film
    /// of fat covers an organ away from the fillet.
    static constexpr double kFootingDepth = 1.2 * mm;

    std::vector<Ridge> ridges_;
    std::vector<Footing> footings_;
    double lobule_size_, lobule_height_;
    std::uint32_t seed_;
    Box bounds_;
};

/// `points` with other radii.
std::vector<TubePoint> thickened(std::vector<TubePoint> points, double by_m) {
    for (TubePoint& p : points) p.radius_m += by_m;
    return points;
}

}  // namespace

ShapePtr make_fat(const TriangleLayout& t, const std::vector<Organ>& organs) {
    const double cover = *t.patient.fat_thickness_m, back = t.backdrop_z_m - 5.0 * mm;
    const Vec3 neck = t.neck_m, j = t.junction_m, top = t.liver_point_m;
    auto at_mm = [](double x, double y, double z) { return Vec3(x, y, z) * mm; };
    std::vector<Ridge> ridges;
    auto add = [&](const std::vector<TubePoint>& points, int count) {
        ridges.emplace_back(resample(points, count), back);
    };
    add(thickened(t.duct, cover), 13);
    for (const auto& artery : t.arteries) add(thickened(artery, cover - 1.2 * mm), 12);
    // Sling along the liver: from above the neck, sagging, to the common hepatic duct.
    add(smooth_curve({{neck + at_mm(-8, 9, -3), 4.5 * mm},
                      {Vec3(-3 * mm, top.y - 5.5 * mm, -4.5 * mm), 4.5 * mm},
                      {Vec3(j.x - 1 * mm, top.y - 4 * mm, j.z - 1 * mm), 5.0 * mm}},
                     5),
        9);
    // Along the common duct.
    add(smooth_curve({{Vec3(j.x + 1 * mm, top.y - 3 * mm, j.z - 2 * mm), 5.0 * mm},
                      {j + at_mm(2.0, 3, -0.5), 4.6 * mm},
                      {j + at_mm(1.5, -9, -2), 5.0 * mm}},
                     4),
        8);
    // The hem that hangs below the duct.
    const Vec3 hem = 0.5 * (neck + j) + Vec3(0, varied(t, 31, -9.0, -7.0) * mm, -2.5 * mm);
    add(smooth_curve({{neck + at_mm(-3, -7, -2), 3.5 * mm},
                      {hem, varied(t, 32, 2.6, 4.2) * mm},
                      {j + at_mm(1, -8, -3), 4.2 * mm}},
                     4),
        8);
    std::vector<Footing> footings;
    for (const Organ& organ : organs) {
        if (organ.name == "peritoneum") footings.push_back({organ.shape, 8 * mm});
        if (organ.name == "liver") footings.push_back({organ.shape, 7 * mm});
        if (organ.name == "gallbladder") footings.push_back({organ.shape, 6 * mm});
    }
    return std::make_shared<FatShape>(std::move(ridges), std::move(footings), *t.patient.lobule_size_m,
                                      *t.patient.lobule_height_m, static_cast<std::uint32_t>(t.patient.seed * 16 + 5));
}

}  // namespace calot::anatomy
