// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/search_cache.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <span>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <tuple>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/cache_folder.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/watch.h"

namespace greatx::rf {

namespace fs = std::filesystem;

namespace {

constexpr char magic[8] = {'g', 'r', 'x', 'b', 'e', 'a', 'm', '4'};
constexpr size_t key_bytes = 64, checksum_bytes = 64;
constexpr size_t chunk_bytes = 1u << 20;  ///< bytes written and hashed between two checkpoints
constexpr const char* ending = ".beams";
constexpr const char* draft_ending = ".tmp";
/// A draft of this age belongs to no running process.
constexpr std::chrono::hours draft_life{1};

/// Owns a file descriptor and closes it.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_;
};

/// Holds a file before it gets its final name. The destructor removes the file if it was not placed.
class Draft {
 public:
  explicit Draft(fs::path file)
      : file_(std::move(file)),
        descriptor_(::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644)) {}
  ~Draft() {
    if (descriptor_ && !placed_) ::unlink(file_.c_str());
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  explicit operator bool() const { return static_cast<bool>(descriptor_); }
  bool write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(descriptor_.number(), bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<size_t>(count));
    }
    return true;
  }
  bool place(const fs::path& target) {
    placed_ = ::rename(file_.c_str(), target.c_str()) == 0;
    return placed_;
  }

 private:
  fs::path file_;
  Descriptor descriptor_;
  bool placed_ = false;
};

template <typename T>
void append(std::string& bytes, const std::vector<T>& values) {
  const uint64_t count = values.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  if (count > 0) bytes.append(reinterpret_cast<const char*>(values.data()), count * sizeof(T));
}

/// Reads the values that append() wrote. Its functions return false if the bytes do not fit.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}
  template <typename T>
  bool value(T& value) {
    if (rest_.size() < sizeof(T)) return false;
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    return true;
  }
  template <typename T>
  bool values(std::vector<T>& values) {
    uint64_t count = 0;
    if (!value(count) || count > rest_.size() / sizeof(T)) return false;
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
    return true;
  }
  bool done() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

std::string checksum(std::string_view bytes) {
  Sha256 hash;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), chunk_bytes))) {
    checkpoint();
    hash.update(bytes.substr(0, chunk_bytes));
  }
  return hash.hex();
}

std::string body_of(const std::string& key, const BeamSearchResult& result) {
  std::string bytes(magic, sizeof magic);
  bytes += key;
  bytes.append(reinterpret_cast<const char*>(&result.found), sizeof result.found);
  append(bytes, result.list.facets);
  append(bytes, result.list.offsets);
  append(bytes, result.list.windows);
  append(bytes, result.list.wedge_offsets);
  append(bytes, result.list.wedges);
  // The struct has padding, so that its numbers are written one by one.
  std::vector<double> rectangles;
  std::vector<uint32_t> walls;
  for (const SequenceBeam& beam : result.beams) {
    for (const dvec3& v : {beam.image, beam.center, beam.half_a, beam.half_b})
      rectangles.insert(rectangles.end(), {v.x, v.y, v.z});
    walls.push_back(beam.walls);
  }
  append(bytes, rectangles);
  append(bytes, walls);
  return bytes;
}

bool are_offsets(const std::vector<uint32_t>& offsets, size_t end) {
  return !offsets.empty() && offsets.front() == 0 && offsets.back() == end &&
         std::is_sorted(offsets.begin(), offsets.end());
}

bool all_below(const std::vector<uint32_t>& values, uint32_t end) {
  return std::all_of(values.begin(), values.end(), [&](uint32_t value) { return value < end; });
}

/// Tells whether the numbers of a result fit each other and the scene, so that users need not check them.
bool fits(const BeamSearchResult& result, const SearchExtent& extent) {
  const CandidateList& list = result.list;
  return are_offsets(list.offsets, list.facets.size()) && all_below(list.facets, extent.facets) &&
         list.size() > 0 && list.sequence(0).empty() && list.windows.size() == list.size() &&
         (list.wedge_offsets.empty() ? list.wedges.empty()
                                     : list.wedge_offsets.size() == list.size() + 1 &&
                                           are_offsets(list.wedge_offsets, list.wedges.size()) &&
                                           all_below(list.wedges, extent.wedges)) &&
         result.beams.size() <= list.size() && result.found >= list.size() && list.is_canonical();
}

