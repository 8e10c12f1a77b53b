#include "calot/training/store.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "calot/base/error.h"

namespace calot::training {

namespace fs = std::filesystem;

namespace {

/// The schema in steps: step k takes a database of version k to k + 1. Never change a step; add one.
constexpr const char* kMigrations[] = {
    R"sql(
CREATE TABLE session (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    status TEXT NOT NULL CHECK (status IN ('running', 'finished', 'recovered')),
    started_utc TEXT NOT NULL,
    trainee TEXT NOT NULL DEFAULT '',
    scene TEXT NOT NULL,
    seed INTEGER NOT NULL,
    task TEXT NOT NULL DEFAULT '',
    duration_s REAL NOT NULL DEFAULT 0,
    points REAL,
    completed INTEGER NOT NULL DEFAULT 0,
    parent INTEGER REFERENCES session (id),
    parent_tick INTEGER NOT NULL DEFAULT 0,
    program_version TEXT NOT NULL DEFAULT ''
);
CREATE TABLE metric (
    session INTEGER NOT NULL REFERENCES session (id) ON DELETE CASCADE,
    name TEXT NOT NULL,
    value REAL,
    PRIMARY KEY (session, name)
) WITHOUT ROWID;
CREATE TABLE answer (
    session INTEGER NOT NULL REFERENCES session (id) ON DELETE CASCADE,
    question INTEGER NOT NULL,
    value INTEGER CHECK (value BETWEEN 1 AND 5),
    PRIMARY KEY (session, question)
) WITHOUT ROWID;
CREATE INDEX session_of_trainee ON session (trainee, task, started_utc);
)sql",
    "ALTER TABLE session ADD COLUMN remark TEXT NOT NULL DEFAULT '';",
};
constexpr int kVersion = static_cast<int>(std::size(kMigrations));

std::string now_utc() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

SessionStatus status_of(const std::string& word) {
    return word == "running"    ? SessionStatus::running
           : word == "finished" ? SessionStatus::finished
                                : SessionStatus::recovered;
}

/// SQLite's integers are signed.
std::int64_t stored_seed(std::uint64_t seed) {
    std::int64_t bits;
    std::memcpy(&bits, &seed, sizeof(bits));
    return bits;
}

}  // namespace

const char* name_of(SessionStatus status) {
    switch (status) {
        case SessionStatus::running:
            return "running";
        case SessionStatus::finished:
            return "finished";
        case SessionStatus::recovered:
            return "recovered";
    }
    return "";
}

std::string default_data_directory() {
    if (const char* data = std::getenv("XDG_DATA_HOME"); data != nullptr && *data) return std::string(data) + "/calot";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home)
        return std::string(home) + "/.local/share/calot";
    throw InputError("there is no home directory to keep sessions in", "say where with --data DIR");
}

std::optional<SessionLock> SessionLock::take(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0) return std::nullopt;
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
        ::close(file);
        return std::nullopt;
    }
    SessionLock lock;
    lock.file_ = file;
    return lock;
}

SessionLock::~SessionLock() {
    if (file_ >= 0) ::close(file_);  // the lock goes with the last descriptor
}

Store::Store(const std::string& directory) : directory_(directory) {
    std::error_code error;
    fs::create_directories(fs::path(directory) / "sessions", error);
    if (error)
        throw InputError(directory, 0, 0, fmt::format("sessions cannot be kept here ({})", error.message()),
                         "choose a folder that can be written to with --data");
    database_ = std::make_unique<Database>(directory + "/calot.sqlite");
    migrate();
}

void Store::migrate() {
    const auto version_of = [&] {
        Statement version(*database_, "PRAGMA user_version");
        version.step();
        return static_cast<int>(version.integer(0));
    };
    if (version_of() == kVersion) return;
    Transaction transaction(*database_);  // another program may be at it: ask again once it is our turn
    int version = version_of();
    if (version > kVersion)
        throw InputError(database_->path(), 0, 0,
                         fmt::format("the database has schema {}, this program knows {}", version, kVersion),
                         "it was used by a newer Calot: use that one, or another folder with --data");
    for (; version < kVersion; ++version) database_->execute(kMigrations[version]);
    database_->execute(fmt::format("PRAGMA user_version = {}", kVersion));
    transaction.commit();
}

std::string Store::session_folder(std::int64_t id) const {
    return fmt::format("{}/sessions/{:06d}", directory_, id);
}

