// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/sqlite.h"

#include <cmath>
#include <sqlite3.h>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"

namespace greatx::apps {

double SqliteRow::number(int column) const { return sqlite3_column_double(statement_, column); }

std::string SqliteRow::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_, column);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

SqliteFile::SqliteFile(const std::filesystem::path& file, Mode mode) : file_(file) {
  const int flags = mode == Mode::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (sqlite3_open_v2(file.c_str(), &handle_, flags, nullptr) != SQLITE_OK) fail("open");
  if (mode == Mode::read) return;
  // The file is written once and renamed when it is whole: nothing needs to survive a crash.
  run("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA cache_size=-65536; BEGIN");
}

SqliteFile::~SqliteFile() { sqlite3_close(handle_); }

void SqliteFile::run(const std::string& sql) {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail("write");
}

void SqliteFile::each(const std::string& sql, const std::function<void(const SqliteRow&)>& visit) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(handle_, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) fail("read");
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(statement)) == SQLITE_ROW) visit(SqliteRow(statement));
  sqlite3_finalize(statement);
  if (result != SQLITE_DONE) fail("read");
}

void SqliteFile::fail(const char* what) const {
  // "disk I/O error" alone does not tell a limit on the size of files from a broken disk.
  const int system = handle_ ? sqlite3_system_errno(handle_) : 0;
  throw_user_error("{}: cannot {} the index: {}{}", file_.string(), what,
                   handle_ ? sqlite3_errmsg(handle_) : "no memory",
                   system != 0 ? ": " + std::generic_category().message(system) : "");
}

SqliteInsert::SqliteInsert(SqliteFile& file, const std::string& table, size_t columns)
    : file_(file), columns_(static_cast<int>(columns)) {
  std::string sql = fmt::format("INSERT INTO {} VALUES (?", table);
  for (size_t i = 1; i < columns; ++i) sql += ",?";
  if (sqlite3_prepare_v2(file.handle_, (sql + ")").c_str(), -1, &statement_, nullptr) != SQLITE_OK)
    file.fail("prepare");
}

SqliteInsert::~SqliteInsert() { sqlite3_finalize(statement_); }

SqliteInsert& SqliteInsert::add(int64_t value) {
  sqlite3_bind_int64(statement_, next_++, value);
  return *this;
}

SqliteInsert& SqliteInsert::add(std::string_view value) {
  sqlite3_bind_text(statement_, next_++, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  return *this;
}

SqliteInsert& SqliteInsert::add(const std::optional<double>& value) {
  if (value && std::isfinite(*value))
    sqlite3_bind_double(statement_, next_++, *value);
  else
    sqlite3_bind_null(statement_, next_++);
  return *this;
}

void SqliteInsert::end_row() {
  GREATX_CHECK(next_ == columns_ + 1, "{} values of {}", next_ - 1, columns_);
  if (sqlite3_step(statement_) != SQLITE_DONE) file_.fail("write");
  sqlite3_reset(statement_);
  next_ = 1;
}

}  // namespace greatx::apps
