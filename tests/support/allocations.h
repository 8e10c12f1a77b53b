#pragma once
// Counts operator new in a test program, so that tests can ask that a step does not allocate. Linked into every one.

namespace calot::test {

/// Calls of operator new in this program so far. Sanitizers bring their own operator new: there it stays 0, and tests
/// that compare two counts say nothing.
long allocations();

}  // namespace calot::test
