// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Wraps the part of SQLite that the index needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace greatx::apps {

/// A data base that is written once. Every failure throws UserError with the file and SQLite's reason.
class SqliteFile {
 public:
  explicit SqliteFile(const std::filesystem::path& file);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;
  void run(const std::string& sql);

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
