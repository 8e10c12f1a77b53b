// Reads back what was written, with a small parser of its own.

#include "calot/surface/vtp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "calot/validation/surface_bodies.h"
#include "calot/base/error.h"

namespace calot::surface {

namespace {

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<std::uint8_t> decoded(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    std::uint32_t word = 0;
    int bits = 0;
    for (char c : text) {
        if (c == '=') break;
        const std::uint32_t digit = c >= 'A' && c <= 'Z'   ? static_cast<std::uint32_t>(c - 'A')
                                    : c >= 'a' && c <= 'z' ? static_cast<std::uint32_t>(c - 'a' + 26)
                                    : c >= '0' && c <= '9' ? static_cast<std::uint32_t>(c - '0' + 52)
                                    : c == '+'             ? 62u
                                                           : 63u;
        word = word << 6 | digit;
        bits += 6;
        if (bits >= 8) bytes.push_back(static_cast<std::uint8_t>(word >> (bits -= 8)));
    }
    return bytes;
}

/// The array of that name; fails when the length it states is not the length it has.
template <class T>
std::vector<T> array_named(const std::string& file, const std::string& name, const std::string& type) {
    const std::size_t tag = file.find("<DataArray type=\"" + type + "\" Name=\"" + name + "\"");
    EXPECT_NE(tag, std::string::npos) << name;
    if (tag == std::string::npos) return {};
    const std::size_t begin = file.find(">\n", tag) + 2, end = file.find('\n', begin);
    const std::vector<std::uint8_t> bytes = decoded(file.substr(begin, end - begin));
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), sizeof(length));
    EXPECT_EQ(length + sizeof(length), bytes.size()) << name;
    std::vector<T> values(length / sizeof(T));
    if (length > 0) std::memcpy(values.data(), bytes.data() + sizeof(length), length);
    return values;
}

std::string temporary_folder() {
    const auto folder = std::filesystem::path(testing::TempDir()) / "calot_vtp_unit";
    std::filesystem::create_directories(folder);
    return folder.string();
}

}  // namespace

TEST(Vtp, ReadsBackAsWritten) {
    const Body body = ball(14, 5.2);
    Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    const Mesh& mesh = surface.rest_mesh();
    std::vector<float> heat(mesh.position_m.size());
    for (std::size_t v = 0; v < heat.size(); ++v) heat[v] = 310.15f + static_cast<float>(v);
    const std::string path = temporary_folder() + "/ball.vtp";
    write_vtp(path, mesh.position_m, mesh.index,
              {{"temperature_K", 1, heat}, {"normal", 3, {&mesh.normal.front().x, 3 * mesh.normal.size()}}});
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));

    const std::string file = contents(path);
    EXPECT_NE(file.find("byte_order=\"LittleEndian\" header_type=\"UInt64\""), std::string::npos);
    EXPECT_NE(file.find("NumberOfPoints=\"" + std::to_string(mesh.position_m.size()) + "\""), std::string::npos);
    EXPECT_NE(file.find("NumberOfPolys=\"" + std::to_string(mesh.triangles()) + "\""), std::string::npos);
    const auto points = array_named<float>(file, "Points", "Float32");
    ASSERT_EQ(points.size(), 3 * mesh.position_m.size());
    EXPECT_EQ(std::memcmp(points.data(), mesh.position_m.data(), points.size() * sizeof(float)), 0);
    for (float p : points) EXPECT_TRUE(std::isfinite(p));
    EXPECT_EQ(array_named<float>(file, "temperature_K", "Float32"), heat);
    EXPECT_EQ(array_named<float>(file, "normal", "Float32").size(), 3 * mesh.normal.size());
    const auto connectivity = array_named<std::int64_t>(file, "connectivity", "Int64");
    ASSERT_EQ(connectivity.size(), mesh.index.size());
    for (std::size_t k = 0; k < connectivity.size(); ++k) EXPECT_EQ(connectivity[k], std::int64_t{mesh.index[k]});
    const auto offsets = array_named<std::int64_t>(file, "offsets", "Int64");
    ASSERT_EQ(offsets.size(), mesh.triangles());
    for (std::size_t t = 0; t < offsets.size(); ++t) EXPECT_EQ(offsets[t], static_cast<std::int64_t>(3 * t + 3));
}

TEST(Vtp, EmptyMeshIsAFileToo) {
    const std::string path = temporary_folder() + "/empty.vtp";
    write_vtp(path, {}, {});
    EXPECT_TRUE(array_named<float>(contents(path), "Points", "Float32").empty());
}

TEST(Vtp, CollectionNamesItsFrames) {
    const std::string path = temporary_folder() + "/run.pvd";
    write_pvd(path, {{0.0, "run_0.vtp"}, {0.25, "a&b.vtp"}});
    const std::string file = contents(path);
    EXPECT_NE(file.find("timestep=\"0.25\" group=\"\" part=\"0\" file=\"a&amp;b.vtp\""), std::string::npos);
    EXPECT_NE(file.find("type=\"Collection\""), std::string::npos);
}

TEST(Vtp, SaysWhenItCannotWrite) {
    EXPECT_THROW(write_vtp(temporary_folder() + "/no/such/folder.vtp", {}, {}), InputError);
}

}  // namespace calot::surface
