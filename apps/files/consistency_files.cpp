// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/files/consistency_files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "core/parallel.h"
#include "io/dataset/dataset_reader.h"
#include "io/files/inside.h"
#include "io/files/untrusted_json.h"

namespace greatx::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char* header = "figure,sequence,tick,sensor,other,compared,largest_relative_error";
/// Largest difference between the errors of the run and the recomputed ones, relative to 1 + error. Both are
/// computed from the same arrays; only the order of the sums may differ.
constexpr double agreement = 1e-12;
constexpr size_t most_instances = 1 << 22;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields{""};
  for (const char c : line)
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

template <typename T>
bool parse(const std::string& text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Returns the first of the arrays that no file keeps exactly, with its sensor; empty: files keep all of
/// them.
std::string unwritten(const SensorSpec& sensor, const std::vector<std::string>& arrays) {
  for (const std::string& name : arrays) {
    const bool kept = std::ranges::any_of(sensor.outputs, [&](const OutputSpec& output) {
      return output.format != FileFormat::png_depth24 && !io::is_export(output.format) &&
             std::ranges::find(output.arrays, name) != output.arrays.end();
    });
    if (!kept) return fmt::format("{} of {}", name, sensor.name);
  }
  return {};
}

/// Returns the comparison of a figure that has rows; null: there is none of this name.
const sim::Comparison* comparison_with_rows(const std::string& figure) {
  const sim::Comparison* const comparison = sim::comparison_called(figure);
  return comparison != nullptr && comparison->recompute != nullptr ? comparison : nullptr;
}

/// Returns the comparison of a row that parse_consistency_csv() accepted.
const sim::Comparison& comparison_of(const sim::ConsistencyRow& row) {
  const sim::Comparison* const comparison = comparison_with_rows(row.figure);
  GREATX_CHECK(comparison != nullptr, "no figure '{}'", row.figure);
  return *comparison;
}

/// Recomputes rows of consistency.csv from the records of a data set.
class Recomputer {
 public:
  explicit Recomputer(const fs::path& folder) : reader_(folder) {
    for (uint32_t s = 0; s < reader_.sensors().size(); ++s) numbers_[reader_.sensors()[s].name] = s;
    read_boxes();
    for (uint32_t sequence = 0; sequence < reader_.sequences(); ++sequence)
      for (const io::IndexRow& row : reader_.records(sequence))
        rows_[{sequence, row.tick, static_cast<uint32_t>(row.sensor)}] = row;
  }

  const SensorSpec* sensor(const std::string& name) const {
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? nullptr : &reader_.sensors()[found->second];
  }

  /// Returns the first of the arrays that a row needs and that is not on disk; empty: all are there.
  std::string missing(const sim::ConsistencyRow& row) const {
    const SensorSpec &a = *sensor(row.sensor), &b = *sensor(row.other);
    const sim::Comparison::Needs needs = comparison_of(row).needs(b);
    std::string absent = unwritten(a, needs.arrays);
    if (absent.empty()) absent = unwritten(b, needs.of_other);
    if (absent.empty() && needs.boxes && boxes_.empty()) absent = "box_m of instances";
    return absent;
  }

  sim::ErrorStatistics recompute(const sim::ConsistencyRow& row) const {
    return comparison_of(row).recompute(view(row, row.sensor), view(row, row.other), boxes_);
  }

 private:
  struct Key {
    uint32_t sequence = 0;
    int64_t tick = 0;
    uint32_t sensor = 0;
    auto operator<=>(const Key&) const = default;
  };

  void read_boxes() {
    const fs::path file = reader_.folder() / io::dataset_file;
    const io::JsonDocument run(reader_.info().run_json, {file.string() + ": run", 0});
    const SensorSpec* const poses = sensor("poses");
    if (!run.root().has("instances") || poses == nullptr) return;
    const io::JsonDocument metadata(poses->metadata_json, {file.string() + ": poses: metadata", 0});
    std::map<std::string, uint32_t> nodes;
    for (const io::JsonValue& node : metadata.root().at("nodes").list(most_instances))
      nodes.emplace(node.text(), static_cast<uint32_t>(nodes.size()));
    for (const io::JsonValue& instance : run.root().at("instances").list(most_instances)) {
      sim::InstanceBox& box = boxes_.emplace_back();
      if (!instance.has("box_m")) continue;
      for (const io::JsonValue& corner : instance.at("box_m").tuple(2)) {
        const std::vector<io::JsonValue> xyz = corner.tuple(3);
        const auto metres = [&](size_t axis) { return xyz[axis].number(-1e12, 1e12); };
        box.box.add(dvec3(metres(0), metres(1), metres(2)));
      }
      if (!instance.has("node")) continue;
      const auto node = nodes.find(instance.at("node").text());
      if (node == nodes.end()) instance.at("node").fail("one of the nodes of the poses");
      box.node = node->second;
    }
  }

  sim::RecordView view(const sim::ConsistencyRow& row, const std::string& name) const {
    const uint32_t number = numbers_.at(name);
    const auto found = rows_.find({row.sequence, row.tick, number});
    if (found == rows_.end()) throw_user_error("{} has no record at tick {}", name, row.tick);
    return {reader_.sensors()[number],
            [this, sequence = row.sequence, record = found->second](const std::string& array) {
              const std::lock_guard lock(mutex_);  // only one thread at a time may read a stack
              return reader_.load(sequence, record, array);
            }};
  }

  io::DatasetReader reader_;
  std::map<std::string, uint32_t> numbers_;
  std::map<Key, io::IndexRow> rows_;
  std::vector<sim::InstanceBox> boxes_;
  mutable std::mutex mutex_;
};

std::string words(uint64_t compared, double largest) {
  return fmt::format("{} compared, largest relative error {:.3e}", compared, largest);
}

/// Returns the place of a record's files, for a message.
std::string place_of(const sim::ConsistencyRow& row) {
  return fmt::format("{}/{}, tick {}", io::sequence_folder(row.sequence), row.sensor, row.tick);
}

}  // namespace

