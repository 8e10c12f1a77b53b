#include "training_commands.h"

namespace calot::app {

namespace {

void add_data(CLI::App& command, std::string& data) {
    command
        .add_option("--data", data, "Where sessions are kept; otherwise $XDG_DATA_HOME/calot or ~/.local/share/calot")
        ->type_name("DIR");
}

void add_frames(CLI::App& command, int& frames) {
    command.add_option("--frames", frames, "Moments of the replay; 0: no pictures")
        ->type_name("N")
        ->check(CLI::Range(0, 1000));
}

void add_quiet(CLI::App& command, ProgressKind& progress) {
    command.add_flag_callback(
        "--quiet", [&progress] { progress = ProgressKind::none; }, "No progress");
}

}  // namespace

void TrainingCommands::add_score(CLI::App& app, int& code) {
    CLI::App* tasks_command = app.add_subcommand("tasks", "List the tasks that a trainee can be given");
    tasks_command->add_flag("--metrics", tasks_.metrics, "List what is measured instead, with formulas and sources");
    tasks_command->callback([&] { code = tasks(tasks_); });

    CLI::App* score_command = app.add_subcommand("score", "Score a recording against a task");
    score_command->add_option("recording", score_.recording, "recording.calot of a run or session")
        ->required()
        ->type_name("RECORDING");
    score_command->add_option("--task", score_.task, "Name or file of the task; of a session: its own")
        ->type_name("TASK");
    score_command->add_flag("--json", score_.json, "As JSON, with every metric, formula and event");
    score_command->add_option("--threads", score_.threads, "Threads to compute with; 0: all cores")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
    score_command->callback([&] { code = score(score_); });
}

void TrainingCommands::add_sessions(CLI::App& app, int& code) {
    CLI::App* sessions_command = app.add_subcommand("sessions", "List the stored sessions");
    add_data(*sessions_command, sessions_.data);
    sessions_command->add_option("--trainee", sessions_.trainee, "Only of this label")->type_name("LABEL");
    sessions_command->add_option("--task", sessions_.task, "Only of this task")->type_name("NAME");
    sessions_command->callback([&] { code = sessions(sessions_); });

    CLI::App* continue_command =
        app.add_subcommand("continue", "Go on from any moment of a session, with its scene's script, as a new session");
    continue_command->add_option("session", session_.continues, "Number of the session")
        ->required()
        ->type_name("SESSION");
    continue_command->add_option("--from", session_.from_s, "Moment to go on from")
        ->type_name("SECONDS")
        ->required()
        ->check(CLI::Range(0.0, 3600.0));
    continue_command->add_option("--duration", session_.scene.duration_s, "Simulated time at which to end")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.001, 3600.0));
    continue_command->add_option("--trainee", session_.trainee, "Label of who goes on")->type_name("LABEL");
    add_data(*continue_command, session_.data);
    add_frames(*continue_command, session_.frames);
    add_quiet(*continue_command, session_.progress);
    continue_command->callback([&] { code = session(session_); });

    CLI::App* debrief_command =
        app.add_subcommand("debrief", "Write the debrief of a session or recording: one HTML page");
    debrief_command->add_option("subject", debrief_.subject, "Number of a session, or a recording")
        ->required()
        ->type_name("SESSION|RECORDING");
    debrief_command->add_option("--task", debrief_.task, "What a recording is scored against; of a session: its own")
        ->type_name("TASK");
    debrief_command->add_option("--out", debrief_.out, "File to write; otherwise debrief.html beside the recording")
        ->type_name("FILE");
    add_data(*debrief_command, debrief_.data);
    add_frames(*debrief_command, debrief_.frames);
    add_quiet(*debrief_command, debrief_.progress);
    debrief_command->callback([&] { code = debrief(debrief_); });
}

void TrainingCommands::add_study(CLI::App& app, int& code) {
    CLI::App* ask_command = app.add_subcommand("questionnaire", "Answer the questionnaire of a session, or print it");
    ask_command->add_option("session", questionnaire_.session, "Number of the session; none: print the questions")
        ->type_name("SESSION");
    ask_command->add_option("--answers", questionnaire_.answers, "Answers without being asked: 1 to 5, - for none")
        ->type_name("4,5,-,...");
    ask_command->add_option("--remark", questionnaire_.remark, "A remark in words")->type_name("TEXT");
    add_data(*ask_command, questionnaire_.data);
    ask_command->callback([&] { code = questionnaire(questionnaire_); });

    CLI::App* study_command = app.add_subcommand("study", "Learning curves, and what the questionnaires say");
    add_data(*study_command, study_.data);
    study_command->add_option("--trainee", study_.trainee, "Only of this label")->type_name("LABEL");
    study_command->add_option("--task", study_.task, "Only of this task")->type_name("NAME");
    study_command->add_option("--csv", study_.csv, "Write all sessions to this file")->type_name("FILE");
    study_command->add_option("--html", study_.html, "Write a page with the curves to this file")->type_name("FILE");
    study_command->callback([&] { code = study(study_); });
}

void TrainingCommands::add_to(CLI::App& app, int& code) {
    add_score(app, code);
    add_sessions(app, code);
    add_study(app, code);
}

}  // namespace calot::app
