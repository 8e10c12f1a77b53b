#include "calot/scene/suggest.h"

#include <algorithm>
#include <cctype>

namespace calot::scene {

int edit_distance(const std::string& a, const std::string& b) {
    const std::size_t rows = a.size() + 1, columns = b.size() + 1;
    std::vector<int> d(rows * columns);
    auto at = [&](std::size_t i, std::size_t j) -> int& { return d[i * columns + j]; };
    for (std::size_t i = 0; i < rows; ++i) at(i, 0) = static_cast<int>(i);
    for (std::size_t j = 0; j < columns; ++j) at(0, j) = static_cast<int>(j);
    for (std::size_t i = 1; i < rows; ++i)
        for (std::size_t j = 1; j < columns; ++j) {
            const int change = a[i - 1] == b[j - 1] ? 0 : 1;
            at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + change});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
        }
    return at(rows - 1, columns - 1);
}

std::string closest(const std::string& word, const std::vector<std::string>& candidates) {
    auto lower = [](std::string text) {
        for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return text;
    };
    std::string best;
    int best_distance = std::max(2, static_cast<int>(word.size()) / 3) + 1;
    if (word.size() > 200) return best;  // not a slip of the finger
    for (const std::string& candidate : candidates) {
        const std::string here = lower(candidate), there = lower(word);
        const bool begun =
            there.size() >= 4 && here.compare(0, there.size(), there) == 0;  // "damping", for "damping_per_s"
        const int distance = begun ? 1 : edit_distance(there, here);
        // A word whose letters would nearly all have to change was not meant.
        if (distance < best_distance && distance < static_cast<int>(candidate.size())) {
            best_distance = distance;
            best = candidate;
        }
    }
    if (best.empty() && word.size() >= 3)
        for (const std::string& candidate : candidates)
            if (candidate.find(word) != std::string::npos) return candidate;
    return best;
}

std::string join(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace calot::scene
