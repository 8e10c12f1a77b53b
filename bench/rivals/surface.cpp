// Surface: the same values in, a mesh out. Ours works the values out too, from presence bits; theirs get them.

#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <cstdlib>

#include <fmt/format.h>

#include "apps/calot/bench_bodies.h"
#include "calot/surface/field.h"
#include "calot/surface/surface.h"
#include "rivals.h"

namespace calot::rivals {

namespace {

/// The volume field at every hexel's centre and one ring around, x fastest; beyond the kernel's reach +-1.
std::vector<float> field_values(const tissue::Model& model, const tissue::State& state, const Int3& size) {
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                   static_cast<std::size_t>(size.z));
    auto present = [&](const Int3& c) {
        return model.hexels.contains(c) && state.hexel_present.test(model.hexels.index(c));
    };
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const Int3 c(x - 1, y - 1, z - 1);
                surface::Moments m;
                for (int dz = -surface::kReach; dz <= surface::kReach; ++dz)
                    for (int dy = -surface::kReach; dy <= surface::kReach; ++dy)
                        for (int dx = -surface::kReach; dx <= surface::kReach; ++dx)
                            if (present(c + Int3(dx, dy, dz))) {
                                const int weight = surface::field_weight(dx * dx + dy * dy + dz * dz);
                                m.weight += weight;
                                m.mean += weight * Int3(dx, dy, dz);
                            }
                values.push_back(surface::field_value(m, present(c)));
            }
    return values;
}

}  // namespace

void race_surface() {
    const tissue::Model model = app::hexel_block(147'233);
    tissue::State state = tissue::State::make(model);
    surface::Surface surface(model);
    const Int3 size = model.hexels.size + 2;
    const std::vector<float> values = field_values(model, state, size);

    ::setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1);  // one thread, as ours
    vtkNew<vtkImageData> image;
    image->SetDimensions(size.x, size.y, size.z);
    vtkNew<vtkFloatArray> scalars;
    scalars->SetArray(const_cast<float*>(values.data()), static_cast<vtkIdType>(values.size()), 1);
    image->GetPointData()->SetScalars(scalars);
    vtkNew<vtkFlyingEdges3D> edges;
    vtkNew<vtkMarchingCubes> cubes;
    edges->SetInputData(image);
    edges->SetValue(0, 0.0);
    cubes->SetInputData(image);
    cubes->SetValue(0, 0.0);

    const auto grid = openvdb::FloatGrid::create(1.0f);
    auto accessor = grid->getAccessor();
    std::size_t k = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x, ++k)
                if (std::abs(values[k]) < 1.0f || values[k] < 0.0f) accessor.setValue({x, y, z}, values[k]);

    const auto whole = [&] { surface.rebuild(model, state); };
    Race race;
    race.what = "whole surface, 147,233 hexels";
    race.ours = whole;
    race.note = "ours works the field out, too; theirs get it, and make points, triangles and normals";
    race.theirs_name = "VTK Flying Edges";
    race.theirs = [&] {
        edges->Modified();
        edges->Update();
    };
    run(race, 40);
    race.theirs_name = "VTK marching cubes";
    race.theirs = [&] {
        cubes->Modified();
        cubes->Update();
    };
    run(race, 20);
    race.note = "ours works the field out, too; theirs get it, and make quads without normals";
    race.theirs_name = "OpenVDB volumeToMesh";
    race.theirs = [&] {
        std::vector<openvdb::Vec3s> points;
        std::vector<openvdb::Vec4I> quads;
        openvdb::tools::volumeToMesh(*grid, points, quads, 0.0);
    };
    run(race, 20);

    // What burning asks for: forty hexels gone. The others have no local update.
    tissue::Exchange exchange;
    std::vector<std::int64_t> gone;
    const Int3 middle = model.hexels.size / 2;
    for (int z = model.hexels.size.z - 1; z > 0 && gone.size() < 40; --z)
        for (int y = middle.y - 3; y < middle.y + 3; ++y)
            for (int x = middle.x - 3; x < middle.x + 3 && gone.size() < 40; ++x)
                if (state.hexel_present.test(model.hexels.index(x, y, z))) gone.push_back(model.hexels.index(x, y, z));
    race.what = "surface after 40 hexels went";
    race.note = "ours redoes the blocks near them, theirs everything";
    race.theirs_name = "VTK Flying Edges";
    race.prepare = whole;
    race.ours = [&] {
        exchange.removed_hexels = gone;
        surface.remove(exchange);
        surface.redo_dirty_blocks();
    };
    race.theirs = [&] {
        edges->Modified();
        edges->Update();
    };
    run(race, 40);
}

}  // namespace calot::rivals
