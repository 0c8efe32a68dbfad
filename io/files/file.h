// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Files whose every failure is a UserError that names the file and the system's reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

#include "core/error.h"

namespace greatx::io {

using Bytes = std::vector<std::byte>;

/// Of a file that is read as a whole.
inline constexpr uint64_t largest_read = uint64_t{4} << 30;

/// A file could not be written: disk full, file-size limit, I/O error, no permission.
class WriteError : public UserError {
 public:
  WriteError(const std::filesystem::path& file, int error_number);
};

/// An open file descriptor, closed with the object. Short writes are continued; a write that makes no
/// progress throws.
class File {
 public:
  File() = default;
  /// For reading. Throws UserError, also for what is no plain file: a FIFO would have to be waited for.
  static File open_for_reading(const std::filesystem::path& path);
  /// For reading and writing, created if missing, kept if there. Throws WriteError; UserError for a symbolic
  /// link, which nothing is written through, and for what is neither a plain file nor a device (/dev/full,
  /// /dev/null).
  static File open_for_writing(const std::filesystem::path& path);
  ~File();
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  const std::filesystem::path& path() const { return path_; }
  uint64_t size() const;

  void write_at(uint64_t offset, std::span<const std::byte> bytes);
  /// Exactly that many bytes; throws UserError if the file ends before.
  void read_at(uint64_t offset, std::span<std::byte> bytes) const;
  void truncate(uint64_t size);
  /// Throws UserError if the file has been deleted, or has not this size: somebody else was at it while it
  /// was written.
  void check_untouched(uint64_t size) const;
  /// Closes now; a failure that the system reports only then (NFS, quota) throws.
  void close();

 private:
  File(std::filesystem::path path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  void expect_plain(bool or_device = false) const;
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// "a folder", "a FIFO", ..., by the mode that stat tells.
const char* kind_of_file(mode_t mode);
/// SHA-256 of all of it.
std::string sha256_of(const File& file);
/// The name under which a file is written until it is whole: PATH + ".part".
std::filesystem::path part_name(const std::filesystem::path& path);
/// Writes PATH.part, then renames it to PATH; on failure nothing stays. Throws WriteError.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);
/// mkdir -p. Throws WriteError.
void create_folders(const std::filesystem::path& folder);
/// The folder that `file` lies in, if its path names one.
void create_folder_of(const std::filesystem::path& file);
/// All of a file. Throws UserError, also for one of more than `most` bytes.
Bytes read_file(const std::filesystem::path& path, uint64_t most = largest_read);
std::string read_text_file(const std::filesystem::path& path, uint64_t most = largest_read);

/// Regular files in a folder and all below it, links not followed. What cannot be read counts as nothing.
struct FolderSize {
  int64_t files = 0;
  uint64_t bytes = 0;
};
FolderSize folder_size(const std::filesystem::path& folder);

/// Makes a write beyond the file-size limit (ulimit -f) an ordinary error instead of the end of the process.
/// Only the default action is replaced; a handler that the program has set stays.
void ignore_file_size_signal();

inline std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }
void append(Bytes& out, std::span<const std::byte> bytes);

}  // namespace greatx::io
