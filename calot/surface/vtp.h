#pragma once
// VTK PolyData files (.vtp) and time series of them (.pvd), as ParaView reads them. Files are written under a
// temporary name and renamed, so that what has the final name is whole.

#include <span>
#include <string>
#include <vector>

#include "calot/base/vec.h"

namespace calot::surface {

/// Values at the points, `components` a point.
struct PointData {
    std::string name;
    int components = 1;
    std::span<const float> values;
};

/// Throws InputError when the file cannot be written; asserts that lengths agree.
void write_vtp(const std::string& path, std::span<const Vec3f> points_m, std::span<const std::uint32_t> triangles,
               const std::vector<PointData>& data = {});

struct PvdEntry {
    double time_s = 0.0;
    std::string file;  ///< relative to the .pvd
};

/// The whole series; written anew for every frame, it is valid at any time.
void write_pvd(const std::string& path, const std::vector<PvdEntry>& entries);

}  // namespace calot::surface
