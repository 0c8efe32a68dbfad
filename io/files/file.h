// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads and writes files. Every failure throws a UserError that names the file and the system's reason.
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

/// Largest size of a file that is read as a whole, bytes.
inline constexpr uint64_t largest_read = uint64_t{4} << 30;

/// Reports that a file could not be written: full disk, file-size limit, I/O error, no permission.
class WriteError : public UserError {
 public:
  WriteError(const std::filesystem::path& file, int error_number);
};

/// Owns an open file descriptor and closes it in the destructor. Short writes are continued; a write that
/// makes no progress throws WriteError.
class File {
 public:
  File() = default;
  /// Opens a file for reading. Throws UserError if it cannot be read or is not a plain file: opening a FIFO
  /// could block.
  static File open_for_reading(const std::filesystem::path& path);
  /// Opens a file for reading and writing. Creates it if it does not exist, and keeps its contents otherwise.
  /// Throws WriteError if it cannot be opened. Throws UserError for a symbolic link, because nothing is
  /// written through links, and for anything else than a plain file or a character device (/dev/full,
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
  /// Fills `bytes`. Throws UserError if the file ends earlier.
  void read_at(uint64_t offset, std::span<std::byte> bytes) const;
  void truncate(uint64_t size);
  /// Throws UserError if the file has been deleted or does not have this size: another process has changed it
  /// while it was being written.
  void check_untouched(uint64_t size) const;
  /// Closes the file now. Throws WriteError for failures that the system reports only at this point (NFS,
  /// quota).
  void close();

 private:
  File(std::filesystem::path path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  void expect_plain(bool or_device = false) const;
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Returns a description of the kind of file: "a folder", "a FIFO", ... `mode` is stat's st_mode.
const char* kind_of_file(mode_t mode);
/// Returns the SHA-256 of the whole file in hexadecimal digits.
std::string sha256_of(const File& file);
/// Returns PATH + ".part", the name of a file until it is complete.
std::filesystem::path part_name(const std::filesystem::path& path);
/// Writes PATH.part, then renames it to PATH. Removes PATH.part on failure. Throws WriteError, or UserError
/// if PATH.part is a symbolic link or no plain file.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);
/// Creates a folder and its parents like mkdir -p. Throws WriteError.
void create_folders(const std::filesystem::path& folder);
/// Creates the folder of `file` if its path names one. Throws WriteError.
void create_folder_of(const std::filesystem::path& file);
/// Reads a whole file. Throws UserError if it cannot be read or has more than `most` bytes.
Bytes read_file(const std::filesystem::path& path, uint64_t most = largest_read);
std::string read_text_file(const std::filesystem::path& path, uint64_t most = largest_read);

struct FolderSize {
  int64_t files = 0;
  uint64_t bytes = 0;
};
/// Counts the regular files in a folder and its subfolders. Does not follow links, and skips entries that
/// cannot be read.
FolderSize folder_size(const std::filesystem::path& folder);

/// Ignores SIGXFSZ, so that a write beyond the file-size limit (ulimit -f) is an ordinary error and does not
/// end the process. Replaces only the default action; a handler that the program has set stays.
void ignore_file_size_signal();

inline std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }
void append(Bytes& out, std::span<const std::byte> bytes);

}  // namespace greatx::io
