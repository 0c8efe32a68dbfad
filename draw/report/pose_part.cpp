// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts of a sequence that follow from poses and from statistics of channels at all ticks.
#include <algorithm>
#include <cmath>

#include "core/array_numbers.h"
#include "core/text.h"
#include "draw/report/parts.h"

namespace greatx::io::report {

namespace {

/// Returns at most most_series_points of the rows, evenly, with the first and the last.
std::vector<IndexRow> evenly(const std::vector<IndexRow>& rows) {
  if (rows.size() <= most_series_points) return rows;
  std::vector<IndexRow> kept;
  for (size_t i = 0; i < most_series_points; ++i)
    kept.push_back(rows[i * (rows.size() - 1) / (most_series_points - 1)]);
  return kept;
}

void note_evenly(Collected& collected, const std::string& what, size_t rows) {
  if (rows > most_series_points)
    collected.notes.insert(
        fmt::format("{}: {} of {} records are points of the plots.", what, most_series_points, rows));
}

/// A quantity of a link that is plotted: 10 log10 of it if `decibels`, else times `factor`.
struct Quantity {
  const char *array, *title, *unit;
  bool decibels;
  double factor;
};
constexpr Quantity quantities[] = {{"path_gain", "path gain", "dB", true, 1.0},
                                   {"received_power", "received power", "dBm", false, 1.0},
                                   {"delay_spread", "rms delay spread", "ns", false, 1e9},
                                   {"k_factor", "K-factor", "dB", true, 1.0},
                                   {"doppler_spread", "rms Doppler spread", "Hz", false, 1.0},
                                   {"path_count", "paths", "", false, 1.0}};

Json times_json(const std::vector<IndexRow>& rows) {
  Json times = Json::array();
  for (const IndexRow& row : rows) times.push_back(rounded(1e-9 * static_cast<double>(row.time_ns), 6));
  return times;
}

Json channel_series(const PanelSource& source, Collected& collected) {
  const std::vector<IndexRow> all = source.records.records_of(source.sequence, source.sensor),
                              rows = evenly(all);
  note_evenly(collected, printable(source.spec().name), all.size());
  Json lines = Json::array();
  for (const Quantity& quantity : quantities) {
    if (!source.has(quantity.array)) continue;
    std::vector<Json> values;
    size_t transmitters = 1;
    for (const IndexRow& row : rows) {
      const Array array = source.load(row, quantity.array, {DType::f64, DType::f32, DType::i32}, {0, 0});
      transmitters = static_cast<size_t>(array.shape[1]);
      const size_t links = std::min(most_links, static_cast<size_t>(array.element_count()));
      values.resize(links, Json::array());
      for (size_t i = 0; i < links; ++i) {
        const double value = number_at(array, i);
        values[i].push_back(
            rounded(quantity.decibels ? 10.0 * std::log10(value) : quantity.factor * value, 3));
      }
    }
    for (size_t i = 0; i < values.size(); ++i)
      lines.push_back({{"title", quantity.title},
                       {"unit", quantity.unit},
                       {"rx", i / transmitters},
                       {"tx", i % transmitters},
                       {"values", std::move(values[i])}});
  }
  return {{"sensor", source.sensor}, {"times", times_json(rows)}, {"lines", std::move(lines)}};
}

Json pose_series(const PoseTable& poses, Collected& collected) {
  const PanelSource& source = poses.source();
  const std::vector<IndexRow> rows = evenly(poses.rows());
  note_evenly(collected, printable(source.spec().name), poses.rows().size());
  const size_t nodes = std::min(poses.nodes().size(), most_nodes_shown);
  std::vector<Json> speed(nodes, Json::array()), altitude(nodes, Json::array());
  const bool moving = source.has("velocity");
  for (const IndexRow& row : rows) {
    const Array p = source.load(row, "position", {DType::f64}, {-1, 3});
    std::optional<Array> v;
    if (moving) v = source.load(row, "velocity", {DType::f64}, {-1, 3});
    for (size_t n = 0; n < std::min(nodes, static_cast<size_t>(p.shape[0])); ++n) {
      altitude[n].push_back(rounded(p.as<double>()[3 * n + 2], 3));
      if (v && 3 * n + 2 < v->as<double>().size()) {
        const double* const at = v->as<double>().data() + 3 * n;
        speed[n].push_back(rounded(std::hypot(at[0], at[1], at[2]), 4));
      }
    }
  }
  Json lines = Json::array();
  for (const bool speeds : {true, false})
    for (size_t n = 0; n < nodes; ++n)
      if (!speeds || moving)
        lines.push_back({{"title", speeds ? "speed" : "altitude (z)"},
                         {"unit", speeds ? "m/s" : "m"},
                         {"node", n},
                         {"values", std::move((speeds ? speed : altitude)[n])}});
  return {{"sensor", source.sensor}, {"times", times_json(rows)}, {"lines", std::move(lines)}};
}

}  // namespace

int64_t nearest(double value) { return std::isfinite(value) ? std::llround(value) : 0; }

Json rounded(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  double scale = 1.0;
  for (int i = 0; i < digits; ++i) scale *= 10.0;
  const double result = std::round(value * scale) / scale;
  if (std::abs(result) < 1e15 && result == std::round(result)) return static_cast<int64_t>(result);
  return result;
}

Json place_json(const Context& context, const dvec3& world) {
  Json json = Json::array();
  for (int i = 0; i < 3; ++i) json.push_back(rounded(world[i] - context.poses.origin()[i], 3));
  return json;
}

Json pose_json(const Context& context, const std::optional<Pose>& pose) {
  if (!pose) return nullptr;
  Json json = Json::array();
  for (int i = 0; i < 3; ++i) json.push_back(rounded(pose->position[i] - context.poses.origin()[i], 4));
  const dquat& q = pose->orientation;
  for (const double part : {q.w, q.x, q.y, q.z}) json.push_back(rounded(part, 9));
  return json;
}

std::string shown_name(std::string_view name) {
  std::string text = printable(name);
  if (text.size() <= most_name) return text;
  size_t end = most_name;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0u) == 0x80u) --end;  // within a character
  return text.substr(0, end) + "...";
}

