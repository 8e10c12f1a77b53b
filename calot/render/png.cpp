#include <cstdio>
#include <filesystem>

#include "calot/base/error.h"
#include "calot/render/renderer.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace calot::render {

void write_png(const std::string& path, const Image& image) {
    const std::string temporary = path + ".tmp";
    std::error_code error;
    const int stride = 3 * image.width;
    bool good = stbi_write_png(temporary.c_str(), image.width, image.height, 3, image.rgb.data(), stride) != 0;
    if (good) {
        std::filesystem::rename(temporary, path, error);
        good = !error;
    }
    if (good) return;
    std::filesystem::remove(temporary, error);
    throw InputError(path, 0, 0, "cannot write this picture", "name a folder that exists and can be written to");
}

std::string jpeg(const Image& image, int quality) {
    std::string bytes;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    stbi_write_jpg_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(), quality);
    return bytes;
}

}  // namespace calot::render