std::int64_t Store::begin(SessionRow row, SessionLock& lock) {
    Transaction transaction(*database_);
    Statement insert(*database_,
                     "INSERT INTO session (status, started_utc, trainee, scene, seed, task, parent, parent_tick, "
                     "program_version) VALUES ('running', ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, now_utc()).bind(2, row.trainee).bind(3, row.scene).bind(4, stored_seed(row.seed)).bind(5, row.task);
    row.parent ? insert.bind(6, *row.parent) : insert.bind_null(6);
    insert.bind(7, row.parent_tick).bind(8, row.program_version).run();
    const std::int64_t id = database_->last_id();
    // The folder and its lock exist before anybody else can see the row.
    std::error_code error;
    fs::create_directories(session_folder(id), error);
    auto taken = SessionLock::take(path(id, "lock"));
    if (error || !taken)
        throw InputError(session_folder(id), 0, 0, "this session's folder cannot be written",
                         "choose a folder that can be written to with --data");
    lock = std::move(*taken);
    transaction.commit();
    return id;
}

void Store::finish(const SessionRow& row) {
    Transaction transaction(*database_);
    Statement update(*database_,
                     "UPDATE session SET status = ?, duration_s = ?, points = ?, completed = ? WHERE id = ?");
    update.bind(1, std::string(name_of(row.status))).bind(2, row.duration_s);
    row.points ? update.bind(3, *row.points) : update.bind_null(3);
    update.bind(4, std::int64_t{row.completed}).bind(5, row.id).run();
    for (const auto& [name, value] : row.metrics)  // NaN is stored as NULL by SQLite
        Statement(*database_, "INSERT OR REPLACE INTO metric (session, name, value) VALUES (?, ?, ?)")
            .bind(1, row.id)
            .bind(2, name)
            .bind(3, value)
            .run();
    transaction.commit();
}

void Store::answer(std::int64_t id, const std::vector<std::optional<int>>& answers, const std::string& remark) {
    session(id);
    Transaction transaction(*database_);
    for (std::size_t k = 0; k < answers.size(); ++k) {
        Statement insert(*database_, "INSERT OR REPLACE INTO answer (session, question, value) VALUES (?, ?, ?)");
        insert.bind(1, id).bind(2, static_cast<std::int64_t>(k + 1));
        answers[k] ? insert.bind(3, std::int64_t{*answers[k]}) : insert.bind_null(3);
        insert.run();
    }
    Statement(*database_, "UPDATE session SET remark = ? WHERE id = ?").bind(1, remark).bind(2, id).run();
    transaction.commit();
}

void Store::rename_trainee(std::int64_t id, const std::string& trainee) {
    session(id);
    Statement(*database_, "UPDATE session SET trainee = ? WHERE id = ?").bind(1, trainee).bind(2, id).run();
}

std::vector<SessionRow> Store::select(const std::string& where, const std::vector<std::string>& values) {
    Statement query(
        *database_,
        "SELECT id, status, started_utc, trainee, scene, seed, task, duration_s, points, completed, parent, "
        "parent_tick, program_version, remark FROM session " +
            where + " ORDER BY id");
    for (std::size_t k = 0; k < values.size(); ++k) query.bind(static_cast<int>(k + 1), values[k]);
    std::vector<SessionRow> rows;
    while (query.step()) {
        SessionRow row;
        row.id = query.integer(0);
        row.status = status_of(query.text(1));
        row.started_utc = query.text(2);
        row.trainee = query.text(3);
        row.scene = query.text(4);
        const std::int64_t seed = query.integer(5);
        std::memcpy(&row.seed, &seed, sizeof(seed));
        row.task = query.text(6);
        row.duration_s = query.number(7);
        if (!query.is_null(8)) row.points = query.number(8);
        row.completed = query.integer(9) != 0;
        if (!query.is_null(10)) row.parent = query.integer(10);
        row.parent_tick = query.integer(11);
        row.program_version = query.text(12);
        row.remark = query.text(13);
        rows.push_back(std::move(row));
    }
    for (SessionRow& row : rows) load_details(row);
    return rows;
}

void Store::load_details(SessionRow& row) {
    Statement metrics(*database_, "SELECT name, value FROM metric WHERE session = ?");
    metrics.bind(1, row.id);
    while (metrics.step())
        if (!metrics.is_null(1)) row.metrics[metrics.text(0)] = metrics.number(1);
    Statement answers(*database_, "SELECT question, value FROM answer WHERE session = ? ORDER BY question");
    answers.bind(1, row.id);
    while (answers.step()) {
        const auto question = static_cast<std::size_t>(answers.integer(0));
        if (question < 1 || question > 1000) continue;
        if (row.answers.size() < question) row.answers.resize(question);
        if (!answers.is_null(1)) row.answers[question - 1] = static_cast<int>(answers.integer(1));
    }
}

SessionRow Store::session(std::int64_t id) {
    std::vector<SessionRow> rows = select("WHERE id = ?", {fmt::format("{}", id)});
    if (rows.empty())
        throw InputError(fmt::format("there is no session {} in {}", id, directory_), "`calot sessions` lists them");
    return rows.front();
}

std::vector<SessionRow> Store::sessions(const std::string& trainee, const std::string& task) {
    std::string where = "WHERE 1";
    std::vector<std::string> values;
    if (!trainee.empty()) {
        where += " AND trainee = ?";
        values.push_back(trainee);
    }
    if (!task.empty()) {
        where += " AND task = ?";
        values.push_back(task);
    }
    return select(where, values);
}

std::vector<std::int64_t> Store::abandoned() {
    std::vector<std::int64_t> found;
    for (const SessionRow& row : select("WHERE status = 'running'", {}))
        if (SessionLock::take(path(row.id, "lock"))) found.push_back(row.id);
    return found;
}

}  // namespace calot::training
