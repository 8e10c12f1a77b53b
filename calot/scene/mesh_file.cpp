#include "calot/scene/mesh_file.h"

#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "calot/base/hash.h"

namespace calot::scene {

std::string content_of_file(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    if (!stream || !(bytes << stream.rdbuf())) return "";
    const std::string text = bytes.str();
    return fmt::format("{:016x}", hash_bytes(text.data(), text.size()));
}

}  // namespace calot::scene
