// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/index.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "apps/campaign/sqlite.h"
#include "apps/console/progress.h"
#include "core/array_numbers.h"
#include "core/text.h"
#include "io/dataset/dataset_reader.h"
#include "io/files/file.h"

namespace greatx::apps {

namespace fs = std::filesystem;

namespace {

/// What the index says of a link.
struct LinkFigures {
  int64_t rx = 0, tx = 0, paths = 0, line_of_sight = 0;
  std::optional<double> gain_db, delay_spread_s, k_db;
};

double decibels_of(double power) { return 10.0 * std::log10(power); }

/// Reads one data set for the index.
class IndexedSet {
 public:
  explicit IndexedSet(const fs::path& folder) : reader_(folder) {
    for (size_t s = 0; s < reader_.sensors().size(); ++s) {
      const SensorSpec& spec = reader_.sensors()[s];
      const nlohmann::json metadata = nlohmann::json::parse(spec.metadata_json);
      if (spec.kind == "pose") {
        poses_ = s;
        for (size_t n = 0; n < metadata.at("nodes").size(); ++n) nodes_[metadata["nodes"][n]] = n;
      }
      // The pose of a channel's record is that of its first receiver.
      std::string name = spec.name;
      if (spec.kind == "csi" && metadata.contains("receivers") && !metadata["receivers"].empty())
        name = metadata["receivers"][0].at("name");
      carriers_.push_back(name.substr(0, name.find('/')));
    }
  }

  const io::DatasetReader& reader() const { return reader_; }
  /// Returns x, y, z and w, x, y, z of the node that carries a sensor at a record's tick. Calls must go
  /// through the ticks of a sequence in order.
  std::array<std::optional<double>, 7> pose(uint32_t sequence, const io::IndexRow& row) {
    std::array<std::optional<double>, 7> pose;
    const auto node = nodes_.find(carriers_.at(static_cast<size_t>(row.sensor)));
    if (node == nodes_.end() || !poses_) return pose;
    find_tick(sequence, row.tick);
    if (!positions_ || !orientations_) return pose;
    for (size_t i = 0; i < 3; ++i) pose[i] = number_at(*positions_, 3 * node->second + i);
    for (size_t i = 0; i < 4; ++i) pose[3 + i] = number_at(*orientations_, 4 * node->second + i);
    return pose;
  }

  /// Returns the links of a channel's record; none for other sensors.
  std::vector<LinkFigures> links(uint32_t sequence, const io::IndexRow& row) const {
    std::vector<LinkFigures> links;
    const SensorSpec& spec = reader_.sensors()[static_cast<size_t>(row.sensor)];
    if (spec.kind != "csi") return links;
    const Array paths = reader_.load(sequence, row, "path_count"),
                gain = reader_.load(sequence, row, "path_gain"),
                lit = reader_.load(sequence, row, "line_of_sight"),
                spread = reader_.load(sequence, row, "delay_spread"),
                k = reader_.load(sequence, row, "k_factor");
    const auto transmitters = static_cast<size_t>(paths.shape.at(1));
    for (size_t i = 0; i < static_cast<size_t>(paths.element_count()); ++i) {
      LinkFigures link;
      link.rx = static_cast<int64_t>(i / transmitters), link.tx = static_cast<int64_t>(i % transmitters);
      link.paths = static_cast<int64_t>(number_at(paths, i));
      link.line_of_sight = static_cast<int64_t>(number_at(lit, i));
      link.gain_db = decibels_of(number_at(gain, i));
      link.delay_spread_s = number_at(spread, i);
      link.k_db = decibels_of(number_at(k, i));
      links.push_back(link);
    }
    return links;
  }

  /// Returns the file with the record's first output, relative to the data set.
  std::string file_of(uint32_t sequence, const io::IndexRow& row) const {
    const SensorSpec& spec = reader_.sensors()[static_cast<size_t>(row.sensor)];
    for (const OutputSpec& output : spec.outputs) {
      if (io::is_frame(output.format)) return io::frame_path(sequence, spec, output, row.sample);
      if (io::is_stack(output.format)) return io::stack_path(sequence, spec, output);
      if (io::is_packed(output.format)) return io::packed_path(sequence, spec, output);
    }
    return {};
  }

