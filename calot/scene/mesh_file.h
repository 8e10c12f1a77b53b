#pragma once
// The bytes of mesh files, so that a recording knows the mesh that it was made with.

#include <string>

namespace calot::scene {

/// XXH3 of a file's bytes, hexadecimal; "" when it cannot be read.
std::string content_of_file(const std::string& path);

}  // namespace calot::scene
