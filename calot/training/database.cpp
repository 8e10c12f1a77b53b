#include "calot/training/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include "calot/base/error.h"

namespace calot::training {

namespace {

/// How long one program waits for another that writes.
constexpr int kBusy_ms = 5000;

}  // namespace

Database::Database(const std::string& path) : path_(path) {
    if (sqlite3_open_v2(path.c_str(), &handle_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr) != SQLITE_OK) {
        const std::string why = handle_ != nullptr ? sqlite3_errmsg(handle_) : "no memory";
        sqlite3_close(handle_);
        throw InputError(path, 0, 0, fmt::format("cannot open the database of sessions ({})", why),
                         "choose a folder that can be written to with --data");
    }
    sqlite3_busy_timeout(handle_, kBusy_ms);
    sqlite3_extended_result_codes(handle_, 1);
    try {
        // Readers and a writer at the same time; what is committed survives a killed program.
        execute("PRAGMA journal_mode = WAL");
        execute("PRAGMA synchronous = NORMAL");
        execute("PRAGMA foreign_keys = ON");
    } catch (...) {
        sqlite3_close(handle_);
        throw;
    }
}

Database::~Database() {
    sqlite3_close(handle_);
}

void Database::fail(const std::string& doing) const {
    const int code = sqlite3_errcode(handle_) & 0xff;
    const std::string why = sqlite3_errmsg(handle_);
    if (code == SQLITE_READONLY || code == SQLITE_CANTOPEN || code == SQLITE_PERM)
        throw InputError(path_, 0, 0, fmt::format("the database of sessions cannot be written ({})", why),
                         "choose a folder that can be written to with --data");
    if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT)
        throw InputError(path_, 0, 0, fmt::format("this is not a database of Calot, or it is damaged ({})", why),
                         "move it away: recordings lie beside it in sessions/ and are not lost");
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
        throw InputError(path_, 0, 0, "another program keeps the database of sessions locked",
                         "close it, or try again in a moment");
    throw std::runtime_error(fmt::format("{}: {}: {}", path_, doing, why));
}

void Database::execute(const std::string& sql) {
    if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail(sql);
}

std::int64_t Database::last_id() const {
    return sqlite3_last_insert_rowid(handle_);
}

Transaction::~Transaction() {
    if (open_) sqlite3_exec(database_.handle_, "ROLLBACK", nullptr, nullptr, nullptr);
}

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
    if (sqlite3_prepare_v2(database.handle_, sql.c_str(), -1, &statement_, nullptr) != SQLITE_OK) database.fail(sql);
}
Statement::~Statement() {
    sqlite3_finalize(statement_);
}

Statement& Statement::bind(int at, std::int64_t value) {
    sqlite3_bind_int64(statement_, at, value);
    return *this;
}
Statement& Statement::bind(int at, double value) {
    sqlite3_bind_double(statement_, at, value);
    return *this;
}
Statement& Statement::bind(int at, const std::string& value) {
    sqlite3_bind_text(statement_, at, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
    return *this;
}
Statement& Statement::bind_null(int at) {
    sqlite3_bind_null(statement_, at);
    return *this;
}

bool Statement::step() {
    const int code = sqlite3_step(statement_);
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) database_.fail(sqlite3_sql(statement_));
    return false;
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_, column);
}
double Statement::number(int column) const {
    return sqlite3_column_double(statement_, column);
}
std::string Statement::text(int column) const {
    const unsigned char* text = sqlite3_column_text(statement_, column);
    return text != nullptr ? std::string(reinterpret_cast<const char*>(text),
                                         static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)))
                           : std::string();
}
bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

}  // namespace calot::training
