#pragma once
// Errors of input (scene, mesh, recording, command line). Nothing inside a simulation step throws.

#include <stdexcept>
#include <string>

namespace calot {

/// Bad input: says where it is, what is wrong and what to do instead. The program prints it and exits with 2.
class InputError : public std::runtime_error {
  public:
    /// `line` and `column` count from 1; 0 means unknown. `hint` is the mend, may be empty.
    InputError(std::string file, int line, int column, const std::string& message, std::string hint = "")
        : std::runtime_error(message), file(std::move(file)), line(line), column(column), hint(std::move(hint)) {}
    explicit InputError(const std::string& message, std::string hint = "") : InputError("", 0, 0, message, std::move(hint)) {}

    /// "FILE:LINE:COLUMN: message\n  hint: ..." with the parts that are known.
    std::string describe() const;

    std::string file;
    int line;
    int column;
    std::string hint;
};

}  // namespace calot
