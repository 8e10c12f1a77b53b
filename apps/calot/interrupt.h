#pragma once
// Ctrl-C and SIGTERM: the run stops in order, with what it has written intact.

namespace calot::app {

/// From now on the first SIGINT or SIGTERM only sets a flag; a second one ends the program at once. A reader that goes
/// away (SIGPIPE) becomes an error of the write instead.
void catch_interrupts();

/// Whether somebody asked to stop.
bool interrupted();

}  // namespace calot::app
