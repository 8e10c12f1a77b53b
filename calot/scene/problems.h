#pragma once
// Collects what is wrong with a scene, so that all of it is told at once.

#include <algorithm>
#include <string>
#include <vector>

#include "calot/base/error.h"
#include "calot/scene/scene.h"

namespace calot::scene {

class Problems {
  public:
    void add(const Place& place, const std::string& message, const std::string& hint = "") {
        problems_.emplace_back(place.file, place.line, place.column, message, hint);
    }
    bool empty() const { return problems_.empty(); }
    /// One InputError that points to the first and tells all (at most 20).
    void throw_if_any() const {
        if (problems_.empty()) return;
        std::vector<InputError> problems = problems_;
        std::stable_sort(problems.begin(), problems.end(),
                         [](const InputError& a, const InputError& b) { return a.file == b.file && a.line < b.line; });
        const InputError& first = problems.front();
        if (problems.size() == 1) throw first;
        constexpr std::size_t kMost = 20;
        std::string message = first.what();
        if (!first.hint.empty()) message += "\n  hint: " + first.hint;
        for (std::size_t k = 1; k < problems.size() && k < kMost; ++k) message += "\n" + problems[k].describe();
        if (problems.size() > kMost) message += "\nand " + std::to_string(problems.size() - kMost) + " more";
        throw InputError(first.file, first.line, first.column, message);
    }

  private:
    std::vector<InputError> problems_;
};

}  // namespace calot::scene
