#include <cstdlib>

#include "scored.h"

namespace calot::app {

std::vector<std::string> task_folders() {
    std::vector<std::string> folders;
    if (const char* named = std::getenv("CALOT_TASKS")) folders.emplace_back(named);
    folders.emplace_back("scenes/tasks");
    folders.emplace_back(CALOT_SOURCE_DIR "/scenes/tasks");
    return folders;
}

}  // namespace calot::app
