#pragma once

namespace calot::surface {

/// Calls of operator new in this program so far.
long allocations();

}  // namespace calot::surface
