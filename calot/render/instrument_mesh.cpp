#include "calot/render/instrument_mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calot/render/jaw_mesh.h"

namespace calot::render {

namespace {

constexpr double kJaw_m = 2e-3;  ///< thinner pieces of the grasper are its jaws
constexpr int kSides = 24;
constexpr double kBendInRadii = 2.4;     ///< radius of the bend's middle line
constexpr double kJoined_m = 1e-5;       ///< ends closer than this are one joint
constexpr double kThin_m = 1e-3;         ///< insulated pieces thinner than this radius are sleeves
constexpr double kSleeveInRadii = 1.45;  ///< a sleeve's radius in those of its wire
constexpr double kTau = 6.283185307179586;

/// A ring of the tube.
struct Ring {
    Vec3 centre_m;
    Vec3 along;  ///< unit
    double radius_m;
    double slope;  ///< of the normal along the axis: d radius / d length seen from outside
    float metal, pale;
};

/// Grows a tube ring by ring; sharp edges are two rings at one place.
class Tube {
  public:
    explicit Tube(InstrumentMesh& mesh) : mesh_(mesh) {}
    void add(const Ring& ring) {
        if (!started_) {
            across_ = std::abs(ring.along.x) < 0.8 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
        } else {
            axial_m_ += glm::length(ring.centre_m - last_m_);
        }
        across_ = glm::normalize(across_ - glm::dot(across_, ring.along) * ring.along);  // carried along without twist
        const Vec3 other = glm::cross(ring.along, across_);
        const auto first = static_cast<std::uint32_t>(mesh_.vertex.size());
        for (int side = 0; side <= kSides; ++side) {
            const double turn = static_cast<double>(side % kSides) / kSides;
            const Vec3 out = std::cos(kTau * turn) * across_ + std::sin(kTau * turn) * other;
            InstrumentVertex vertex;
            vertex.world_m = Vec3f(ring.centre_m + ring.radius_m * out);
            vertex.normal = Vec3f(glm::normalize(out - ring.slope * ring.along));
            vertex.along = Vec3f(ring.along);
            vertex.metal = ring.metal;
            vertex.pale = ring.pale;
            vertex.axial_mm = static_cast<float>(1e3 * axial_m_);
            vertex.around = static_cast<float>(side) / kSides;
            mesh_.vertex.push_back(vertex);
        }
        if (started_) {
            const std::uint32_t before = first - (kSides + 1);
            for (std::uint32_t side = 0; side < kSides; ++side) {
                const std::uint32_t a = before + side, b = a + 1, c = first + side, d = c + 1;
                mesh_.index.insert(mesh_.index.end(), {a, b, c, b, d, c});
            }
        }
        last_m_ = ring.centre_m;
        started_ = true;
    }
    /// A rounded end: half of an ellipsoid of the given length, growing (`sign` +1, at the start) or shrinking.
    void add_cap(const Vec3& centre_m, const Vec3& along, double radius_m, double length_m, bool at_start, float metal,
                 float pale) {
        constexpr int kRings = 6;
        for (int k = 0; k <= kRings; ++k) {
            const double t = at_start ? static_cast<double>(k) / kRings : 1.0 - static_cast<double>(k) / kRings;
            const double angle = 0.25 * kTau * t;  // 0 at the pole
            const double sine = std::max(0.02, std::sin(angle)), cosine = std::cos(angle);
            const double side = at_start ? -1.0 : 1.0;
            const double slope = -side * (cosine / sine) * (radius_m / length_m);
            add({centre_m + side * cosine * length_m * along, along, radius_m * sine, slope, metal, pale});
        }
    }

