#pragma once
// The command line of training: tasks, score, sessions, debrief, study.

#include <CLI/CLI.hpp>

#include "commands.h"

namespace calot::app {

/// Holds what the options set; must live until the command line is parsed.
class TrainingCommands {
  public:
    void add_to(CLI::App& app, int& code);

  private:
    void add_score(CLI::App& app, int& code);
    void add_sessions(CLI::App& app, int& code);
    void add_study(CLI::App& app, int& code);

    ScoreOptions score_;
    TasksOptions tasks_;
    SessionOptions session_;
    SessionsOptions sessions_;
    DebriefOptions debrief_;
    QuestionnaireOptions questionnaire_;
    StudyOptions study_;
};

}  // namespace calot::app
