#pragma once
// A thin hold on SQLite: statements with values, errors as exceptions.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace calot::training {

class Database;
class Transaction;

/// One statement: bind by position from 1, then step through its rows.
class Statement {
  public:
    Statement(Database& database, const std::string& sql);
    ~Statement();
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    Statement& bind(int at, std::int64_t value);
    Statement& bind(int at, double value);
    Statement& bind(int at, const std::string& value);
    Statement& bind_null(int at);
    /// True while there is a row.
    bool step();
    void run() {
        while (step()) {
        }
    }

    std::int64_t integer(int column) const;  ///< columns count from 0
    double number(int column) const;
    std::string text(int column) const;
    bool is_null(int column) const;

  private:
    Database& database_;
    sqlite3_stmt* statement_ = nullptr;
};

class Database {
  public:
    /// Opens or creates. Throws InputError naming the file and the mend (not writable, not a database, ...).
    explicit Database(const std::string& path);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    void execute(const std::string& sql);
    std::int64_t last_id() const;
    const std::string& path() const { return path_; }
    /// Throws what SQLite says now.
    [[noreturn]] void fail(const std::string& doing) const;

  private:
    friend class Statement;
    friend class Transaction;
    std::string path_;
    sqlite3* handle_ = nullptr;
};

/// Begins a transaction; rolls back unless commit() was called.
class Transaction {
  public:
    explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
    ~Transaction();
    void commit() {
        database_.execute("COMMIT");
        open_ = false;
    }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

  private:
    Database& database_;
    bool open_ = true;
};

}  // namespace calot::training
