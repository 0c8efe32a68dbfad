// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/files/file.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "core/hash.h"

namespace greatx::io {

namespace {
std::string reason(int error_number) { return std::generic_category().message(error_number); }
}  // namespace

WriteError::WriteError(const std::filesystem::path& file, int error_number)
    : UserError(fmt::format("{}: cannot be written: {}", file.string(), reason(error_number))) {}

const char* kind_of_file(mode_t mode) {
  return S_ISREG(mode)    ? "a file"
         : S_ISDIR(mode)  ? "a folder"
         : S_ISLNK(mode)  ? "a symbolic link"
         : S_ISFIFO(mode) ? "a FIFO"
         : S_ISSOCK(mode) ? "a socket"
                          : "a device";
}

void File::expect_plain(bool or_device) const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw_user_error("{}: {}", path_.string(), reason(errno));
  if (!S_ISREG(status.st_mode) && !(or_device && S_ISCHR(status.st_mode)))
    throw_user_error("{}: expected a file, found {}", path_.string(), kind_of_file(status.st_mode));
}

File File::open_for_reading(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) throw_user_error("{}: cannot be read: {}", path.string(), reason(errno));
  File file(path, descriptor);
  file.expect_plain();
  return file;
}

File File::open_for_writing(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == ELOOP)
    throw_user_error("{}: expected a file to write, found a symbolic link", path.string());
  if (descriptor < 0) throw WriteError(path, errno);
  File file(path, descriptor);
  file.expect_plain(true);
  return file;
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}
File::File(File&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
File& File::operator=(File&& other) noexcept {
  if (this != &other) {
    if (descriptor_ >= 0) ::close(descriptor_);
    path_ = std::move(other.path_);
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

uint64_t File::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw_user_error("{}: {}", path_.string(), reason(errno));
  return static_cast<uint64_t>(status.st_size);
}

void File::write_at(uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw WriteError(path_, errno);
    if (count == 0) throw WriteError(path_, ENOSPC);
    bytes = bytes.subspan(static_cast<size_t>(count));
    offset += static_cast<uint64_t>(count);
  }
}

void File::read_at(uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_user_error("{}: cannot be read: {}", path_.string(), reason(errno));
    if (count == 0) {
      throw_user_error("{}: expected {} more bytes at byte {}, found the end of the file", path_.string(),
                       bytes.size(), offset);
    }
    bytes = bytes.subspan(static_cast<size_t>(count));
    offset += static_cast<uint64_t>(count);
  }
}

void File::truncate(uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) throw WriteError(path_, errno);
}

void File::check_untouched(uint64_t size) const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw_user_error("{}: {}", path_.string(), reason(errno));
  if (status.st_nlink == 0)
    throw_user_error("{}: was deleted while the data set was being written", path_.string());
  if (static_cast<uint64_t>(status.st_size) != size)
    throw_user_error("{}: expected {} bytes, found {}: it was changed while the data set was being written",
                     path_.string(), size, status.st_size);
}

void File::close() {
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR)
    throw WriteError(path_, errno);
}

std::filesystem::path part_name(const std::filesystem::path& path) { return path.string() + ".part"; }

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const std::filesystem::path part = part_name(path);
  try {
    File file = File::open_for_writing(part);
    file.truncate(0);
    file.write_at(0, bytes);
    file.close();
    rename_file(part, path);
  } catch (...) {
    ::unlink(part.c_str());
    throw;
  }
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  write_file_atomically(path, bytes_of(text));
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) throw WriteError(to, errno);
}

void create_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder, error))
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw WriteError(folder, error.value());
}

void create_folder_of(const std::filesystem::path& file) {
  if (file.has_parent_path()) create_folders(file.parent_path());
}

namespace {
uint64_t size_to_read(const File& file, uint64_t most) {
  const uint64_t size = file.size();
  if (size > most)
    throw_user_error("{}: expected a file of at most {} bytes, found {}", file.path().string(), most, size);
  return size;
}
}  // namespace

Bytes read_file(const std::filesystem::path& path, uint64_t most) {
  const File file = File::open_for_reading(path);
  Bytes bytes(size_to_read(file, most));
  file.read_at(0, bytes);
  return bytes;
}

std::string read_text_file(const std::filesystem::path& path, uint64_t most) {
  const File file = File::open_for_reading(path);
  std::string text(size_to_read(file, most), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(text)));
  return text;
}

std::string sha256_of(const File& file) {
  Sha256 hash;
  Bytes block(1 << 20);
  const uint64_t size = file.size();
  for (uint64_t at = 0; at < size; at += block.size()) {
    const auto piece = std::span(block).first(std::min<uint64_t>(block.size(), size - at));
    file.read_at(at, piece);
    hash.update(piece);
  }
  return hash.hex();
}

void append(Bytes& out, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  const size_t size = out.size();
  out.resize(size + bytes.size());
  std::memcpy(out.data() + size, bytes.data(), bytes.size());
}

FolderSize folder_size(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  FolderSize size;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code gone;
    if (entry->is_symlink(gone) || !entry->is_regular_file(gone)) continue;
    const uintmax_t bytes = entry->file_size(gone);
    if (gone) continue;
    ++size.files;
    size.bytes += bytes;
  }
  return size;
}

void ignore_file_size_signal() {
  struct sigaction action {};
  if (::sigaction(SIGXFSZ, nullptr, &action) == 0 && (action.sa_flags & SA_SIGINFO) == 0 &&
      action.sa_handler == SIG_DFL) {
    action.sa_handler = SIG_IGN;
    ::sigaction(SIGXFSZ, &action, nullptr);
  }
}

}  // namespace greatx::io