std::optional<BeamSearchResult> result_of(std::string_view bytes, const std::string& key,
                                          const SearchExtent& extent) {
  char head[sizeof magic], of_key[key_bytes];
  std::vector<double> rectangles;
  std::vector<uint32_t> walls;
  BeamSearchResult result;
  CandidateList& list = result.list;
  Reader reader(bytes);
  if (!reader.value(head) || std::memcmp(head, magic, sizeof magic) != 0 || !reader.value(of_key) ||
      std::string_view(of_key, key_bytes) != key || !reader.value(result.found) ||
      !reader.values(list.facets) || !reader.values(list.offsets) || !reader.values(list.windows) ||
      !reader.values(list.wedge_offsets) || !reader.values(list.wedges) || !reader.values(rectangles) ||
      !reader.values(walls) || !reader.done() || rectangles.size() != 12 * walls.size())
    return std::nullopt;
  result.beams.reserve(walls.size());
  for (size_t i = 0; i < walls.size(); ++i) {
    SequenceBeam beam;
    const double* next = rectangles.data() + 12 * i;
    for (dvec3* v : {&beam.image, &beam.center, &beam.half_a, &beam.half_b})
      for (int axis = 0; axis < 3; ++axis) (*v)[axis] = *next++;
    beam.walls = walls[i];
    result.beams.push_back(beam);
  }
  if (!fits(result, extent)) return std::nullopt;
  return result;
}

/// Holds all bytes of a file, or the reason why it could not be read.
struct Content {
  std::string bytes;
  std::string fault;  ///< empty if there is none
};

Content read_whole(const Descriptor& file, uint64_t most_bytes) {
  struct stat info {};
  if (::fstat(file.number(), &info) != 0) return {{}, std::strerror(errno)};
  if (S_ISDIR(info.st_mode)) return {{}, "a folder, not a file"};
  if (!S_ISREG(info.st_mode)) return {{}, "not an ordinary file"};
  const auto size = static_cast<uint64_t>(info.st_size);
  if (size > most_bytes) return {{}, fmt::format("{} bytes, more than the cache may hold", size)};
  Content content;
  content.bytes.resize(size);
  for (size_t done = 0; done < size;) {
    checkpoint();
    const ssize_t count =
        ::read(file.number(), content.bytes.data() + done, std::min(size - done, uint64_t{chunk_bytes}));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return {{}, std::strerror(errno)};
    if (count == 0) return {{}, "shorter than it says"};
    done += static_cast<size_t>(count);
  }
  return content;
}

/// Tells whether a name is that of a result or a draft. The folder may hold files that are not the cache's.
bool is_own(const std::string& name) {
  return name.size() > key_bytes && name[key_bytes] == '.' &&
         name.find_first_not_of("0123456789abcdef") == key_bytes;
}

uint64_t most_bytes_by_environment() {
  const char* const value = std::getenv("GREATX_CACHE_MIB");
  const std::string text = value == nullptr ? "" : value;
  if (text.empty()) return SearchCache::default_most_bytes;
  constexpr uint64_t most_mib = uint64_t{1} << 40;
  uint64_t mib = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), mib);
  if (error != std::errc{} || end != text.data() + text.size() || mib == 0 || mib > most_mib)
    throw_user_error("GREATX_CACHE_MIB: expected a whole number of MiB from 1 to {}, found '{}'", most_mib,
                     text);
  return mib << 20;
}

}  // namespace