  private:
    InstrumentMesh& mesh_;
    Vec3 across_{1, 0, 0};
    Vec3 last_m_{0};
    double axial_m_ = 0.0;
    bool started_ = false;
};

bool joined(const Vec3& a, const Vec3& b) {
    return glm::length(a - b) < kJoined_m;
}

/// A piece of a chain from `from` to `to`.
struct Piece {
    Vec3 from_m, to_m;
    double radius_m;
    bool bare;
};

/// Takes capsules that share ends and have about the same radius out of `left`, in order along the chain.
std::vector<Piece> take_chain(std::vector<tissue::Capsule>& left) {
    auto piece = [](const tissue::Capsule& c) { return Piece{c.a_m, c.b_m, c.radius_m, c.bare}; };
    std::vector<Piece> chain{piece(left.front())};
    left.erase(left.begin());
    for (bool grown = true; grown;) {
        grown = false;
        for (std::size_t k = 0; k < left.size(); ++k) {
            Piece next = piece(left[k]);
            if (std::abs(next.radius_m - chain.front().radius_m) > 0.3 * chain.front().radius_m) continue;
            const Vec3 head = chain.front().from_m, tail = chain.back().to_m;
            if (joined(next.to_m, tail) || joined(next.from_m, head)) std::swap(next.from_m, next.to_m);
            if (joined(next.from_m, tail)) {
                chain.push_back(next);
            } else if (joined(next.to_m, head)) {
                chain.insert(chain.begin(), next);
            } else {
                continue;
            }
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
            grown = true;
            break;
        }
    }
    return chain;
}

/// Wire with rounded bends; insulated pieces become thicker pale sleeves.
void add_wire(const std::vector<Piece>& chain, InstrumentMesh& mesh) {
    Tube tube(mesh);
    auto direction = [&](std::size_t k) { return glm::normalize(chain[k].to_m - chain[k].from_m); };
    auto radius = [&](const Piece& piece) { return piece.bare ? piece.radius_m : kSleeveInRadii * piece.radius_m; };
    const Piece& first = chain.front();
    const Piece& last = chain.back();
    tube.add_cap(first.from_m, direction(0), radius(first), radius(first), true, first.bare, !first.bare);
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
        const Piece& piece = chain[k];
        const Piece& next = chain[k + 1];
        const Vec3 in = direction(k), out = direction(k + 1);
        const float metal = piece.bare, pale = !piece.bare;
        const double cosine = std::clamp(glm::dot(in, out), -1.0, 1.0);
        if (piece.bare != next.bare) {  // a step with a chamfer where the sleeve begins
            const double r0 = radius(piece), r1 = radius(next), step = 0.35 * piece.radius_m;
            tube.add({piece.to_m - 0.5 * step * in, in, r0, 0.0, metal, pale});
            const float next_metal = next.bare, next_pale = !next.bare;
            const double slope = (r1 - r0) / step;
            tube.add({piece.to_m - 0.5 * step * in, in, r0, slope, r1 > r0 ? next_metal : metal,
                      r1 > r0 ? next_pale : pale});
            tube.add({piece.to_m + 0.5 * step * in, in, r1, slope, r1 > r0 ? next_metal : metal,
                      r1 > r0 ? next_pale : pale});
            tube.add({piece.to_m + 0.5 * step * in, in, r1, 0.0, next_metal, next_pale});
        } else if (cosine < 0.999) {  // an arc between the two tangents
            const double half = 0.5 * std::acos(cosine);
            const double shortest =
                std::min(glm::length(piece.to_m - piece.from_m), glm::length(next.to_m - next.from_m));
            const double back = std::min(0.45 * shortest, kBendInRadii * piece.radius_m * std::tan(half));
            const double bend_m = back / std::tan(half);
            const Vec3 inward = glm::normalize(out - in);
            const Vec3 centre = piece.to_m + (bend_m / std::cos(half)) * inward;
            const int steps = 10;
            for (int s = 0; s <= steps; ++s) {
                const double angle = (2.0 * s / steps - 1.0) * half;
                const Vec3 forward = glm::normalize(in + out);
                const Vec3 at = centre + bend_m * (std::sin(angle) * forward - std::cos(angle) * inward);
                tube.add({at, std::cos(angle) * forward + std::sin(angle) * inward, radius(piece), 0.0, metal, pale});
            }
        }
    }
    tube.add_cap(last.to_m, direction(chain.size() - 1), radius(last), radius(last), false, last.bare, !last.bare);
}

/// Dark shaft; the end nearer to bare metal has a pale collar and a chamfer inside the capsule's rounded end.
void add_shaft(Piece piece, const Vec3& metal_m, InstrumentMesh& mesh) {
    if (glm::length(piece.to_m - metal_m) < glm::length(piece.from_m - metal_m)) std::swap(piece.from_m, piece.to_m);
    const Vec3 along = glm::normalize(piece.to_m - piece.from_m);
    const double r = piece.radius_m;
    auto at = [&](double length_m) { return piece.from_m + length_m * along; };
    Tube tube(mesh);
    const double nose = -0.85 * r, narrow = 0.42 * r;
    const double chamfer = (r - narrow) / (0.95 * r);
    tube.add({at(nose), along, 0.02 * r, 8.0, 0.0f, 1.0f});
    tube.add({at(nose), along, narrow, 8.0, 0.0f, 1.0f});
    tube.add({at(nose), along, narrow, chamfer, 0.0f, 1.0f});
    tube.add({at(nose + 0.95 * r), along, r, chamfer, 0.0f, 1.0f});
    tube.add({at(nose + 1.05 * r), along, r, 0.0, 0.0f, 1.0f});
    tube.add({at(1.4 * r), along, r, 0.0, 0.0f, 1.0f});
    tube.add({at(1.4 * r), along, r, -8.0, 0.0f, 1.0f});
    tube.add({at(1.4 * r), along, 0.97 * r, -8.0, 0.0f, 1.0f});
    const double length = glm::length(piece.to_m - piece.from_m);
    for (int k = 0; k <= 8; ++k)  // several rings, as lighting is interpolated along them
        tube.add({at(1.4 * r + (length - 1.4 * r) * k / 8.0), along, 0.97 * r, 0.0, 0.0f, 0.0f});
    tube.add_cap(piece.to_m, along, 0.97 * r, 0.3 * r, false, 0.0f, 0.0f);
}

/// Takes the grasper out of `left`: two jaws in a steel joint at the end of a shaft.
void add_grasper(std::vector<tissue::Capsule>& left, InstrumentMesh& mesh) {
    std::vector<tissue::Capsule> jaws;
    std::optional<tissue::Capsule> shaft;
    for (const tissue::Capsule& capsule : left)
        if (capsule.instrument == tissue::Instrument::grasper) {
            if (capsule.radius_m < kJaw_m)
                jaws.push_back(capsule);
            else
                shaft = capsule;
        }
    left.erase(std::remove_if(left.begin(), left.end(),
                              [](const tissue::Capsule& c) { return c.instrument == tissue::Instrument::grasper; }),
               left.end());
    for (std::size_t k = 0; k < jaws.size(); ++k) {
        const tissue::Capsule& jaw = jaws[k];
        Vec3 inward(0.0, 0.0, 1.0);
        if (jaws.size() == 2) {
            const tissue::Capsule& other = jaws[1 - k];
            inward = 0.5 * (other.a_m + other.b_m - jaw.a_m - jaw.b_m);
        }
        add_jaw(jaw.a_m, jaw.b_m, jaw.radius_m, inward, mesh);
    }
    if (!shaft) return;
    add_shaft({shaft->a_m, shaft->b_m, shaft->radius_m, false}, jaws.empty() ? shaft->a_m : jaws.front().a_m, mesh);
    if (jaws.size() != 2) return;
    const Vec3 hinge_m = 0.5 * (jaws[0].a_m + jaws[1].a_m), along = glm::normalize(hinge_m - shaft->a_m);
    const double r = 0.86 * shaft->radius_m;
    Tube joint(mesh);
    joint.add({shaft->a_m, along, r, 0.0, 1.0f, 0.0f});
    joint.add({hinge_m - 0.4 * r * along, along, r, 0.0, 1.0f, 0.0f});
    joint.add_cap(hinge_m - 0.4 * r * along, along, r, 0.9 * r, false, 1.0f, 0.0f);
}

}  // namespace

void build_instrument(const std::vector<tissue::Capsule>& capsules, InstrumentMesh& mesh) {
    mesh.vertex.clear();
    mesh.index.clear();
    std::vector<tissue::Capsule> left;
    for (const tissue::Capsule& capsule : capsules)
        if (glm::length(capsule.b_m - capsule.a_m) > 1e-7 && capsule.radius_m > 0.0) left.push_back(capsule);
    add_grasper(left, mesh);
    Vec3 metal_m(0.0);
    for (const tissue::Capsule& capsule : left)
        if (capsule.bare) metal_m = 0.5 * (capsule.a_m + capsule.b_m);
    while (!left.empty()) {
        const std::vector<Piece> chain = take_chain(left);
        if (chain.size() == 1 && !chain[0].bare && chain[0].radius_m > kThin_m) {
            add_shaft(chain[0], metal_m, mesh);
        } else {
            add_wire(chain, mesh);
        }
    }
}

}  // namespace calot::render
