#pragma once

#include <cstdint>
#include <string>

namespace calot::app {

/// RFC 4648, for pictures inside a page.
inline std::string base64(const std::string& bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        std::uint32_t word = 0;
        for (std::size_t b = 0; b < 3; ++b)
            word = word << 8 | (k + b < bytes.size() ? static_cast<std::uint8_t>(bytes[k + b]) : 0u);
        for (std::size_t d = 0; d < 4; ++d) out += d <= bytes.size() - k ? kDigits[(word >> (18 - 6 * d)) & 63u] : '=';
    }
    return out;
}

}  // namespace calot::app
