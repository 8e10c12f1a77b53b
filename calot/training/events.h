#pragma once
// What happened, and when: the marks on a session's timeline.

#include <cstdint>
#include <string>

#include "calot/base/archive.h"

namespace calot::training {

enum class EventKind : std::uint8_t {
    activation_start,
    activation_end,  ///< value: energy delivered [J]
    touch,           ///< the hook touches duct or artery; value: 1 with the pedal down
    organ_touch,     ///< bare metal with current at an organ
    exposed,         ///< value: share, one of kExposureSteps
    injured,         ///< first hexel with Omega >= 1
    burnt,           ///< first hexel gone: bleeding or leak begins
    target,          ///< value: its number, from 1
    completed,       ///< the task's goal is reached
    limit            ///< value: number of the task's limit, from 0
};

struct Event {
    double time_s = 0.0;
    EventKind kind = EventKind::touch;
    std::string structure;  ///< "cystic_duct", "liver", ...
    double value = 0.0;

    void archive(Archive& a) {
        a.value(time_s);
        a.value(kind);
        a.value(structure);
        a.value(value);
    }
};

/// "the artery is injured", for people.
std::string describe(const Event& event);
/// "activation_start", for programs.
const char* name_of(EventKind kind);

}  // namespace calot::training
