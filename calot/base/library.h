#pragma once
// Functions of libraries that are loaded at run time (dlopen).

#include <dlfcn.h>

#include <string>

namespace calot {

/// Finds a function by name. If the library has none, `function` is null and the name is added to `missing`.
template <class F>
void find_function(void* library, const char* name, F& function, std::string& missing) {
    void* symbol = dlsym(library, name);
    if (symbol == nullptr) missing += (missing.empty() ? "" : ", ") + std::string(name);
    function = reinterpret_cast<F>(symbol);
}

}  // namespace calot