 private:
  void find_tick(uint32_t sequence, int64_t tick) {
    if (sequence_ != sequence) {
      rows_ = reader_.records_of(sequence, *poses_);
      sequence_ = sequence, next_ = 0, tick_ = -1;
    }
    if (tick_ == tick) return;
    while (next_ < rows_.size() && rows_[next_].tick < tick) ++next_;
    positions_.reset(), orientations_.reset();
    tick_ = tick;
    if (next_ == rows_.size() || rows_[next_].tick != tick) return;
    positions_ = reader_.load(sequence, rows_[next_], "position");
    orientations_ = reader_.load(sequence, rows_[next_], "orientation");
  }

  io::DatasetReader reader_;
  std::optional<size_t> poses_;
  std::map<std::string, size_t> nodes_;
  std::vector<std::string> carriers_;  ///< [sensors] nodes
  std::optional<uint32_t> sequence_;
  std::vector<io::IndexRow> rows_;  ///< of the poses
  size_t next_ = 0;
  int64_t tick_ = -1;
  std::optional<Array> positions_, orientations_;
};

constexpr const char* record_columns[] = {
    // of the record
    "record", "cell", "sequence", "split", "tick", "time_ns", "sensor", "kind", "sample", "row", "data",
    "file",
    // its pose
    "x", "y", "z", "qw", "qx", "qy", "qz",
    // of the first link of its tick
    "rx", "tx", "path_count", "line_of_sight", "path_gain_db", "delay_spread_s", "k_factor_db"};
constexpr const char* link_columns[] = {
    "record", "rx", "tx", "path_count", "line_of_sight", "path_gain_db", "delay_spread_s", "k_factor_db"};

std::string record_table(const sim::Campaign& campaign) {
  std::string sql =
      "CREATE TABLE records (record INTEGER PRIMARY KEY, cell TEXT, sequence INTEGER, split TEXT, tick "
      "INTEGER, "
      "time_ns INTEGER, sensor TEXT, kind TEXT, sample INTEGER, row INTEGER, data TEXT, file TEXT, x REAL, y "
      "REAL, z REAL, qw REAL, qx REAL, qy REAL, qz REAL, rx INTEGER, tx INTEGER, path_count INTEGER, "
      "line_of_sight INTEGER, path_gain_db REAL, delay_spread_s REAL, k_factor_db REAL";
  for (const sim::CampaignAxis& axis : campaign.axes) sql += fmt::format(", \"axis_{}\" TEXT", axis.name);
  sql += ')';
  return sql;
}

std::string csv_number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{}", *value) : std::string();
}

/// Writes both files of the index.
class IndexWriter {
 public:
  IndexWriter(const OpenCampaign& open, const fs::path& sqlite, const fs::path& csv)
      : open_(open), file_(sqlite), csv_path_(csv), csv_(csv, std::ios::binary) {
    file_.run(record_table(open.campaign));
    file_.run(
        "CREATE TABLE links (record INTEGER, rx INTEGER, tx INTEGER, path_count INTEGER, line_of_sight "
        "INTEGER, "
        "path_gain_db REAL, delay_spread_s REAL, k_factor_db REAL)");
    records_.emplace(file_, "records", std::size(record_columns) + open.campaign.axes.size());
    links_.emplace(file_, "links", std::size(link_columns));
    std::vector<std::string> columns(std::begin(record_columns), std::end(record_columns));
    for (const sim::CampaignAxis& axis : open.campaign.axes) columns.push_back("axis_" + axis.name);
    csv_ << fmt::format("{}\n", fmt::join(columns, ","));
  }

  /// Adds the records of one tick of a sequence.
  void add_tick(size_t cell, uint32_t sequence, std::span<const io::IndexRow> rows, IndexedSet& set) {
    std::vector<std::vector<LinkFigures>> links;
    std::optional<LinkFigures> first;
    for (const io::IndexRow& row : rows) {
      links.push_back(set.links(sequence, row));
      if (!first && !links.back().empty()) first = links.back().front();
    }
    for (size_t i = 0; i < rows.size(); ++i) add(cell, sequence, rows[i], links[i], first, set);
  }

  uint64_t finish() {
    records_.reset(), links_.reset();
    // The planner of queries needs the numbers of ANALYZE to tell the indices apart.
    file_.run(
        "CREATE INDEX records_cell ON records (cell, sequence, tick); CREATE INDEX records_kind ON records "
        "(cell, kind); CREATE INDEX records_sensor ON records (kind, split, line_of_sight); CREATE INDEX "
        "records_gain ON records (kind, path_gain_db); CREATE INDEX links_record ON links (record); CREATE "
        "INDEX links_gain ON links (path_gain_db); PRAGMA analysis_limit=1000; ANALYZE; COMMIT");
    csv_.flush();
    if (!csv_) throw io::WriteError(csv_path_, errno);
    return static_cast<uint64_t>(count_);
  }

