// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/trajectory_shapes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "view/overlay/record_arrays.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

constexpr int64_t second_ns = 1'000'000'000;
constexpr int64_t usual_intervals = 4;

uint64_t bytes_of(const Record& record) {
  uint64_t bytes = sizeof(Record);
  for (const Array& array : record.arrays) bytes += sizeof(Array) + array.bytes.size();
  return bytes;
}

int64_t tick_of(const std::shared_ptr<const Record>& record) { return record->tick; }

int64_t nanoseconds_of(double seconds) {
  return static_cast<int64_t>(std::clamp(seconds, 0.0, 1e9) * static_cast<double>(second_ns));
}

io::Color darker(io::Color color) {
  const auto part = [](uint8_t c) { return static_cast<uint8_t>(c / 2); };
  return {part(color.r), part(color.g), part(color.b)};
}

/// What a record of poses says of a trajectory, [nodes].
struct TrajectoryPoint {
  int64_t time_ns = 0;
  std::span<const double> position, velocity;  ///< [nodes, 3]; no velocity: empty
  dvec3 at(size_t node) const { return {position[3 * node], position[3 * node + 1], position[3 * node + 2]}; }
  double speed(size_t node) const {
    if (velocity.empty()) return 0.0;
    return glm::length(dvec3(velocity[3 * node], velocity[3 * node + 1], velocity[3 * node + 2]));
  }
};

TrajectoryPoint point_of(const SensorSpec& spec, const Record& record, size_t nodes) {
  const RecordArrays arrays(spec, record);
  const auto rows = static_cast<int64_t>(nodes);
  TrajectoryPoint point;
  point.time_ns = record.time_ns;
  point.position = arrays.finite<double>("position", {rows, 3});
  if (arrays.has("velocity")) point.velocity = arrays.finite<double>("velocity", {rows, 3});
  return point;
}

/// Beyond this much between two records, what lies between them is not known.
int64_t widest_gap(const std::vector<TrajectoryPoint>& points) {
  std::vector<int64_t> gaps;
  for (size_t i = 0; i + 1 < points.size(); ++i) gaps.push_back(points[i + 1].time_ns - points[i].time_ns);
  if (gaps.empty()) return 0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>((gaps.size() - 1) / 2);
  std::ranges::nth_element(gaps, middle);
  return usual_intervals * *middle;
}

/// Every n-th, with the last one and the newest at `now_ns`.
std::vector<TrajectoryPoint> thinned(const std::vector<TrajectoryPoint>& points, size_t stride,
                                     int64_t now_ns) {
  if (stride == 1) return points;
  const auto after =
      std::ranges::upper_bound(points, now_ns, {}, [](const TrajectoryPoint& p) { return p.time_ns; });
  const size_t now = after == points.begin() ? 0 : static_cast<size_t>(after - points.begin()) - 1;
  std::vector<TrajectoryPoint> kept;
  for (size_t i = 0; i < points.size(); ++i)
    if (i % stride == 0 || i == now || i + 1 == points.size()) kept.push_back(points[i]);
  return kept;
}

/// Lines and dots between two neighbouring points.
void add_piece(Shapes& shapes, const TrajectoryPoint& from, const TrajectoryPoint& to, size_t node,
               const std::string& name, io::Color color, int64_t now_ns, uint32_t row) {
  const dvec3 a = from.at(node), b = to.at(node);
  const bool future = from.time_ns >= now_ns;
  if (a != b) shapes.lines.push_back({a, b, future ? darker(color) : color, future ? 1.2f : 2.0f, row});
  // Whole seconds after `from`, up to `to`.
  for (int64_t second = from.time_ns / second_ns + 1; second * second_ns <= to.time_ns; ++second) {
    const double share = static_cast<double>(second * second_ns - from.time_ns) /
                         static_cast<double>(to.time_ns - from.time_ns);
    const dvec3 at = glm::mix(a, b, share);
    shapes.points.push_back(
        {at, future ? darker(color) : color, 3.0f, PointShape::Mark::dot,
         shapes.add_row(fmt::format("{} at {} s\n({:.2f}, {:.2f}, {:.2f}) m, {:.2f} m/s", name, second, at.x,
                                    at.y, at.z, glm::mix(from.speed(node), to.speed(node), share)),
                        row_id("second of " + name, static_cast<uint64_t>(second)))});
  }
}

}  // namespace

