#include "html.h"

#include <fmt/format.h>

namespace calot::app {

std::string base64(const std::string& bytes) {
    static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    auto byte = [&](std::size_t k) {
        return k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[k])) : 0u;
    };
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const unsigned word = byte(k) << 16 | byte(k + 1) << 8 | byte(k + 2);
        out += kLetters[word >> 18];
        out += kLetters[word >> 12 & 63];
        out += k + 1 < bytes.size() ? kLetters[word >> 6 & 63] : '=';
        out += k + 2 < bytes.size() ? kLetters[word & 63] : '=';
    }
    return out;
}

std::string data_url(const char* type, const std::string& bytes) {
    return fmt::format("data:{};base64,{}", type, base64(bytes));
}

std::string grouped(std::int64_t number) {
    std::string text = fmt::format("{}", number);
    for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
    return text;
}

std::string clock_text(double seconds) {
    if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<std::int64_t>(seconds + 0.5);
    return fmt::format("{}:{:02d} min", whole / 60, whole % 60);
}

}  // namespace calot::app
