#pragma once
// The debrief of a session: gathered from its recording and checkpoints, written as one page that opens offline.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calot/training/session.h"
#include "commands.h"
#include "debrief_pictures.h"

namespace calot::app {

/// What a debrief is about.
struct DebriefSubject {
    std::string recording;                        ///< path
    std::optional<training::SessionRow> session;  ///< of stored ones
    std::optional<training::Task> task;
};

struct DebriefContent {
    DebriefSubject subject;
    std::shared_ptr<const simulation::Setup> setup;
    double duration_s = 0.0;
    bool complete = true;     ///< the recording was ended in order
    training::Result result;  ///< its task is empty in free practice
    std::vector<training::TrackPoint> track;
    std::vector<std::pair<double, double>> pedal_s;  ///< spans with the pedal down
    std::vector<DebriefFrame> frames;
    std::vector<DebriefMap> maps;
    std::string no_pictures;  ///< why there are none
};

/// `frames`: how many moments of the replay; 0: no pictures. Uses checkpoints where there are, runs the recording
/// otherwise.
DebriefContent gather_debrief(const DebriefSubject& subject, int frames, ProgressKind progress);

std::string debrief_html(const DebriefContent& content);

/// Gathers and writes the page of a stored session; returns its path.
std::string write_debrief(training::Store& store, std::int64_t session, int frames, ProgressKind progress);

}  // namespace calot::app
