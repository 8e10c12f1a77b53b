// `calot simulate --session`, `calot sessions`, `calot debrief`, `calot questionnaire`.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>
#include <unistd.h>

#include "calot/base/error.h"
#include "calot/base/parallel.h"
#include "calot/training/questionnaire.h"
#include "calot/training/session.h"
#include "debrief.h"
#include "interrupt.h"
#include "output_directory.h"
#include "progress.h"
#include "scored.h"

namespace calot::app {

namespace {

training::Store open_store(const std::string& directory) {
    training::Store store(directory.empty() ? training::default_data_directory() : directory);
    for (std::int64_t id : training::recover(store))
        fmt::print(stderr, "calot: note: session {} had been cut off; it is closed now, with what it had recorded\n",
                   id);
    return store;
}

/// "12" is a session, anything else a recording.
bool is_session_number(const std::string& text) {
    return !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
}

void print_end(const training::LiveSession& session, const training::SessionRow& row, const std::string& page) {
    if (session.result()) print_score(*session.result());
    fmt::print("\nsession {} is stored in {}\n", row.id, session.folder());
    if (!page.empty()) fmt::print("look at {}\n", page);
}

}  // namespace

int session(const SessionOptions& options) {
    catch_interrupts();
    training::SessionStart start;
    start.trainee = options.trainee;
    start.program_version = CALOT_VERSION;
    if (!options.task.empty()) start.task = choose_task(options.task);
    training::Store store = open_store(options.data);
    const int threads =
        options.threads > 0 ? options.threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const ThreadLimit limit(threads);

    std::shared_ptr<const simulation::Setup> setup;
    std::unique_ptr<simulation::Simulation> run;
    std::optional<training::LiveSession> live;
    if (options.continues) {
        if (!start.task) start.task = training::task_of(store, *options.continues);
        training::Moment from = training::reach(store, *options.continues, std::llround(options.from_s * 1e3));
        setup = from.setup;
        live.emplace(store, start, from);
        run = std::move(from.run);
    } else {
        const auto made = std::make_shared<simulation::Setup>(build_setup(load_scene(options.scene)));
        use_backend(options.backend, *made);
        setup = made;
        run = std::make_unique<simulation::Simulation>(setup);
        live.emplace(store, start, *run);
    }
    const double duration_s = options.scene.duration_s.value_or(setup->duration_s);
    Progress progress(options.progress, duration_s);
    while (run->time_s() < duration_s - 0.5e-3 && !live->ended() && !interrupted()) {
        const tissue::Input input = setup->script.at(run->time_s());
        const bool ok = run->tick(input);
        live->after_tick(*run, input);
        progress.update(run->time_s());
        if (!ok) break;
    }
    progress.finish();
    const training::SessionRow row = live->finish(*run);
    const std::string page =
        options.frames >= 0 ? write_debrief(store, row.id, options.frames, options.progress) : std::string();
    if (options.progress != ProgressKind::none) print_end(*live, row, page);
    return interrupted() ? kInterrupted : run->figures().status.ok ? kDone : kFailed;
}

std::string write_debrief(training::Store& store, std::int64_t id, int frames, ProgressKind progress) {
    DebriefSubject subject;
    subject.session = store.session(id);
    subject.recording = store.path(id, "recording.calot");
    subject.task = training::task_of(store, id);
    const DebriefContent content = gather_debrief(subject, frames, progress);
    // What a session that was cut off was worth is known now, to its end.
    if (subject.session->status == training::SessionStatus::recovered) {
        training::SessionRow row = *subject.session;
        row.metrics = content.result.metrics;
        row.duration_s = content.duration_s;
        if (subject.task) {
            row.points = content.result.score.points;
            row.completed = content.result.score.completed;
        }
        store.finish(row);
    }
    const std::string path = store.path(id, "debrief.html");
    write_file(path + ".tmp", debrief_html(content));
    std::filesystem::rename(path + ".tmp", path);
    return path;
}

int debrief(const DebriefOptions& options) {
    if (is_session_number(options.subject)) {
        training::Store store = open_store(options.data);
        const std::string page = write_debrief(store, std::stoll(options.subject), options.frames, options.progress);
        if (!options.out.empty())
            std::filesystem::copy_file(page, options.out, std::filesystem::copy_options::overwrite_existing);
        fmt::print("look at {}\n", options.out.empty() ? page : options.out);
        return kDone;
    }
    DebriefSubject subject;
    subject.recording = options.subject;
    const std::filesystem::path folder = std::filesystem::path(options.subject).parent_path();
    if (!options.task.empty())
        subject.task = choose_task(options.task);
    else if (std::filesystem::exists(folder / "task.toml"))
        subject.task = training::load_task((folder / "task.toml").string());
    const std::string out = options.out.empty() ? (folder / "debrief.html").string() : options.out;
    const DebriefContent content = gather_debrief(subject, options.frames, options.progress);
    write_file(out + ".tmp", debrief_html(content));
    std::filesystem::rename(out + ".tmp", out);
    fmt::print("look at {}\n", out);
    return kDone;
}

int sessions(const SessionsOptions& options) {
    training::Store store = open_store(options.data);
    const std::vector<training::SessionRow> rows = store.sessions(options.trainee, options.task);
    if (rows.empty()) {
        fmt::print("there are no sessions in {}\n", store.directory());
        return kDone;
    }
    fmt::print("{:>7}  {:<20}  {:<12}  {:<16}  {:>6}  {:>8}  {:>6}  {}\n", "session", "started (UTC)", "trainee",
               "task", "seed", "duration", "points", "");
    for (const training::SessionRow& row : rows) {
        std::string note = row.status == training::SessionStatus::finished ? "" : training::name_of(row.status);
        if (row.completed) note += note.empty() ? "goal reached" : ", goal reached";
        if (row.parent)
            note += fmt::format("{}continues {} from {:.1f} s", note.empty() ? "" : ", ", *row.parent,
                                static_cast<double>(row.parent_tick) * 1e-3);
        fmt::print("{:>7}  {:<20}  {:<12}  {:<16}  {:>6}  {:>6.1f} s  {:>6}  {}\n", row.id, row.started_utc,
                   row.trainee.empty() ? "-" : row.trainee, row.task.empty() ? "free practice" : row.task, row.seed,
                   row.duration_s, row.points ? fmt::format("{:.0f}", *row.points) : "-", note);
    }
    return kDone;
}

namespace {

std::vector<std::optional<int>> parse_answers(const std::string& text) {
    std::vector<std::optional<int>> answers;
    std::size_t at = 0;
    for (;;) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::string word = text.substr(at, comma - at);
        if (word == "-" || word.empty())
            answers.emplace_back();
        else if (word.size() == 1 && word[0] >= '1' && word[0] <= '5')
            answers.emplace_back(word[0] - '0');
        else
            throw InputError(fmt::format("'{}' is no answer", word), "give numbers from 1 to 5, or - for none");
        if (comma == text.size()) break;
        at = comma + 1;
    }
    if (answers.size() != training::kQuestions)
        throw InputError(fmt::format("{} answers for {} questions", answers.size(), training::kQuestions),
                         "separate them by commas, - for none");
    return answers;
}

std::vector<std::optional<int>> ask() {
    std::vector<std::optional<int>> answers;
    fmt::print("1 not at all · 2 hardly · 3 partly · 4 mostly · 5 fully · Enter: no answer\n\n");
    for (std::size_t k = 0; k < training::kQuestions; ++k) {
        for (;;) {
            fmt::print("{:>2}. {} ", k + 1, training::questions()[k].text);
            std::fflush(stdout);
            std::string line;
            if (!std::getline(std::cin, line) || line.empty()) {
                answers.emplace_back();
                break;
            }
            if (line.size() == 1 && line[0] >= '1' && line[0] <= '5') {
                answers.emplace_back(line[0] - '0');
                break;
            }
            fmt::print("    a number from 1 to 5, please\n");
        }
    }
    return answers;
}

}  // namespace

int questionnaire(const QuestionnaireOptions& options) {
    if (options.session < 0) {
        for (std::size_t k = 0; k < training::kQuestions; ++k)
            fmt::print("{:>2}. {}\n", k + 1, training::questions()[k].text);
        return kDone;
    }
    training::Store store = open_store(options.data);
    store.session(options.session);
    const std::vector<std::optional<int>> answers = options.answers.empty() ? ask() : parse_answers(options.answers);
    store.answer(options.session, answers, options.remark);
    fmt::print("stored with session {}\n", options.session);
    return kDone;
}

}  // namespace calot::app
