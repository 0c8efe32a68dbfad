// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/report/report.h"

#include <algorithm>

#include "core/text.h"
#include "draw/report/page.h"
#include "draw/report/parts.h"
#include "io/formats/html_text.h"

namespace greatx::io {

namespace {

using report::Json;

struct KindOfPart {
  std::string_view kind;
  Json (*describe)(const PanelSource&);
  Json (*encode)(const report::Context&, const PanelSource&, const IndexRow&);
};
constexpr KindOfPart kinds_of_parts[] = {
    {"camera", report::describe_camera, report::encode_camera},
    {"event_camera", report::describe_events, report::encode_events},
    {"lidar", report::describe_lidar, report::encode_lidar},
    {"radar", report::describe_radar, report::encode_radar},
    {"csi", report::describe_channel, report::encode_channel},
};
const KindOfPart* part_of(const SensorSpec& sensor) {
  const auto* const found = std::ranges::find(kinds_of_parts, sensor.kind, &KindOfPart::kind);
  return found == std::end(kinds_of_parts) ? nullptr : found;
}

/// Fewer moments than this are not shown as long as a coarser detail allows more.
constexpr size_t enough_moments = 24;

/// A record that is packed: its JSON, its blobs, and the characters that both take in the page.
struct PackedRecord {
  Json json;
  size_t first_blob = 0, last_blob = 0;
  uint64_t page_bytes = 0;
};

/// Packs the moments of one sequence into a number of bytes.
class SequencePacker {
 public:
  SequencePacker(const DatasetReader& reader, uint32_t sequence, report::Blobs& blobs,
                 report::Collected& collected)
      : reader_(reader), sequence_(sequence), blobs_(blobs), collected_(collected), poses_(reader, sequence) {
    for (size_t i = 0; i < reader.sensors().size(); ++i) {
      rows_.push_back(reader.records_of(sequence, i));
      // The poses fire whenever another sensor does.
      if (reader.sensors()[i].kind == "pose") continue;
      ticks_.insert(ticks_.end(), rows_.back().begin(), rows_.back().end());
    }
    if (ticks_.empty()) ticks_ = reader.records(sequence);
    std::ranges::sort(ticks_, {}, &IndexRow::tick);
    const auto rest = std::ranges::unique(ticks_, {}, &IndexRow::tick);
    ticks_.erase(rest.begin(), rest.end());
  }

  /// Returns the sequence's JSON. Together with its blobs it takes at most `most_bytes`.
  Json pack(uint64_t most_bytes, size_t most_moments, const ReportProgress& progress, int64_t done,
            int64_t total);
  const std::vector<size_t>& blobs_used() const { return used_; }
  /// The characters that the packed sequence takes.
  uint64_t page_bytes() const { return page_bytes_; }
  size_t moments() const { return moments_.size(); }
  size_t ticks() const { return ticks_.size(); }
  const dvec3& origin() const { return poses_.origin(); }

 private:
  void choose_moments(size_t count) {
    moments_.clear();
    for (size_t i = 0; i < count; ++i)
      moments_.push_back(ticks_[count == 1 ? 0 : i * (ticks_.size() - 1) / (count - 1)]);
  }
  const PackedRecord& record(size_t sensor, const IndexRow& row);
  /// Packs what the moments show, and returns the characters of it.
  uint64_t pack_moments(const ReportProgress& progress, int64_t done, int64_t total);
  /// The latest record of a sensor at a moment, or nothing.
  const IndexRow* latest(size_t sensor, int64_t tick) const {
    const auto after = std::ranges::upper_bound(rows_[sensor], tick, {}, &IndexRow::tick);
    return after == rows_[sensor].begin() ? nullptr : &*(after - 1);
  }
  report::Context context() const { return {reader_, sequence_, poses_, detail_, blobs_, collected_}; }

