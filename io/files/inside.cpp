// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/files/inside.h"

#include <algorithm>
#include <cerrno>
#include <sys/stat.h>
#include <system_error>

#include "io/files/file.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

/// Returns the status of a file, or nullopt if it does not exist. Throws UserError for a symbolic link.
std::optional<struct stat> status_of(const fs::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) {
    if (S_ISLNK(status.st_mode))
      throw_user_error("{}: expected no symbolic link in a data set, found one", path.string());
    return status;
  }
  if (errno == ENOENT) return std::nullopt;
  throw_user_error("{}: cannot be read: {}", path.string(), std::generic_category().message(errno));
}

/// Calls visit(path, last) for every leading part of folder/relative, until `visit` returns false. Throws
/// UserError if fault_of_path() rejects `relative`.
template <typename Visit>
void walk(const fs::path& folder, const std::string& relative, Visit visit) {
  if (const std::string fault = fault_of_path(relative); !fault.empty())
    throw_user_error("{}: expected {}, found a path of another kind", (folder / relative).string(), fault);
  for (size_t end = 0; end < relative.size();) {
    end = std::min(relative.find('/', end + 1), relative.size());
    if (!visit(folder / relative.substr(0, end), end == relative.size())) return;
  }
}

void expect_folder(const fs::path& path, const struct stat& status) {
  if (!S_ISDIR(status.st_mode))
    throw_user_error("{}: expected a folder, found {}", path.string(), kind_of_file(status.st_mode));
}

}  // namespace

std::string fault_of_path(const std::string& relative) {
  for (size_t start = 0; start <= relative.size();) {
    const size_t end = std::min(relative.find('/', start), relative.size());
    const std::string_view part = std::string_view(relative).substr(start, end - start);
    const bool printable =
        std::all_of(part.begin(), part.end(), [](unsigned char c) { return c >= 32 && c != 127; });
    if (part.empty() || part == "." || part == ".." || !printable || part.find('\\') != part.npos)
      return "a path below the data set's folder";
    start = end + 1;
  }
  return {};
}

std::optional<uint64_t> size_inside(const fs::path& folder, const std::string& relative) {
  std::optional<uint64_t> size;
  walk(folder, relative, [&](const fs::path& path, bool last) {
    const std::optional<struct stat> status = status_of(path);
    if (!status) return false;
    if (!last) {
      expect_folder(path, *status);
      return true;
    }
    if (!S_ISREG(status->st_mode))
      throw_user_error("{}: expected a file, found {}", path.string(), kind_of_file(status->st_mode));
    size = static_cast<uint64_t>(status->st_size);
    return true;
  });
  return size;
}

fs::path inside(const fs::path& folder, const std::string& relative) {
  size_inside(folder, relative);
  return folder / relative;
}

void create_folders_inside(const fs::path& folder, const std::string& relative) {
  walk(folder, relative, [&](const fs::path& path, bool) {
    if (::mkdir(path.c_str(), 0777) == 0) return true;
    if (errno != EEXIST) throw WriteError(path, errno);
    const std::optional<struct stat> status = status_of(path);
    if (!status) throw WriteError(path, ENOENT);
    if (!S_ISDIR(status->st_mode)) throw WriteError(path, ENOTDIR);
    return true;
  });
}

}  // namespace greatx::io