SearchCache::SearchCache(fs::path folder, uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

SearchCache SearchCache::standard() { return SearchCache(cache_folder(), most_bytes_by_environment()); }

std::optional<BeamSearchResult> SearchCache::load(const std::string& key, const SearchExtent& extent) const {
  if (folder_.empty()) return std::nullopt;
  const fs::path name = folder_ / (key + ending);
  // O_NONBLOCK keeps a pipe from blocking the program.
  const Descriptor file(::open(name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file && (errno == ENOENT || errno == ENOTDIR)) return std::nullopt;
  Content content;
  if (!file)
    content.fault = std::strerror(errno);
  else
    content = read_whole(file, most_bytes_);
  if (content.fault.empty()) {
    const std::string& bytes = content.bytes;
    if (bytes.size() > checksum_bytes) {
      const std::string_view body(bytes.data(), bytes.size() - checksum_bytes);
      if (std::string_view(bytes).substr(body.size()) == checksum(body))
        if (auto result = result_of(body, key, extent)) {
          ::futimens(file.number(), nullptr);  // marks the use; if that fails, the file counts as older
          return result;
        }
    }
    content.fault = "damaged, or another's";
  }
  spdlog::warn("{}: {}; searching again", name.string(), content.fault);
  return std::nullopt;
}

void SearchCache::store(const std::string& key, const BeamSearchResult& result) const {
  if (folder_.empty()) return;
  const std::string body = body_of(key, result);
  if (body.size() + checksum_bytes > most_bytes_) {
    spdlog::info("candidates are not kept: they take {} MiB, the cache {} (GREATX_CACHE_MIB)",
                 (body.size() >> 20) + 1, most_bytes_ >> 20);
    return;
  }
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  const fs::path target = folder_ / (key + ending);
  static std::atomic<uint32_t> number{0};
  // The name is unique even if several hosts or containers share the folder: O_EXCL refuses an existing file.
  Draft draft(folder_ / fmt::format("{}.{}.{}.{:x}{}", key, ::getpid(), number++,
                                    std::chrono::steady_clock::now().time_since_epoch().count(),
                                    draft_ending));
  const auto write_all = [&] {
    for (std::string_view rest = body; !rest.empty();
         rest.remove_prefix(std::min(rest.size(), chunk_bytes))) {
      checkpoint();
      if (!draft.write(rest.substr(0, chunk_bytes))) return false;
    }
    return draft.write(checksum(body));
  };
  if (draft && write_all() && draft.place(target)) return trim(target);
  const int error = errno;
  spdlog::warn("candidates are not kept: cannot write {}: {}", target.string(), std::strerror(error));
}

struct SearchCache::Kept {
  fs::file_time_type used;
  std::string name;
  uint64_t bytes = 0;
};

/// Returns the results in the folder, and removes drafts that nobody will finish. Other processes may do the
/// same at the same time: errors for files that are already gone are ignored.
std::vector<SearchCache::Kept> SearchCache::kept() const {
  std::vector<Kept> all;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    const std::string name = entry->path().filename().string();
    if (!is_own(name) || !entry->is_regular_file(gone) || gone || entry->is_symlink(gone)) continue;
    const fs::file_time_type used = entry->last_write_time(gone);
    const uint64_t bytes = gone ? 0 : entry->file_size(gone);
    if (gone) continue;
    if (name.ends_with(draft_ending) && fs::file_time_type::clock::now() - used > draft_life)
      fs::remove(entry->path(), gone);
    if (name.size() == key_bytes + std::strlen(ending) && name.ends_with(ending))
      all.push_back({used, name, bytes});
  }
  return all;
}

/// Removes the least recently used results until the rest is within the limit.
void SearchCache::trim(const fs::path& newest) const {
  std::vector<Kept> all = kept();
  std::sort(all.begin(), all.end(),
            [](const Kept& a, const Kept& b) { return std::tie(a.used, a.name) < std::tie(b.used, b.name); });
  uint64_t total = 0;
  for (const Kept& one : all) total += one.bytes;
  for (const Kept& oldest : all) {
    if (total <= most_bytes_) return;
    if (folder_ / oldest.name == newest) continue;
    std::error_code gone;
    fs::remove(folder_ / oldest.name, gone);
    total -= oldest.bytes;
  }
}

SearchCache::Size SearchCache::size() const {
  Size size;
  for (const Kept& one : kept()) ++size.results, size.bytes += one.bytes;
  return size;
}

SearchCache::Size SearchCache::clear() const {
  Size removed;
  for (const Kept& one : kept()) {
    std::error_code error;
    if (fs::remove(folder_ / one.name, error)) ++removed.results, removed.bytes += one.bytes;
  }
  return removed;
}

}  // namespace greatx::rf
