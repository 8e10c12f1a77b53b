#include "calot/base/error.h"

namespace calot {

std::string InputError::describe() const {
    std::string text;
    if (!file.empty()) {
        text += file;
        if (line > 0) text += ":" + std::to_string(line);
        if (line > 0 && column > 0) text += ":" + std::to_string(column);
        text += ": ";
    }
    text += what();
    if (!hint.empty()) text += "\n  hint: " + hint;
    return text;
}

}  // namespace calot
