#pragma once
// The machine that a benchmark runs on, and how to be disturbed less.

#include <memory>

#include "bench_results.h"

namespace calot::app {

Machine describe_machine();

/// Locks memory and asks for a real-time scheduling policy, as a program that drives a haptic device does. Threads that
/// are started later inherit it. Whatever the system does not permit is left out; `machine` says what was reached.
void ask_for_real_time(Machine& machine);

}  // namespace calot::app
