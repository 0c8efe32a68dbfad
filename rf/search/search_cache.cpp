// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/search_cache.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/hash.h"

namespace greatx::rf {

namespace {

/// Counts up when the search changes what it finds, so that old files are not met again.
constexpr uint32_t search_version = 5;
constexpr char magic[8] = {'g', 'r', 'x', 'b', 'e', 'a', 'm', '3'};
constexpr size_t checksum_bytes = 64;

template <typename T>
void append(std::string& bytes, const std::vector<T>& values) {
  const uint64_t count = values.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  if (count > 0) bytes.append(reinterpret_cast<const char*>(values.data()), count * sizeof(T));
}

/// Reads what append() wrote; false at the first thing that does not fit.
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

std::string checksum(std::string_view bytes) { return sha256_hex(std::as_bytes(std::span(bytes))); }

std::string body_of(const BeamSearchResult& result) {
  std::string bytes(magic, sizeof magic);
  bytes.append(reinterpret_cast<const char*>(&result.found), sizeof result.found);
  append(bytes, result.list.facets);
  append(bytes, result.list.offsets);
  append(bytes, result.list.windows);
  append(bytes, result.list.wedge_offsets);
  append(bytes, result.list.wedges);
  // Number by number: the struct has a gap.
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

std::optional<BeamSearchResult> result_of(std::string_view bytes) {
  char head[sizeof magic];
  std::vector<double> rectangles;
  std::vector<uint32_t> walls;
  BeamSearchResult result;
  CandidateList& list = result.list;
  Reader reader(bytes);
  if (!reader.value(head) || std::memcmp(head, magic, sizeof magic) != 0 || !reader.value(result.found) ||
      !reader.values(list.facets) || !reader.values(list.offsets) || !reader.values(list.windows) ||
      !reader.values(list.wedge_offsets) || !reader.values(list.wedges) || !reader.values(rectangles) ||
      !reader.values(walls) || !reader.done() || list.offsets.empty() ||
      rectangles.size() != 12 * walls.size())
    return std::nullopt;
  for (size_t i = 0; i < walls.size(); ++i) {
    SequenceBeam beam;
    const double* next = rectangles.data() + 12 * i;
    for (dvec3* v : {&beam.image, &beam.center, &beam.half_a, &beam.half_b})
      for (int axis = 0; axis < 3; ++axis) (*v)[axis] = *next++;
    beam.walls = walls[i];
    result.beams.push_back(beam);
  }
  return result;
}

}  // namespace

std::string search_key(const std::string& scene_hash, const FacetKinds& kinds,
                       std::span<const scene::Wedge> wedges, const dvec3& source,
                       const BeamSearchOptions& options) {
  // By name, so that a new option is a compiler's error here until it is decided whether it changes the result.
  const auto& [max_depth, max_transmissions, capacity, threads, moving_bodies, source_body, clearance_m,
               stop_depth] = options;
  static_cast<void>(threads);
  GREATX_CHECK(!moving_bodies, "the key of a search says nothing of where bodies stand");
  Sha256 hash;
  hash.update_value(search_version).update(scene_hash);
  hash.update_value(static_cast<uint64_t>(kinds.size())).update(std::as_bytes(std::span(kinds)));
  hash.update_value(source.x).update_value(source.y).update_value(source.z);
  hash.update_value(max_depth).update_value(max_transmissions).update_value(capacity);
  hash.update_value(source_body).update_value(clearance_m).update_value(stop_depth);
  hash.update_value(static_cast<uint64_t>(wedges.size()));
  for (const scene::Wedge& wedge : wedges) {
    for (const dvec3& end : {wedge.a, wedge.b})
      hash.update_value(end.x).update_value(end.y).update_value(end.z);
    hash.update_value(wedge.facet_0).update_value(wedge.facet_n).update_value(wedge.body);
  }
  return hash.hex();
}

SearchCache::SearchCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

SearchCache SearchCache::standard() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  if (const std::string own = variable("GREATX_CACHE"); !own.empty())
    return SearchCache(own == "off" ? std::filesystem::path{} : std::filesystem::path(own));
  if (const std::string shared = variable("XDG_CACHE_HOME"); !shared.empty())
    return SearchCache(std::filesystem::path(shared) / "greatx");
  if (const std::string home = variable("HOME"); !home.empty())
    return SearchCache(std::filesystem::path(home) / ".cache" / "greatx");
  return SearchCache({});
}

std::optional<BeamSearchResult> SearchCache::load(const std::string& key) const {
  if (folder_.empty()) return std::nullopt;
  std::ifstream file(folder_ / (key + ".beams"), std::ios::binary);
  if (!file) return std::nullopt;
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  if (bytes.size() > checksum_bytes) {
    const std::string_view body(bytes.data(), bytes.size() - checksum_bytes);
    if (std::string_view(bytes).substr(body.size()) == checksum(body))
      if (auto result = result_of(body)) return result;
  }
  spdlog::warn("{}: damaged, searching again", (folder_ / (key + ".beams")).string());
  return std::nullopt;
}

void SearchCache::store(const std::string& key, const BeamSearchResult& result) const {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const std::filesystem::path target = folder_ / (key + ".beams");
  const std::filesystem::path draft = folder_ / fmt::format("{}.{}.tmp", key, getpid());
  {
    const std::string body = body_of(result);
    std::ofstream file(draft, std::ios::binary | std::ios::trunc);
    file << body << checksum(body);
    if (!file.flush()) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) std::filesystem::rename(draft, target, error);
  if (!error) return;
  spdlog::warn("candidates are not kept: cannot write {}", target.string());
  std::filesystem::remove(draft, error);
}

}  // namespace greatx::rf
