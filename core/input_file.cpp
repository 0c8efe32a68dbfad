// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/input_file.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "core/error.h"

namespace greatx {

InputFile::InputFile(const std::filesystem::path& file, const std::string& what, const Budget& budget)
    : name_(file.string()), what_(what) {
  const auto reason = [] { return std::generic_category().message(errno); };
  // The call does not block: opening a pipe would otherwise wait for a process that writes into it.
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0 && (errno == ENOENT || errno == ENOTDIR))
    throw_user_error("{}: file '{}' does not exist", what_, name_);
  if (descriptor_ < 0) throw_user_error("{}: file '{}' cannot be read: {}", what_, name_, reason());
  // The destructor does not run when a constructor throws.
  const auto refuse = [&](const std::string& message) {
    ::close(descriptor_);
    throw UserError(message);
  };
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0)
    refuse(fmt::format("{}: file '{}' cannot be read: {}", what_, name_, reason()));
  if (!S_ISREG(status.st_mode)) refuse(fmt::format("{}: '{}' is not a regular file", what_, name_));
  size_ = static_cast<size_t>(status.st_size);
  if (size_ > budget.most) {
    ::close(descriptor_);
    require_within(fmt::format("{}: file '{}'", what_, name_), size_, budget);
  }
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read(std::span<std::byte> bytes) const {
  GREATX_CHECK(bytes.size() == size_, "{} bytes for {}", bytes.size(), size_);
  for (size_t at = 0; at < size_;) {
    const ssize_t count = ::pread(descriptor_, bytes.data() + at, size_ - at, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      throw_user_error("{}: file '{}' cannot be read: {}", what_, name_,
                       std::generic_category().message(errno));
    if (count == 0) throw_user_error("{}: file '{}': read {} of {} bytes", what_, name_, at, size_);
    at += static_cast<size_t>(count);
  }
}

std::string InputFile::text() const {
  std::string text(size_, '\0');
  read(std::as_writable_bytes(std::span(text)));
  return text;
}

}  // namespace greatx