std::string consistency_csv(const std::vector<sim::ConsistencyRow>& rows) {
  std::string text = std::string(header) + "\n";
  for (const sim::ConsistencyRow& row : rows)
    text += fmt::format("{},{},{},{},{},{},{}\n", row.figure, row.sequence, row.tick, row.sensor, row.other,
                        row.compared, row.largest);
  return text;
}

std::vector<sim::ConsistencyRow> parse_consistency_csv(const std::string& text, const std::string& name) {
  std::vector<sim::ConsistencyRow> rows;
  size_t number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (++number == 1) {
      if (line != header)
        throw_user_error("{}:1: expected '{}', found '{}'", name, header, line.substr(0, 200));
      continue;
    }
    const std::vector<std::string> fields = split(line);
    sim::ConsistencyRow row;
    const bool whole = fields.size() == 7 && parse(fields[1], row.sequence) && parse(fields[2], row.tick) &&
                       parse(fields[5], row.compared) && parse(fields[6], row.largest);
    if (!whole || comparison_with_rows(fields[0]) == nullptr)
      throw_user_error("{}:{}: expected a figure's line ({}), found '{}'", name, number, header,
                       line.substr(0, 200));
    row.figure = fields[0];
    row.sensor = fields[3];
    row.other = fields[4];
    rows.push_back(row);
  }
  if (number == 0) throw_user_error("{}:1: expected '{}', found nothing", name, header);
  return rows;
}

ConsistencyReport verify_consistency(const fs::path& folder, uint32_t threads) {
  ConsistencyReport report;
  const fs::path file = folder / io::consistency_file;
  const Recomputer recomputer(folder);
  if (!io::exists_inside(folder, io::consistency_file)) {
    report.notes.push_back(
        fmt::format("{} is not there: nothing to hold the files against", io::consistency_file));
    return report;
  }
  const std::vector<sim::ConsistencyRow> rows =
      parse_consistency_csv(io::read_text_file(file), io::consistency_file);
  struct Result {
    std::string missing;
    sim::ErrorStatistics errors;
    std::optional<io::Problem> problem;
  };
  std::vector<Result> results(rows.size());
  parallel_for(rows.size(), threads, [&](size_t i) {
    const sim::ConsistencyRow& row = rows[i];
    Result& result = results[i];
    for (const std::string& name : {row.sensor, row.other})
      if (recomputer.sensor(name) == nullptr) {
        result.problem = io::Problem{io::consistency_file, "sensor", "one of the data set", name};
        return;
      }
    result.missing = recomputer.missing(row);
    if (!result.missing.empty()) return;
    try {
      result.errors = recomputer.recompute(row);
    } catch (const std::exception& error) {
      result.problem = io::Problem{place_of(row), fmt::format("{}: {}", row.figure, error.what()), {}, {}};
      return;
    }
    const bool same = result.errors.count() == row.compared &&
                      std::abs(result.errors.max() - row.largest) <= agreement * (1.0 + row.largest);
    if (!same)
      result.problem =
          io::Problem{place_of(row), fmt::format("{} against {}, recomputed", row.figure, row.other),
                      words(row.compared, row.largest), words(result.errors.count(), result.errors.max())};
  });
  std::map<std::string, ConsistencyReport::Figure> figures;  // the report is in the order of the names
  for (size_t i = 0; i < rows.size(); ++i) {
    ConsistencyReport::Figure& figure = figures[rows[i].figure];
    if (!results[i].missing.empty()) {
      ++figure.unwritten;
      figure.missing = results[i].missing;
      continue;
    }
    ++figure.records;
    figure.compared += results[i].errors.count();
    figure.largest = std::max(figure.largest, results[i].errors.max());
  }
  for (auto& [name, figure] : figures) {
    figure.name = name;
    report.figures.push_back(figure);
    if (figure.unwritten > 0)
      report.notes.push_back(fmt::format("{}: not recomputed for {} records: {} is not written", name,
                                         figure.unwritten, figure.missing));
  }
  for (const sim::Comparison& comparison : sim::comparisons())
    if (comparison.recompute == nullptr)
      report.notes.push_back(fmt::format("{}: not recomputed: {}", comparison.figure, comparison.obstacle));
  for (const Result& result : results)
    if (result.problem) report.problems.push_back(*result.problem);
  return report;
}

}  // namespace greatx::apps
