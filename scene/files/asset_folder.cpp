// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/files/asset_folder.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <system_error>

#include "core/error.h"
#include "core/input_file.h"

namespace greatx::scene {
namespace {

int hex_digit(char character) {
  if (character >= '0' && character <= '9') return character - '0';
  const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// Returns whether the URI starts with "http:", "file:", "C:" or similar. A scheme is everything up to the
/// first ':' that RFC 3986, section 3.1, allows.
bool has_scheme(const std::string& uri) {
  const size_t colon = uri.find(':');
  if (colon == std::string::npos || colon == 0) return false;
  return std::isalpha(static_cast<unsigned char>(uri[0])) &&
         std::all_of(
             uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](unsigned char character) {
               return std::isalnum(character) || character == '+' || character == '-' || character == '.';
             });
}

std::vector<unsigned char> bytes_of(const InputFile& input) {
  std::vector<unsigned char> bytes(input.size());
  input.read(std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

/// Returns whether `inside` is `folder` or lies below it. Both are canonical.
bool is_below(const std::filesystem::path& inside, const std::filesystem::path& folder) {
  const auto [end_of_folder, position] =
      std::mismatch(folder.begin(), folder.end(), inside.begin(), inside.end());
  return end_of_folder == folder.end();
}

void check_relative(const std::string& path, const std::string& uri, const std::string& what) {
  const auto refuse = [&](const char* reason) {
    throw_user_error("{}: URI '{}' {}; expected a relative path inside the asset's folder", what, uri,
                     reason);
  };
  if (path.empty()) refuse("is empty");
  if (has_scheme(path)) refuse("has a scheme");
  if (path.find('\\') != std::string::npos) refuse("has a backslash");
  if (path.front() == '/' || std::filesystem::path(path).is_absolute()) refuse("is absolute");
  if (path.front() == '~') refuse("starts with '~'");
  for (const auto& part : std::filesystem::path(path)) {
    if (part == "..") refuse("leaves the folder ('..')");
  }
}

}  // namespace

std::string decode_uri(const std::string& uri, const std::string& what) {
  std::string decoded;
  for (size_t index = 0; index < uri.size(); ++index) {
    char character = uri[index];
    if (character == '%') {
      const int high = index + 2 < uri.size() ? hex_digit(uri[index + 1]) : -1;
      const int low = high >= 0 ? hex_digit(uri[index + 2]) : -1;
      if (low < 0)
        throw_user_error("{}: URI '{}' has a broken percent escape at character {}", what, uri, index + 1);
      character = static_cast<char>(high * 16 + low);
      index += 2;
    }
    if (character == '\0') throw_user_error("{}: URI has a NUL character", what);
    decoded += character;
  }
  return decoded;
}

std::vector<unsigned char> read_regular_file(const std::filesystem::path& file, const std::string& what,
                                             const Budget& budget) {
  return bytes_of(InputFile(file, what, budget));
}

AssetFolder::AssetFolder(const std::filesystem::path& asset, const Budget& files)
    : in_memory_(asset.empty()), files_(files), read_(files) {
  if (in_memory_) return;
  const std::filesystem::path parent = asset.parent_path();
  std::error_code error;
  folder_ = std::filesystem::canonical(parent.empty() ? "." : parent, error);
  if (error)
    throw_user_error("{}: folder '{}' cannot be opened: {}", asset.string(), parent.string(),
                     error.message());
}

std::vector<unsigned char> AssetFolder::read(const std::string& uri, const std::string& what) {
  const std::string path = decode_uri(uri, what);
  check_relative(path, uri, what);
  if (in_memory_) throw_user_error("{}: URI '{}': an embedded asset may not name external files", what, uri);
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(folder_ / path, error);
  if (error) {
    throw_user_error("{}: URI '{}': file '{}' cannot be opened: {}", what, uri, (folder_ / path).string(),
                     error.message());
  }
  if (!is_below(file, folder_)) {
    throw_user_error("{}: URI '{}' leaves the asset's folder through a symbolic link", what, uri);
  }
  const InputFile input(file, what, files_);
  read_.plan(fmt::format("{}: with file '{}'", what, file.string()), input.size());
  return bytes_of(input);
}

}  // namespace greatx::scene
