#pragma once
// The store of sessions: an SQLite database and a folder a session, in the user's data directory.
//
//     DIR/calot.sqlite                     sessions, metrics, answers
//     DIR/sessions/000012/recording.calot  appended to while the session runs
//                         checkpoints.calot, task.toml, debrief.html, lock
//
// A running session holds a lock on its file `lock` that ends with its program, however that ends. A store that is
// opened later finds sessions marked as running whose lock is free, and closes them: nothing is lost but what was not
// yet written, a second at most.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calot/training/database.h"
#include "calot/training/metrics.h"

namespace calot::training {

/// $XDG_DATA_HOME/calot, or ~/.local/share/calot. Throws InputError without a home.
std::string default_data_directory();

enum class SessionStatus { running, finished, recovered };
const char* name_of(SessionStatus status);

struct SessionRow {
    std::int64_t id = 0;
    SessionStatus status = SessionStatus::running;
    std::string started_utc;  ///< "2026-01-31T14:05:00Z"
    std::string trainee;      ///< a label, may be empty
    std::string scene;        ///< name of the scene
    std::uint64_t seed = 0;
    std::string task;  ///< name of the task; empty: free practice
    double duration_s = 0.0;
    std::optional<double> points;  ///< none: free practice, or not known
    bool completed = false;
    std::optional<std::int64_t> parent;  ///< continued from that session ...
    std::int64_t parent_tick = 0;        ///< ... at this tick
    std::string program_version;
    Metrics metrics;
    std::vector<std::optional<int>> answers;  ///< of the questionnaire, 1 to 5; empty when it was not answered
    std::string remark;                       ///< free text of the questionnaire
};

/// Holds a session's lock.
class SessionLock {
  public:
    SessionLock() = default;
    /// Takes the lock; empty when somebody else has it.
    static std::optional<SessionLock> take(const std::string& path);
    ~SessionLock();
    SessionLock(SessionLock&& other) noexcept : file_(other.file_) { other.file_ = -1; }
    SessionLock& operator=(SessionLock&& other) noexcept {
        std::swap(file_, other.file_);
        return *this;
    }

  private:
    int file_ = -1;
};

class Store {
  public:
    /// Opens or creates the store. Throws InputError. Other programs may use it at the same time.
    explicit Store(const std::string& directory);

    const std::string& directory() const { return directory_; }
    std::string session_folder(std::int64_t id) const;
    std::string path(std::int64_t id, const std::string& file) const { return session_folder(id) + "/" + file; }

    /// Enters a running session (id, status and started_utc are set here) and creates its folder, locked.
    std::int64_t begin(SessionRow row, SessionLock& lock);
    /// Writes duration, points, metrics and status.
    void finish(const SessionRow& row);
    void answer(std::int64_t id, const std::vector<std::optional<int>>& answers, const std::string& remark);
    void rename_trainee(std::int64_t id, const std::string& trainee);

    /// Throws InputError when there is none.
    SessionRow session(std::int64_t id);
    /// All, oldest first. Empty filters match everything.
    std::vector<SessionRow> sessions(const std::string& trainee = "", const std::string& task = "");
    /// Sessions marked as running that no program runs any more.
    std::vector<std::int64_t> abandoned();

  private:
    void migrate();
    std::vector<SessionRow> select(const std::string& where, const std::vector<std::string>& values);
    void load_details(SessionRow& row);

    std::string directory_;
    std::unique_ptr<Database> database_;
};

}  // namespace calot::training
