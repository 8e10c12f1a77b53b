// Where the faults of a mesh are: three views side by side, shaded, faults as red marks in front of everything.

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "calot/anatomy/mesh_shape.h"
#include "calot/base/error.h"

namespace calot::anatomy {

namespace {

constexpr int kPanel = 480;  // pixels

class Picture {
  public:
    Picture()
        : rgb_(static_cast<std::size_t>(3 * kPanel * kPanel) * 3, 245),
          depth_(static_cast<std::size_t>(kPanel) * kPanel * 3, -1e300) {}

    /// Points are (pixel x, pixel y, nearness).
    void triangle(int panel, const Vec3& a, const Vec3& b, const Vec3& c, int grey) {
        const Vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        for (int y = std::max(0, static_cast<int>(low.y)); y <= std::min(kPanel - 1, static_cast<int>(high.y)); ++y)
            for (int x = std::max(0, static_cast<int>(low.x)); x <= std::min(kPanel - 1, static_cast<int>(high.x));
                 ++x) {
                const double px = x + 0.5, py = y + 0.5;
                const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
                const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
                if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) continue;
                const double nearness = u * a.z + v * b.z + (1.0 - u - v) * c.z;
                double& depth = depth_[index(panel, x, y)];
                if (nearness <= depth) continue;
                depth = nearness;
                paint(panel, x, y, grey, grey, grey);
            }
    }
    void mark(int panel, const Vec3& p) {
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx)
                if (dx * dx + dy * dy <= 5)
                    paint(panel, static_cast<int>(p.x) + dx, static_cast<int>(p.y) + dy, 214, 30, 30);
    }
    const std::vector<std::uint8_t>& rgb() const { return rgb_; }

  private:
    static std::size_t index(int panel, int x, int y) { return static_cast<std::size_t>((y * 3 + panel) * kPanel + x); }
    void paint(int panel, int x, int y, int r, int g, int b) {
        if (x < 0 || y < 0 || x >= kPanel || y >= kPanel) return;
        std::uint8_t* pixel = &rgb_[3 * index(panel, x, y)];
        pixel[0] = static_cast<std::uint8_t>(r), pixel[1] = static_cast<std::uint8_t>(g),
        pixel[2] = static_cast<std::uint8_t>(b);
    }
    std::vector<std::uint8_t> rgb_;
    std::vector<double> depth_;
};

/// Right, up and towards the eye: from the front (+z), from the image right (+x), from above (+y).
constexpr int kAxes[3][3] = {{0, 1, 2}, {2, 1, 0}, {0, 2, 1}};
constexpr double kSigns[3][3] = {{1, 1, 1}, {-1, 1, 1}, {1, -1, 1}};

}  // namespace

void write_fault_picture(const std::string& path, const MeshReport& report) {
    if (report.mesh == nullptr)
        throw InputError(report.path, 0, 0, "there is no mesh to draw", "it could not be read at all");
    const Vec3 centre = 0.5 * (report.bounds_m.low + report.bounds_m.high);
    const Vec3 extent = report.bounds_m.high - report.bounds_m.low;
    const double scale = 0.9 * kPanel / std::max({extent.x, extent.y, extent.z, 1e-12});
    Picture picture;
    for (int panel = 0; panel < 3; ++panel) {
        auto project = [&](const Vec3& p) {
            const Vec3 q = p - centre;
            const int* axis = kAxes[panel];
            const double* sign = kSigns[panel];
            return Vec3(0.5 * kPanel + scale * sign[0] * q[axis[0]], 0.5 * kPanel - scale * sign[1] * q[axis[1]],
                        scale * sign[2] * q[axis[2]]);
        };
        for (const auto& t : report.mesh->triangles) {
            const Vec3 a = project(report.mesh->vertices_m[t[0]]), b = project(report.mesh->vertices_m[t[1]]),
                       c = project(report.mesh->vertices_m[t[2]]);
            const Vec3 normal = glm::cross(b - a, c - a);
            const double length = glm::length(normal);
            // Lit from the eye; faces seen from behind are darker, so that one looks into holes.
            if (length > 0.0)
                picture.triangle(panel, a, b, c,
                                 static_cast<int>((normal.z < 0.0 ? 90 : 40) + 125 * std::abs(normal.z) / length));
        }
        for (const MeshFaultPlace& place : report.places) picture.mark(panel, project(place.position_m));
    }
    // Under another name first: no half-written picture stays behind.
    const std::string partial = path + ".part";
    const bool written = stbi_write_png(partial.c_str(), 3 * kPanel, kPanel, 3, picture.rgb().data(), 9 * kPanel) != 0;
    std::error_code error;
    if (written) std::filesystem::rename(partial, path, error);
    if (!written || error) {
        std::filesystem::remove(partial, error);
        throw InputError(path, 0, 0, "the picture of the mesh's faults cannot be written",
                         "check that the folder exists and can be written to");
    }
}

}  // namespace calot::anatomy
