#pragma once
// Counts operator new and large arrays in a test program, so that tests can ask that a step does not allocate. Linked
// into every one.

namespace calot::test {

/// Calls of operator new, and of calot::allocate_apart for large arrays, in this program so far. Sanitizers bring their
/// own operator new: there it stays 0, and tests that compare two counts say nothing.
long allocations();

}  // namespace calot::test