  const DatasetReader& reader_;
  uint32_t sequence_;
  report::Blobs& blobs_;
  report::Collected& collected_;
  report::PoseTable poses_;
  std::vector<std::vector<IndexRow>> rows_;  ///< by sensor
  std::vector<IndexRow> ticks_, moments_;    ///< one row for each tick
  report::Detail detail_ = report::details[0];
  std::map<std::pair<size_t, int64_t>, PackedRecord> packed_;  ///< by sensor and row
  std::vector<size_t> used_;
  uint64_t page_bytes_ = 0;
};

const PackedRecord& SequencePacker::record(size_t sensor, const IndexRow& row) {
  const std::pair key{sensor, row.row};
  if (const auto found = packed_.find(key); found != packed_.end()) return found->second;
  PackedRecord result;
  result.first_blob = blobs_.size();
  const PanelSource source{reader_, sequence_, sensor, {}};
  if (const KindOfPart* const part = part_of(source.spec()))
    result.json = part->encode(context(), source, row);
  else
    result.json = Json::object();
  result.json["tick"] = row.tick;
  result.json["time"] = report::rounded(1e-9 * static_cast<double>(row.time_ns), 9);
  result.last_blob = blobs_.size();
  result.page_bytes = result.json.dump().size() + 1 + blobs_.page_bytes(result.first_blob, result.last_blob);
  return packed_.emplace(key, std::move(result)).first->second;
}

uint64_t SequencePacker::pack_moments(const ReportProgress& progress, int64_t done, int64_t total) {
  uint64_t bytes = 0;
  std::set<std::pair<size_t, int64_t>> counted;
  for (const IndexRow& moment : moments_) {
    for (size_t s = 0; s < rows_.size(); ++s) {
      if (part_of(reader_.sensors()[s]) == nullptr) continue;
      const IndexRow* const row = latest(s, moment.tick);
      if (row != nullptr && counted.emplace(s, row->row).second) bytes += record(s, *row).page_bytes;
    }
    if (progress) progress(++done, total);
  }
  return bytes;
}

Json SequencePacker::pack(uint64_t most_bytes, size_t most_moments, const ReportProgress& progress,
                          int64_t done, int64_t total) {
  Json json = {{"number", sequence_},
               {"ticks", ticks_.size()},
               {"lines", report::trajectories_json(poses_, collected_)},
               {"series", report::series_json(reader_, sequence_, poses_, collected_)}};
  const uint64_t fixed = json.dump().size();
  const uint64_t room = most_bytes > fixed ? most_bytes - fixed : 0;
  const size_t wanted = std::min(ticks_.size(), most_moments);
  // A few moments tell what one takes at each detail.
  const report::Collected before = collected_;
  size_t fitting = 0;
  for (const report::Detail& detail : report::details) {
    detail_ = detail;
    packed_.clear();
    collected_ = before;
    choose_moments(std::min<size_t>(wanted, 3));
    const uint64_t each = std::max<uint64_t>(1, pack_moments({}, 0, 0) / moments_.size());
    fitting = static_cast<size_t>(room / each);
    if (2 * fitting >= std::min(wanted, enough_moments)) break;
  }
  // Moments share records of slow sensors, so that more fit than a few moments tell.
  for (size_t count = std::clamp<size_t>(2 * fitting, 1, wanted);;) {
    choose_moments(count);
    const Json poses = report::poses_json(context(), moments_);
    const uint64_t bytes = pack_moments(progress, done, total) + poses.dump().size() + 200 * moments_.size();
    if (bytes <= room) {
      page_bytes_ = fixed + bytes;
      json["poses"] = poses;
      break;
    }
    if (count == 1)
      throw_user_error(
          "{}: expected a bound that one moment of sequence {} fits into, found {:.2f} MB for what takes "
          "{:.2f} MB: raise --html-megabytes",
          reader_.folder().string(), sequence_, 1e-6 * static_cast<double>(most_bytes),
          1e-6 * static_cast<double>(bytes + fixed));
    count = std::clamp<size_t>(static_cast<size_t>(static_cast<double>(count) * 0.97 *
                                                   static_cast<double>(room) / static_cast<double>(bytes)),
                               1, count - 1);
  }
  json["moments"] = Json::array();
  for (const IndexRow& moment : moments_)
    json["moments"].push_back({moment.tick, report::rounded(1e-9 * static_cast<double>(moment.time_ns), 9)});
  json["sensors"] = Json::array();
  for (size_t s = 0; s < rows_.size(); ++s) {
    const SensorSpec& sensor = reader_.sensors()[s];
    Json entry = {{"name", report::shown_name(sensor.name)},
                  {"node", report::shown_name(node_of(sensor))},
                  {"kind", report::shown_name(sensor.kind)}};
    if (const KindOfPart* const part = part_of(sensor)) {
      entry["about"] = part->describe({reader_, sequence_, s, {}});
      entry["records"] = Json::array();
      int64_t last = -1;
      for (const IndexRow& moment : moments_) {
        const IndexRow* const row = latest(s, moment.tick);
        if (row == nullptr || row->row == last) continue;
        last = row->row;
        const PackedRecord& packed = record(s, *row);
        entry["records"].push_back(packed.json);
        for (size_t blob = packed.first_blob; blob < packed.last_blob; ++blob) used_.push_back(blob);
      }
    }
    json["sensors"].push_back(std::move(entry));
  }
  if (moments_.size() < ticks_.size())
    collected_.notes.insert(fmt::format("Sequence {}: {} of {} ticks with records are shown, evenly spaced.",
                                        sequence_, moments_.size(), ticks_.size()));
  return json;
}

std::vector<uint32_t> sequences_of(const DatasetReader& reader, const ReportOptions& options,
                                   report::Collected& collected) {
  if (options.sequence) return {*options.sequence};
  std::vector<uint32_t> chosen;
  uint32_t with_records = 0;
  for (uint32_t i = 0; i < reader.sequences(); ++i) {
    if (reader.records(i).empty()) continue;
    if (++with_records <= most_report_sequences) chosen.push_back(i);
  }
  if (with_records > most_report_sequences)
    collected.notes.insert(fmt::format("The first {} of {} sequences are shown (--sequence chooses another).",
                                       chosen.size(), with_records));
  return chosen;
}

}  // namespace

std::string html_report(const DatasetReader& reader, const ReportOptions& options, ReportFile& file,
                        const ReportProgress& progress) {
  report::Collected collected;
  const std::vector<uint32_t> sequences = sequences_of(reader, options, collected);
  for (const uint32_t sequence : sequences)
    if (sequence >= reader.sequences() || reader.records(sequence).empty())
      throw_user_error("{}: sequence {} has no records to show", reader.folder().string(), sequence);
  if (sequences.empty()) throw_user_error("{}: it has no records to show", reader.folder().string());

  Json data = {{"version", 1}, {"summary", report::summary_json(reader, collected)}};
  const dvec3 origin = report::PoseTable(reader, sequences.front()).origin();
  Json objects = report::objects_json(reader, origin, collected);
  const auto most = static_cast<uint64_t>(options.megabytes * 1e6);
  // Names and notes come last: a share of the room is kept for them.
  const uint64_t fixed =
      report::page_overhead() + json_for_script(data.dump()).size() + objects.dump().size();
  const uint64_t kept_back = std::min<uint64_t>(most / 20, 2'000'000);
  const uint64_t room = most > fixed + kept_back ? most - fixed - kept_back : 0;

  report::Blobs blobs;
  std::vector<size_t> used;
  uint64_t spent = 0;
  data["sequences"] = Json::array();
  const auto total = static_cast<int64_t>(sequences.size()) * 1000;
  file = {};
  for (size_t i = 0; i < sequences.size(); ++i) {
    SequencePacker packer(reader, sequences[i], blobs, collected);
    const auto count = static_cast<int64_t>(std::min(options.moments, packer.ticks()));
    const ReportProgress part = [&](int64_t done, int64_t) {
      if (progress)
        progress(static_cast<int64_t>(i) * 1000 + std::min<int64_t>(1000, 1000 * done / count), total);
    };
    // Room that a sequence leaves is that of the next ones.
    Json sequence = packer.pack((room - spent) / (sequences.size() - i), options.moments, part, 0, count);
    spent += packer.page_bytes();
    const dvec3& own = packer.origin();
    for (int c = 0; c < 3; ++c) sequence["origin"].push_back(own[c]);
    data["sequences"].push_back(std::move(sequence));
    used.insert(used.end(), packer.blobs_used().begin(), packer.blobs_used().end());
    file.moments += packer.moments();
  }
  for (int c = 0; c < 3; ++c) data["origin"].push_back(origin[c]);
  data["objects"] = std::move(objects);
  data["names"] = report::names_json(reader, collected);
  data["notes"] = Json::array();
  for (const std::string& note : collected.notes) data["notes"].push_back(note);
  std::string page = report::page_of(data, blobs, used);
  if (page.size() > most)
    throw_user_error(
        "{}: expected a page of at most {:.2f} MB, found {:.2f} MB of names and descriptions: "
        "raise --html-megabytes",
        reader.folder().string(), options.megabytes, 1e-6 * static_cast<double>(page.size()));
  file.sequences = sequences.size();
  file.bytes = page.size();
  file.notes.assign(collected.notes.begin(), collected.notes.end());
  return page;
}

ReportFile write_html_report(const DatasetReader& reader, const std::filesystem::path& path,
                             const ReportOptions& options, const ReportProgress& progress) {
  // Refused before the work, and before anything is written.
  if (std::filesystem::exists(std::filesystem::symlink_status(path))) {
    if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(path)))
      throw_user_error("{}: expected a report or no file, found something else", path.string());
    const std::string_view mark = report::page_mark();
    std::string begin(mark.size(), '\0');
    const File existing = File::open_for_reading(path);
    if (existing.size() >= mark.size())
      existing.read_at(0, std::as_writable_bytes(std::span(begin.data(), begin.size())));
    if (begin != mark)
      throw_user_error("{}: expected a report or no file, found another file, which is not overwritten",
                       path.string());
  }
  ReportFile file;
  const std::string page = html_report(reader, options, file, progress);
  create_folder_of(path);
  write_file_atomically(path, page);
  return file;
}

}  // namespace greatx::io
