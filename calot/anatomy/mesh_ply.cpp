// PLY: a header of elements and their properties, then the elements, as text or as bytes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "calot/anatomy/mesh_text.h"
#include "calot/base/error.h"

namespace calot::anatomy {

namespace {

enum class Format { ascii, little_endian, big_endian };

struct Scalar {
    int bytes = 0;  ///< 0: not a type
    bool real = false, negative = false;
};
Scalar scalar_of(const std::string& name) {
    struct Known {
        const char *name, *other;
        Scalar scalar;
    };
    static constexpr Known kKnown[] = {{"char", "int8", {1, false, true}},    {"uchar", "uint8", {1, false, false}},
                                       {"short", "int16", {2, false, true}},  {"ushort", "uint16", {2, false, false}},
                                       {"int", "int32", {4, false, true}},    {"uint", "uint32", {4, false, false}},
                                       {"float", "float32", {4, true, true}}, {"double", "float64", {8, true, true}}};
    for (const Known& known : kKnown)
        if (name == known.name || name == known.other) return known.scalar;
    return {};
}

struct Property {
    std::string name;
    Scalar scalar, count;  ///< count: of a list
};
struct Element {
    std::string name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

[[noreturn]] void fail(const std::string& path, int line, const std::string& what) {
    throw InputError(path, line, 0, what, "the file is damaged or cut off; export it again");
}

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::size_t body = 0;  ///< first byte after it
};

Header parse_header(const std::string& bytes, const std::string& path) {
    Header header;
    bool has_format = false;
    std::size_t begin = 0;
    for (int line = 1; begin < bytes.size(); ++line) {
        const std::size_t end = bytes.find('\n', begin);
        if (end == std::string::npos || end - begin > 4096) break;
        std::istringstream words(bytes.substr(begin, end - begin));
        begin = end + 1;
        std::string word, name, type, count;
        words >> word;
        if (line == 1 && word != "ply") break;
        if (word == "end_header" && has_format) {
            header.body = begin;
            return header;
        }
        if (word == "format") {
            words >> name;
            has_format = name == "ascii" || name == "binary_little_endian" || name == "binary_big_endian";
            header.format = name == "ascii"                  ? Format::ascii
                            : name == "binary_little_endian" ? Format::little_endian
                                                             : Format::big_endian;
        } else if (word == "element") {
            double number = -1.0;
            // Each element takes at least a byte: no header may ask for more memory than the file is large.
            if (!(words >> name >> number) || !(number >= 0.0 && number <= static_cast<double>(bytes.size())))
                fail(path, line, "the header promises more elements than the file can hold");
            header.elements.push_back({name, static_cast<std::int64_t>(number), {}});
        } else if (word == "property") {
            Property property;
            words >> type;
            if (type == "list") {
                words >> count >> type;
                property.count = scalar_of(count);
                if (property.count.bytes == 0 || property.count.real)
                    fail(path, line, "a list's length has no integer type");
            }
            words >> property.name;
            property.scalar = scalar_of(type);
            if (property.scalar.bytes == 0 || property.name.empty() || header.elements.empty())
                fail(path, line, "a property is not understood");
            header.elements.back().properties.push_back(property);
        }
    }
    fail(path, 0, "this is not a PLY file");
}

/// Reads one number after the other, whatever the format.
class Reader {
  public:
    Reader(const std::string& bytes, const Header& header, const std::string& path)
        : at_(bytes.data() + header.body), end_(bytes.data() + bytes.size()), format_(header.format), path_(path) {}

    double next(const Scalar& scalar) {
        if (format_ == Format::ascii) return next_text();
        if (end_ - at_ < scalar.bytes) fail(path_, 0, "the file ends before its last element");
        std::uint64_t bits = 0;
        for (int k = 0; k < scalar.bytes; ++k) {
            const int place = format_ == Format::little_endian ? k : scalar.bytes - 1 - k;
            bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(at_[k])) << (8 * place);
        }
        at_ += scalar.bytes;
        return value_of(bits, scalar);
    }

  private:
    double next_text() {
        while (at_ < end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r' || *at_ == '\n')) ++at_;
        if (at_ >= end_) fail(path_, 0, "the file ends before its last element");
        char* after = nullptr;
        const double value = std::strtod(at_, &after);  // a std::string ends with a zero byte
        if (after == at_) fail(path_, 0, "a number is not understood");
        at_ = after;
        return value;
    }
    static double value_of(std::uint64_t bits, const Scalar& scalar) {
        if (scalar.real && scalar.bytes == 8) {
            double value;
            std::memcpy(&value, &bits, sizeof(value));
            return value;
        }
        if (scalar.real) {
            const auto low = static_cast<std::uint32_t>(bits);
            float value;
            std::memcpy(&value, &low, sizeof(value));
            return static_cast<double>(value);
        }
        const int unused = 64 - 8 * scalar.bytes;
        return scalar.negative ? static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused)
                               : static_cast<double>(bits);
    }

    const char *at_, *end_;
    Format format_;
    const std::string& path_;
};

void read_element(const Element& element, Reader& reader, const std::string& path, TriangleMesh& mesh) {
    std::vector<std::int64_t> corners;
    for (std::int64_t k = 0; k < element.count; ++k) {
        Vec3 p(std::nan(""));
        for (const Property& property : element.properties) {
            if (property.count.bytes == 0) {
                const double value = reader.next(property.scalar);
                for (int axis = 0; axis < 3; ++axis)
                    if (property.name.size() == 1 && property.name[0] == 'x' + axis) p[axis] = value;
                continue;
            }
            const double length = reader.next(property.count);
            if (!(length >= 0.0 && length < 1e6)) fail(path, 0, fmt::format("a list has {} entries", length));
            const bool face =
                element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
            corners.clear();
            for (int entry = 0; entry < static_cast<int>(length); ++entry) {
                const double value = reader.next(property.scalar);
                if (face) corners.push_back(value >= 0.0 && value < 1e9 ? static_cast<std::int64_t>(value) : -1);
            }
            if (face && corners.size() < 3) fail(path, 0, "a face has fewer than three vertices");
            if (face) add_polygon(mesh, corners, path, 0);
        }
        if (element.name == "vertex") mesh.vertices_m.push_back(p);
    }
}

}  // namespace

TriangleMesh parse_ply(const std::string& bytes, const std::string& path) {
    const Header header = parse_header(bytes, path);
    Reader reader(bytes, header, path);
    TriangleMesh mesh;
    for (const Element& element : header.elements) {
        if (element.properties.empty() && element.count > 0)
            fail(path, 0, "element '" + element.name + "' has no properties");
        read_element(element, reader, path, mesh);
    }
    return mesh;
}

}  // namespace calot::anatomy
