// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Wraps the part of SQLite that the index needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace greatx::apps {

/// A row of a query.
class SqliteRow {
 public:
  explicit SqliteRow(sqlite3_stmt* statement) : statement_(statement) {}
  double number(int column) const;
  std::string text(int column) const;

 private:
  sqlite3_stmt* statement_;
};

/// A data base that is written once, or read. Every failure throws UserError with the file and SQLite's
/// reason.
class SqliteFile {
 public:
  enum class Mode : uint8_t { write, read };
  explicit SqliteFile(const std::filesystem::path& file, Mode mode = Mode::write);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;
  void run(const std::string& sql);
  void each(const std::string& sql, const std::function<void(const SqliteRow&)>& visit);

 private:
  friend class SqliteInsert;
  [[noreturn]] void fail(const char* what) const;
  std::filesystem::path file_;
  sqlite3* handle_ = nullptr;
};

/// Inserts rows into a table, value by value.
class SqliteInsert {
 public:
  SqliteInsert(SqliteFile& file, const std::string& table, size_t columns);
  ~SqliteInsert();
  SqliteInsert(const SqliteInsert&) = delete;
  SqliteInsert& operator=(const SqliteInsert&) = delete;
  SqliteInsert& add(int64_t value);
  SqliteInsert& add(std::string_view value);
  /// Adds NULL if there is no value, or no finite one.
  SqliteInsert& add(const std::optional<double>& value);
  /// Inserts the row, which must have a value for every column.
  void end_row();

 private:
  SqliteFile& file_;
  sqlite3_stmt* statement_ = nullptr;
  int columns_, next_ = 1;
};

}  // namespace greatx::apps
