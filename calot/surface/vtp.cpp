#include "calot/surface/vtp.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "calot/base/error.h"

namespace calot::surface {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

namespace {

/// Data of inline arrays: the number of bytes as UInt64, then the bytes, all of it in base64.
std::string base64(const void* data, std::size_t bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::uint64_t header = bytes;
    std::vector<std::uint8_t> all(sizeof(header) + bytes);
    std::memcpy(all.data(), &header, sizeof(header));
    if (bytes > 0) std::memcpy(all.data() + sizeof(header), data, bytes);
    std::string text;
    text.reserve((all.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < all.size(); k += 3) {
        const std::size_t left = all.size() - k;
        const std::uint32_t word = (std::uint32_t{all[k]} << 16) | (left > 1 ? std::uint32_t{all[k + 1]} << 8 : 0u) |
                                   (left > 2 ? all[k + 2] : 0u);
        text += kDigits[word >> 18];
        text += kDigits[(word >> 12) & 63];
        text += left > 1 ? kDigits[(word >> 6) & 63] : '=';
        text += left > 2 ? kDigits[word & 63] : '=';
    }
    return text;
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (char c : text) {
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += c;
    }
    return safe;
}

std::string data_array(const char* type, const std::string& name, int components, const void* data, std::size_t bytes) {
    return fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n{}\n        "
        "</DataArray>\n",
        type, escaped(name), components, base64(data, bytes));
}

/// Writes under a temporary name, then renames.
void write_whole(const std::string& path, const std::string& text) {
    const std::string temporary = path + ".part";
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file) throw InputError(path, 0, 0, "cannot be written", "does the folder exist, and may it be written to?");
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool closed = std::fclose(file) == 0;
    std::error_code error;
    if (written && closed) std::filesystem::rename(temporary, path, error);
    if (!written || !closed || error) {
        std::remove(temporary.c_str());
        throw InputError(path, 0, 0, "could not be written to its end", "is the disk full?");
    }
}

}  // namespace

void write_vtp(const std::string& path, std::span<const Vec3f> points_m, std::span<const std::uint32_t> triangles,
               const std::vector<PointData>& data) {
    assert(triangles.size() % 3 == 0);
    const std::size_t count = triangles.size() / 3;
    const std::vector<std::int64_t> connectivity(triangles.begin(), triangles.end());
    std::vector<std::int64_t> offsets(count);
    for (std::size_t t = 0; t < count; ++t) offsets[t] = static_cast<std::int64_t>(3 * (t + 1));

    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <PolyData>\n"
        "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"{}\">\n",
        points_m.size(), count);
    text += "      <PointData>\n";
    for (const PointData& array : data) {
        assert(array.values.size() == points_m.size() * static_cast<std::size_t>(array.components));
        text += data_array("Float32", array.name, array.components, array.values.data(), array.values.size_bytes());
    }
    text += "      </PointData>\n      <Points>\n";
    text += data_array("Float32", "Points", 3, points_m.data(), points_m.size_bytes());
    text += "      </Points>\n      <Polys>\n";
    text += data_array("Int64", "connectivity", 1, connectivity.data(), connectivity.size() * sizeof(std::int64_t));
    text += data_array("Int64", "offsets", 1, offsets.data(), offsets.size() * sizeof(std::int64_t));
    text += "      </Polys>\n    </Piece>\n  </PolyData>\n</VTKFile>\n";
    write_whole(path, text);
}

void write_pvd(const std::string& path, const std::vector<PvdEntry>& entries) {
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <Collection>\n";
    for (const PvdEntry& entry : entries)
        text += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", entry.time_s,
                            escaped(entry.file));
    text += "  </Collection>\n</VTKFile>\n";
    write_whole(path, text);
}

}  // namespace calot::surface