 private:
  /// `links`: of the record itself; `first`: the first link of the tick.
  void add(size_t cell, uint32_t sequence, const io::IndexRow& row, const std::vector<LinkFigures>& links,
           const std::optional<LinkFigures>& first, IndexedSet& set) {
    const sim::CampaignCell& of = open_.cells[cell];
    const SensorSpec& spec = set.reader().sensors()[static_cast<size_t>(row.sensor)];
    const char* split =
        sim::split_names[static_cast<size_t>(sim::split_of(open_.campaign, of.values, sequence))];
    const std::string data = fmt::format("data/{}", of.name), file = set.file_of(sequence, row);
    const auto pose = set.pose(sequence, row);
    const int64_t record = count_++;
    records_->add(record).add(of.name).add(int64_t{sequence}).add(split).add(row.tick).add(row.time_ns);
    records_->add(spec.name).add(spec.kind).add(row.sample).add(row.row).add(data).add(file);
    for (const auto& value : pose) records_->add(value);
    std::string line =
        fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", record, of.name, sequence, split, row.tick,
                    row.time_ns, spec.name, spec.kind, row.sample, row.row, data, file);
    for (const auto& value : pose) line += fmt::format(",{}", csv_number(value));
    add_first(first, line);
    for (size_t a = 0; a < of.values.size(); ++a) {
      const std::string& value = open_.campaign.axes[a].values[of.values[a]].name;
      records_->add(value);
      line += fmt::format(",{}", value);
    }
    records_->end_row();
    csv_ << line << '\n';
    for (const LinkFigures& link : links) {
      links_->add(record).add(link.rx).add(link.tx).add(link.paths).add(link.line_of_sight);
      links_->add(link.gain_db).add(link.delay_spread_s).add(link.k_db).end_row();
    }
  }

  /// Adds the figures of a link to a row of records and to its line; empty ones if there is none.
  void add_first(const std::optional<LinkFigures>& link, std::string& line) {
    constexpr size_t figures = 7;
    if (!link) {
      for (size_t i = 0; i < figures; ++i) records_->add(std::optional<double>());
      line += std::string(figures, ',');
      return;
    }
    records_->add(link->rx).add(link->tx).add(link->paths).add(link->line_of_sight);
    records_->add(link->gain_db).add(link->delay_spread_s).add(link->k_db);
    line += fmt::format(",{},{},{},{},{},{},{}", link->rx, link->tx, link->paths, link->line_of_sight,
                        csv_number(link->gain_db), csv_number(link->delay_spread_s), csv_number(link->k_db));
  }

  const OpenCampaign& open_;
  SqliteFile file_;
  std::optional<SqliteInsert> records_, links_;
  fs::path csv_path_;
  std::ofstream csv_;
  int64_t count_ = 0;
};

/// Adds the records of a sequence, tick by tick.
void add_sequence(size_t cell, uint32_t sequence, IndexedSet& set, IndexWriter& writer) {
  const std::vector<io::IndexRow>& rows = set.reader().records(sequence);
  for (size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    for (end = begin + 1; end < rows.size() && rows[end].tick == rows[begin].tick;) ++end;
    writer.add_tick(cell, sequence, std::span(rows).subspan(begin, end - begin), set);
  }
}

}  // namespace

uint64_t write_index(const OpenCampaign& open, bool quiet) {
  const fs::path sqlite = open.folder / "index.sqlite", csv = open.folder / "index.csv";
  std::error_code ignored;
  const auto remove_parts = [&] {
    fs::remove(io::part_name(sqlite), ignored);
    fs::remove(io::part_name(csv), ignored);
  };
  remove_parts();
  uint64_t records = 0;
  try {
    IndexWriter writer(open, io::part_name(sqlite), io::part_name(csv));
    Progress progress("index", static_cast<int64_t>(open.cells.size()), quiet, "cells");
    for (size_t cell = 0; cell < open.cells.size(); ++cell) {
      if (!open.merged(cell)) continue;
      IndexedSet set(open.data(cell));
      for (uint32_t s = 0; s < set.reader().sequences(); ++s) add_sequence(cell, s, set, writer);
      progress.update(static_cast<int64_t>(cell) + 1);
    }
    records = writer.finish();
  } catch (...) {
    remove_parts();
    throw;
  }
  io::rename_file(io::part_name(sqlite), sqlite);
  io::rename_file(io::part_name(csv), csv);
  return records;
}

}  // namespace greatx::apps
