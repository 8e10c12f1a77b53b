#pragma once
// "Did you mean ...?"

#include <string>
#include <vector>

namespace calot::scene {

/// Least number of insertions, deletions, substitutions and swaps of neighbours that turn one word into the other.
int edit_distance(const std::string& a, const std::string& b);

/// The candidate closest to `word`, or "" when none is close enough to be meant.
std::string closest(const std::string& word, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string join(const std::vector<std::string>& words);

}  // namespace calot::scene