PoseTable::PoseTable(const RecordSource& records, uint32_t sequence) {
  for (size_t i = 0; i < records.sensors().size(); ++i) {
    const PanelSource source{records, sequence, i, {}};
    if (source.spec().kind != "pose" || !source.has("position") || !source.has("orientation")) continue;
    source_.emplace(source);
    nodes_ = node_names(source);
    rows_ = records.records_of(sequence, i);
    break;
  }
  if (rows_.empty()) return;
  const std::vector<Pose> first = at(rows_.front());
  if (!first.empty()) origin_ = glm::round(first.front().position);
}

std::vector<Pose> PoseTable::at(const IndexRow& row) const {
  const Array p = source_->load(row, "position", {DType::f64}, {-1, 3}),
              q = source_->load(row, "orientation", {DType::f64}, {-1, 4});
  expect_same_rows(*source_, {&p, &q});
  std::vector<Pose> poses;
  for (size_t n = 0; n < static_cast<size_t>(p.shape[0]); ++n) {
    const double *const at = p.as<double>().data() + 3 * n, *const turn = q.as<double>().data() + 4 * n;
    poses.push_back({{at[0], at[1], at[2]}, dquat(turn[0], turn[1], turn[2], turn[3])});
  }
  return poses;
}

std::vector<Pose> PoseTable::at(int64_t tick) const {
  const auto found = std::ranges::lower_bound(rows_, tick, {}, &IndexRow::tick);
  if (!source_ || found == rows_.end() || found->tick != tick) return {};
  return at(*found);
}

std::optional<Pose> PoseTable::world_from(const std::string& node, const Pose& mount, int64_t tick) const {
  const auto found = std::ranges::find(nodes_, node);
  if (found == nodes_.end()) return std::nullopt;
  const std::vector<Pose> poses = at(tick);
  const auto number = static_cast<size_t>(found - nodes_.begin());
  if (number >= poses.size()) return std::nullopt;
  return poses[number] * mount;
}

Json trajectories_json(const PoseTable& poses, Collected& collected) {
  Json lines = Json::array();
  if (!poses.any()) return lines;
  const size_t nodes = std::min(poses.nodes().size(), most_nodes_shown);
  if (nodes < poses.nodes().size())
    collected.notes.insert(fmt::format("The first {} of {} nodes are shown.", nodes, poses.nodes().size()));
  std::vector<Json> places(nodes, Json::array());
  for (const IndexRow& row : evenly(poses.rows())) {
    const std::vector<Pose> all = poses.at(row);
    for (size_t n = 0; n < std::min(nodes, all.size()); ++n)
      for (int c = 0; c < 3; ++c) places[n].push_back(rounded(all[n].position[c] - poses.origin()[c], 3));
  }
  for (size_t n = 0; n < nodes; ++n)
    lines.push_back({{"name", shown_name(poses.nodes()[n])}, {"places", std::move(places[n])}});
  return lines;
}

Json poses_json(const Context& context, const std::vector<IndexRow>& moments) {
  Json list = Json::array();
  if (!context.poses.any()) return list;
  const PanelSource& source = context.poses.source();
  const bool geodetic = source.has("geodetic");
  for (const IndexRow& moment : moments) {
    // The latest pose, as for every other sensor.
    const auto& rows = context.poses.rows();
    auto row = std::ranges::upper_bound(rows, moment.tick, {}, &IndexRow::tick);
    if (row == rows.begin()) {
      list.push_back(nullptr);
      continue;
    }
    --row;
    Json entry = {{"poses", Json::array()}};
    for (const Pose& pose : context.poses.at(*row)) {
      if (entry["poses"].size() == most_nodes_shown) break;
      entry["poses"].push_back(pose_json(context, pose));
    }
    if (geodetic) {
      const Array place = source.load(*row, "geodetic", {DType::f64}, {-1, 3});
      for (size_t n = 0; n < std::min(most_nodes_shown, static_cast<size_t>(place.shape[0])); ++n) {
        const double* const at = place.as<double>().data() + 3 * n;
        entry["geodetic"].push_back({rounded(at[0], 7), rounded(at[1], 7), rounded(at[2], 3)});
      }
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json series_json(const RecordSource& records, uint32_t sequence, const PoseTable& poses,
                 Collected& collected) {
  Json list = Json::array();
  for (size_t i = 0; i < records.sensors().size(); ++i) {
    const PanelSource source{records, sequence, i, {}};
    if (source.spec().kind == "csi" && !records.records_of(sequence, i).empty())
      list.push_back(channel_series(source, collected));
  }
  if (poses.any() && !poses.rows().empty()) list.push_back(pose_series(poses, collected));
  return list;
}

}  // namespace greatx::io::report
