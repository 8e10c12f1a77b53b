#include "calot/anatomy/mesh_text.h"

#include <fmt/format.h>

#include <cstdlib>

#include "calot/base/error.h"

namespace calot::anatomy {

namespace {

/// A number at `at`, which moves past it; false where there is none. Text ends with a zero byte, so strtod stops there.
bool take_number(const char*& at, const char* end, double& value) {
    while (at < end && (*at == ' ' || *at == '\t')) ++at;
    if (at >= end) return false;
    char* after = nullptr;
    value = std::strtod(at, &after);
    if (after == at || after > end) return false;
    at = after;
    return true;
}

void parse_vertex(const char* at, const char* end, const std::string& path, int line, TriangleMesh& mesh) {
    Vec3 p;
    for (int k = 0; k < 3; ++k)
        if (!take_number(at, end, p[k]))
            throw InputError(path, line, 0, "a vertex needs three numbers", "the file is damaged; export it again");
    mesh.vertices_m.push_back(p);
}

void parse_face(const char* at, const char* end, const std::string& path, int line, std::vector<std::int64_t>& corners,
                TriangleMesh& mesh) {
    corners.clear();
    for (double index; take_number(at, end, index);) {
        // Counts from 1; negative counts back from the last vertex. What follows a slash (texture, normal) is skipped.
        const auto vertices = static_cast<double>(mesh.vertices_m.size());
        const double from_zero = index < 0.0 ? vertices + index : index - 1.0;
        if (!(from_zero >= 0.0 && from_zero < vertices))
            throw InputError(path, line, 0, fmt::format("vertex {} does not exist", index),
                             "the file is damaged; export it again");
        corners.push_back(static_cast<std::int64_t>(from_zero));
        while (at < end && *at != ' ' && *at != '\t') ++at;
    }
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
    if (at < end || corners.size() < 3)
        throw InputError(path, line, 0, "a face needs three vertices or more", "the file is damaged; export it again");
    add_polygon(mesh, corners, path, line);
}

}  // namespace

void add_polygon(TriangleMesh& mesh, const std::vector<std::int64_t>& corners, const std::string& path, int line) {
    for (std::int64_t corner : corners)
        if (corner < 0 || corner >= static_cast<std::int64_t>(mesh.vertices_m.size()))
            throw InputError(path, line, 0,
                             fmt::format("a face refers to vertex {} of {}", corner, mesh.vertices_m.size()),
                             "the file is damaged; export it again");
    auto at = [&](std::size_t k) { return mesh.vertices_m[static_cast<std::size_t>(corners[k])]; };
    Vec3 normal(0.0);
    if (corners.size() > 3)
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) normal += glm::cross(at(k) - at(0), at(k + 1) - at(0));
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
        if (glm::dot(normal, glm::cross(at(k) - at(0), at(k + 1) - at(0))) < 0.0)
            throw InputError(path, line, 0, "a face is a concave polygon", "triangulate the mesh when exporting it");
        mesh.triangles.push_back({static_cast<std::int32_t>(corners[0]), static_cast<std::int32_t>(corners[k]),
                                  static_cast<std::int32_t>(corners[k + 1])});
    }
}

TriangleMesh parse_obj(const std::string& bytes, const std::string& path) {
    TriangleMesh mesh;
    std::vector<std::int64_t> corners;
    std::string joined;  // lines that end with a backslash go on
    int line = 0;
    for (std::size_t begin = 0; begin < bytes.size();) {
        ++line;
        const int first_line = line;
        std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
        const char *from = bytes.data() + begin, *to = bytes.data() + end;
        begin = end + 1;
        if (to > from && to[-1] == '\r') --to;
        if (to > from && to[-1] == '\\') {
            joined.assign(from, to - 1);
            for (bool more = true; more && begin < bytes.size(); ++line) {
                end = std::min(bytes.find('\n', begin), bytes.size());
                joined += ' ';
                joined.append(bytes, begin, end - begin);
                begin = end + 1;
                while (!joined.empty() && joined.back() == '\r') joined.pop_back();
                more = !joined.empty() && joined.back() == '\\';
                if (more) joined.pop_back();
            }
            from = joined.data(), to = joined.data() + joined.size();
        }
        while (from < to && (*from == ' ' || *from == '\t')) ++from;
        if (to - from < 2 || (from[1] != ' ' && from[1] != '\t')) continue;
        if (*from == 'v') parse_vertex(from + 2, to, path, first_line, mesh);
        if (*from == 'f') parse_face(from + 2, to, path, first_line, corners, mesh);
    }
    return mesh;
}

}  // namespace calot::anatomy
