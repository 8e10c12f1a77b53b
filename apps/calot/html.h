#pragma once
// What pages are made of: pictures inside them, numbers for people.

#include <cstdint>
#include <string>

namespace calot::app {

std::string base64(const std::string& bytes);
/// "data:image/jpeg;base64,..."
std::string data_url(const char* type, const std::string& bytes);
/// "3,041"
std::string grouped(std::int64_t number);
/// "1:05 min", "12.3 s"
std::string clock_text(double seconds);

}  // namespace calot::app
