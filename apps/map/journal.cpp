// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map/journal.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <sys/file.h>

#include "core/hash.h"
#include "io/files/inside.h"
#include "io/files/same_request.h"
#include "io/files/untrusted_json.h"

namespace greatx::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view mark = "greatx map 2\n";
constexpr const char* journal_file = "links.part";
constexpr size_t numbers = 14;                      ///< doubles of a link on disk
constexpr uint64_t most_links = uint64_t{1} << 24;  ///< largest number of links of a block
using Stored = std::array<double, numbers>;

Stored stored(const sim::MapLink& link) {
  return {static_cast<double>(link.paths),
          link.line_of_sight ? 1.0 : 0.0,
          link.path_gain,
          link.mean_delay_s,
          link.delay_spread_s,
          link.k_factor,
          link.departure_azimuth_spread,
          link.departure_zenith_spread,
          link.arrival_azimuth_spread,
          link.arrival_zenith_spread,
          link.mean_doppler_hz,
          link.doppler_spread_hz,
          link.beam_gain,
          static_cast<double>(link.beam)};
}

sim::MapLink loaded(const Stored& s) {
  sim::MapLink link;
  link.paths = static_cast<uint32_t>(s[0]);
  link.line_of_sight = s[1] != 0.0;
  link.path_gain = s[2];
  link.mean_delay_s = s[3];
  link.delay_spread_s = s[4];
  link.k_factor = s[5];
  link.departure_azimuth_spread = s[6];
  link.departure_zenith_spread = s[7];
  link.arrival_azimuth_spread = s[8];
  link.arrival_zenith_spread = s[9];
  link.mean_doppler_hz = s[10];
  link.doppler_spread_hz = s[11];
  link.beam_gain = s[12];
  link.beam = static_cast<int32_t>(s[13]);
  return link;
}

/// Precedes the links of a block.
struct BlockHead {
  uint64_t links = 0;
  char hash[16] = {};  ///< first hexadecimal digits of the SHA-256 of the block's offset and links
};

BlockHead head_of(uint64_t offset, std::span<const std::byte> payload, uint64_t links) {
  BlockHead head{links, {}};
  const std::string hex = Sha256().update_value(offset).update(payload).hex();
  std::memcpy(head.hash, hex.data(), sizeof head.hash);
  return head;
}

}  // namespace

MapJournal::MapJournal(const fs::path& folder, const Json& request, bool resume) : folder_(folder) {
  io::create_folders(folder);
  io::ignore_file_size_signal();
  const fs::path journal = folder / journal_file, description = folder / map_description;
  if (io::exists_inside(folder, map_description)) {
    if (!resume)
      throw_user_error("{}: holds a finished radio map, which is not overwritten; choose another folder",
                       folder.string());
    const io::JsonDocument finished(io::read_text_file(description, io::JsonLimits{}.bytes),
                                    {description.string(), 1});
    io::check_same_request(folder, "a radio map", request, finished.root().at("request").json());
    finished_ = true;
    fs::remove(journal);  // left if the program was killed after the last file and before finish()
    return;
  }
  if (io::exists_inside(folder, journal_file)) {
    if (!resume)
      throw_user_error("{}: holds an unfinished radio map; --resume finishes it, or choose another folder",
                       folder.string());
  } else {
    for (const auto& entry : fs::directory_iterator(folder))
      throw_user_error(
          "{}: expected an empty folder or an unfinished radio map, found a folder with other files ({}); "
          "choose another folder",
          folder.string(), entry.path().filename().string());
  }
  file_ = io::File::open_for_writing(journal);
  if (::flock(file_.descriptor(), LOCK_EX | LOCK_NB) != 0)
    throw_user_error("{}: is being written by another process", folder.string());

  const uint64_t size = file_.size(), head = mark.size() + sizeof(uint64_t);
  uint64_t length = 0;
  std::string text(mark.size(), '\0');
  if (size >= head) {
    file_.read_at(0, std::as_writable_bytes(std::span(text)));
    file_.read_at(mark.size(), std::as_writable_bytes(std::span(&length, 1)));
    if (text != mark)
      throw_user_error("{}: expected an unfinished radio map of this version, found something else",
                       journal.string());
  }
  if (size < head || size - head < length) {  // new, or the program was killed while it wrote the request
    open_new(request.dump());
    return;
  }
  if (length > io::JsonLimits{}.bytes)
    throw_user_error("{}: expected a request of at most {} bytes, found {}", journal.string(),
                     io::JsonLimits{}.bytes, length);
  text.resize(length);
  file_.read_at(head, std::as_writable_bytes(std::span(text)));
  const io::JsonDocument asked(text, {journal.string(), 0});
  io::check_same_request(folder, "a radio map", request, asked.root().json());
  read_blocks(head + length);
}

void MapJournal::open_new(const std::string& request) {
  const uint64_t length = request.size();
  io::Bytes bytes;
  io::append(bytes, io::bytes_of(mark));
  io::append(bytes, std::as_bytes(std::span(&length, 1)));
  io::append(bytes, io::bytes_of(request));
  file_.truncate(0);
  file_.write_at(0, bytes);
  bytes_ = bytes.size();
}

void MapJournal::read_blocks(uint64_t begin) {
  const uint64_t size = file_.size();
  bytes_ = begin;
  while (size - bytes_ >= sizeof(BlockHead)) {
    BlockHead head;
    file_.read_at(bytes_, std::as_writable_bytes(std::span(&head, 1)));
    const uint64_t room = size - bytes_ - sizeof head;
    if (head.links == 0 || head.links > std::min<uint64_t>(room / sizeof(Stored), most_links)) break;
    std::vector<Stored> payload(head.links);
    file_.read_at(bytes_ + sizeof head, std::as_writable_bytes(std::span(payload)));
    const BlockHead expected = head_of(bytes_, std::as_bytes(std::span(payload)), head.links);
    if (std::memcmp(&head, &expected, sizeof head) != 0) break;
    for (const Stored& link : payload) links_.push_back(loaded(link));
    bytes_ += sizeof head + payload.size() * sizeof(Stored);
  }
  file_.truncate(bytes_);
}

void MapJournal::append(std::span<const sim::MapLink> links) {
  if (links.empty()) return;
  std::vector<Stored> payload;
  for (const sim::MapLink& link : links) payload.push_back(stored(link));
  const BlockHead head = head_of(bytes_, std::as_bytes(std::span(payload)), payload.size());
  io::Bytes bytes;
  io::append(bytes, std::as_bytes(std::span(&head, 1)));
  io::append(bytes, std::as_bytes(std::span(payload)));
  file_.write_at(bytes_, bytes);
  bytes_ += bytes.size();
  links_.insert(links_.end(), links.begin(), links.end());
}

void MapJournal::finish() {
  file_.close();
  fs::remove(folder_ / journal_file);
}

}  // namespace greatx::apps