void PoseHistory::add(uint32_t sequence, std::shared_ptr<const Record> poses) {
  GREATX_CHECK(poses != nullptr, "no record for sequence {}", sequence);
  if (sequence != sequence_) {
    records_.clear();
    bytes_ = 0;
    sequence_ = sequence;
  }
  const int64_t tick = poses->tick;
  bytes_ += bytes_of(*poses);
  const auto place = std::ranges::lower_bound(records_, tick, {}, tick_of);
  if (place != records_.end() && (*place)->tick == tick) {
    bytes_ -= bytes_of(**place);
    *place = std::move(poses);
  } else {
    records_.insert(place, std::move(poses));
  }
  while (bytes_ > most_bytes_ && records_.size() > 1) {
    const bool first = tick - records_.front()->tick >= records_.back()->tick - tick;
    bytes_ -= bytes_of(first ? *records_.front() : *records_.back());
    if (first)
      records_.pop_front();
    else
      records_.pop_back();
  }
}

std::shared_ptr<const Record> PoseHistory::at(int64_t tick) const {
  const auto found = std::ranges::lower_bound(records_, tick, {}, tick_of);
  return found != records_.end() && (*found)->tick == tick ? *found : nullptr;
}

std::shared_ptr<const Record> PoseHistory::at_or_before(int64_t tick) const {
  const auto after = std::ranges::upper_bound(records_, tick, {}, tick_of);
  return after == records_.begin() ? nullptr : *std::prev(after);
}

std::vector<std::shared_ptr<const Record>> PoseHistory::between(int64_t first_ns, int64_t last_ns) const {
  const auto time_of = [](const std::shared_ptr<const Record>& record) { return record->time_ns; };
  std::vector<std::shared_ptr<const Record>> found;
  for (auto record = std::ranges::lower_bound(records_, first_ns, {}, time_of);
       record != records_.end() && (*record)->time_ns <= last_ns; ++record)
    found.push_back(*record);
  return found;
}

Shapes trajectory_shapes(const RecordTables& tables, const PoseHistory& history, int64_t now_ns,
                         const TrajectoryOptions& options) {
  GREATX_CHECK(options.most_lines > 0, "{} lines", options.most_lines);
  Shapes shapes;
  const SensorSpec* const spec = tables.pose_sensor();
  const std::vector<std::shared_ptr<const Record>> records =
      history.between(now_ns - nanoseconds_of(options.past_s), now_ns + nanoseconds_of(options.future_s));
  if (spec == nullptr || records.empty()) {
    shapes.note("trajectories: no poses are known about this time");
    return shapes;
  }
  const size_t nodes = tables.nodes().size();
  std::vector<TrajectoryPoint> all;
  for (const std::shared_ptr<const Record>& record : records) all.push_back(point_of(*spec, *record, nodes));
  const size_t stride = (all.size() + options.most_lines - 1) / options.most_lines;
  const std::vector<TrajectoryPoint> points = thinned(all, stride, now_ns);
  const int64_t gap_ns = widest_gap(points);
  const auto last_past =
      std::ranges::upper_bound(points, now_ns, {}, [](const TrajectoryPoint& p) { return p.time_ns; });
  const TrajectoryPoint& now = last_past == points.begin() ? points.front() : *std::prev(last_past);
  size_t gaps = 0, unnamed = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) gaps += points[i + 1].time_ns - points[i].time_ns > gap_ns;
  for (size_t node = 0; node < nodes; ++node) {
    const std::string name = printable(tables.nodes()[node]);
    const io::Color color = io::color_of_series(node);
    const bool rests = std::ranges::all_of(
        points, [&](const TrajectoryPoint& p) { return p.at(node) == points.front().at(node); });
    const uint32_t row =
        shapes.add_row(fmt::format("{}\n({:.2f}, {:.2f}, {:.2f}) m, {:.2f} m/s", name, now.at(node).x,
                                   now.at(node).y, now.at(node).z, now.speed(node)),
                       row_id("node", node));
    for (size_t i = 0; !rests && i + 1 < points.size(); ++i)
      if (points[i + 1].time_ns - points[i].time_ns <= gap_ns)
        add_piece(shapes, points[i], points[i + 1], node, name, color, now_ns, row);
    shapes.points.push_back({now.at(node), color, 4.0f, PointShape::Mark::circle, row});
    if (!options.labels) continue;
    if (node < options.most_labels)
      shapes.labels.push_back({now.at(node), name, color});
    else
      ++unnamed;
  }
  const auto seconds = [](int64_t time_ns) {
    return static_cast<double>(time_ns) / static_cast<double>(second_ns);
  };
  shapes.note(fmt::format("trajectories: {:.2f} to {:.2f} s{}", seconds(points.front().time_ns),
                          seconds(points.back().time_ns),
                          stride > 1 ? fmt::format(", one record in {}", stride) : ""));
  if (gaps > 0) shapes.note(fmt::format("trajectories: {} gaps where no poses are known", gaps));
  if (unnamed > 0) shapes.note(fmt::format("trajectories: {} more nodes without a name", unnamed));
  return shapes;
}

}  // namespace greatx::view
