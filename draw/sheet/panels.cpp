// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/panels.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/ranges.h>

#include "draw/sheet/channel_links.h"

namespace greatx::io {

namespace {

/// Describes how a kind of sensor is added to the sheet.
struct Maker {
  std::string_view kind;  ///< SensorSpec::kind
  /// A picture per moment, drawn for every sensor of the kind; null: over time, for the first one only.
  std::vector<FrameKind> (*frames)();
  void (*add)(const PanelSource&, Panels&);  ///< the plots over time
  bool intervals = false;                    ///< see is_about_intervals()
};
constexpr Maker makers[] = {
    {"camera", camera_frames, nullptr},
    {"event_camera", event_frames, nullptr, true},
    {"lidar", lidar_frames, nullptr},
    {"radar", radar_frames, nullptr},
    {"csi", sensing_frames, add_csi_panels},
    {"pose", nullptr, add_pose_panels},
    {"imu", nullptr, add_imu_panels},
    {"gnss", nullptr, add_gnss_panels},
    {"barometer", nullptr, add_barometer_panels},
    {"magnetometer", nullptr, add_magnetometer_panels},
};

/// Returns the entry of a kind, or null if the kind is unknown.
const Maker* maker_of(std::string_view kind) {
  const auto* const found = std::ranges::find(makers, kind, &Maker::kind);
  return found == std::end(makers) ? nullptr : found;
}

constexpr double farthest_m = 1e12;
constexpr size_t most_nodes = 1'000'000;
constexpr std::string_view ids_group = "ids";  ///< of FrameKind: pictures of ids

}  // namespace

bool PanelSource::has(std::string_view array) const {
  return std::any_of(spec().arrays.begin(), spec().arrays.end(),
                     [&](const ArraySpec& candidate) { return candidate.name == array; });
}

Array PanelSource::load(const IndexRow& row, const std::string& array, const std::vector<DType>& types,
                        const std::vector<int64_t>& shape) const {
  const auto& arrays = spec().arrays;
  const auto declared =
      std::find_if(arrays.begin(), arrays.end(), [&](const ArraySpec& a) { return a.name == array; });
  bool fits = declared != arrays.end() &&
              std::find(types.begin(), types.end(), declared->dtype) != types.end() &&
              declared->shape.size() == shape.size();
  for (size_t axis = 0; fits && axis < shape.size(); ++axis)
    fits = shape[axis] < 0 ||
           (shape[axis] == 0 ? declared->shape[axis] > 0 : declared->shape[axis] == shape[axis]);
  if (!fits) {
    std::vector<std::string> names, axes;
    for (const DType type : types) names.emplace_back(numpy_name(type));
    for (const int64_t extent : shape) axes.push_back(extent > 0 ? std::to_string(extent) : "n");
    throw_user_error("{}: expected an array {} of {} [{}], found {}", place(), array,
                     fmt::join(names, " or "), fmt::join(axes, ", "),
                     declared == arrays.end() ? "none"
                                              : fmt::format("{} [{}]", numpy_name(declared->dtype),
                                                            fmt::join(declared->shape, ", ")));
  }
  Array loaded = records.load(sequence, row, array);
  if (const std::string bad = find_bad_value(spec(), *declared, loaded); !bad.empty())
    throw_user_error("{}, tick {}: expected finite values, found {}", place(), row.tick, bad);
  return loaded;
}

std::string PanelSource::place() const {
  return (std::filesystem::path(records.place()) / sequence_folder(sequence) / spec().name).string();
}

JsonDocument metadata_of(const PanelSource& source) {
  const SensorSpec& sensor = source.spec();
  return JsonDocument(
      sensor.metadata_json.empty() ? "{}" : sensor.metadata_json,
      {fmt::format("{}: {}: metadata",
                   (std::filesystem::path(source.records.place()) / dataset_file).string(), sensor.name),
       0});
}

double number_of(const JsonDocument& metadata, const char* key, double otherwise, double least, double most) {
  return metadata.root().has(key) ? metadata.root().at(key).number(least, most) : otherwise;
}

void expect_same_rows(const PanelSource& source, std::initializer_list<const Array*> arrays) {
  for (const Array* array : arrays)
    if (array->shape[0] != (*arrays.begin())->shape[0])
      throw_user_error("{}: expected arrays of as many rows, found {} and {}", source.place(),
                       (*arrays.begin())->shape[0], array->shape[0]);
}

std::span<const FrameKind> frame_kinds(std::string_view sensor_kind) {
  static const std::vector<std::vector<FrameKind>> all = [] {
    std::vector<std::vector<FrameKind>> kinds;
    for (const Maker& maker : makers)
      kinds.push_back(maker.frames ? maker.frames() : std::vector<FrameKind>());
    return kinds;
  }();
  const Maker* const maker = maker_of(sensor_kind);
  if (maker == nullptr) return {};
  return all[static_cast<size_t>(maker - makers)];
}

bool has_arrays(const SensorSpec& sensor, std::span<const char* const> arrays) {
  return std::ranges::all_of(arrays, [&](const char* name) {
    return std::ranges::find(sensor.arrays, name, &ArraySpec::name) != sensor.arrays.end();
  });
}

std::optional<RasterCell> cell_at(const Rect& picture, int64_t columns, int64_t rows, int x, int y) {
  if (x < picture.x || y < picture.y || x >= picture.right() || y >= picture.bottom()) return std::nullopt;
  return RasterCell{static_cast<int>((x - picture.x) * columns / picture.width),
                    static_cast<int>((y - picture.y) * rows / picture.height)};
}

namespace {

/// Adds the first picture of each group that the sensor has.
void add_frames(const PanelSource& source, Panels& panels, const PanelOptions& options) {
  std::set<std::string_view> groups;
  const std::span<const FrameKind> kinds = frame_kinds(source.spec().kind);
  const auto usable = [&](const FrameKind& kind) {
    return kind.group != nullptr && has_arrays(source.spec(), kind.arrays);
  };
  const bool wished =
      std::ranges::any_of(kinds, [&](const FrameKind& k) { return usable(k) && options.ids == k.name; });
  for (const FrameKind& kind : kinds) {
    if (!usable(kind) || groups.contains(kind.group)) continue;
    if (wished && kind.group == ids_group && options.ids != kind.name) continue;
    std::unique_ptr<FramePanel> panel = kind.make(source);
    if (panel == nullptr) continue;
    panels.frames.push_back(std::move(panel));
    groups.insert(kind.group);
  }
}

}  // namespace

void add_panels(const PanelSource& source, Panels& panels, const PanelOptions& options) {
  const Maker* const maker = maker_of(source.spec().kind);
  if (maker == nullptr) return;
  std::vector<PanelSource> links{source};
  if (source.spec().kind == "csi") {
    links.clear();
    for (const ChannelLink& link : links_to_show(source, options.links)) {
      links.push_back(source);
      links.back().link = link;
    }
  }
  for (const PanelSource& link : links) {
    if (maker->add) maker->add(link, panels);
    add_frames(link, panels, options);
  }
}

size_t count_frame_panels(const SensorSpec& sensor) {
  std::set<std::string_view> groups;
  for (const FrameKind& kind : frame_kinds(sensor.kind))
    if (kind.group != nullptr && has_arrays(sensor, kind.arrays)) groups.insert(kind.group);
  return groups.size();
}

bool has_panels(std::string_view kind) { return maker_of(kind) != nullptr; }

bool has_frame_panels(const SensorSpec& sensor) {
  return std::ranges::any_of(frame_kinds(sensor.kind), [&](const FrameKind& kind) {
    return kind.group != nullptr && has_arrays(sensor, kind.arrays);
  });
}

bool is_about_intervals(std::string_view kind) {
  const Maker* const maker = maker_of(kind);
  return maker != nullptr && maker->intervals;
}

std::vector<std::string> node_names(const PanelSource& pose) {
  const JsonDocument metadata = metadata_of(pose);
  std::vector<std::string> names;
  if (!metadata.root().has("nodes")) return names;
  for (const JsonValue& name : metadata.root().at("nodes").list(most_nodes)) names.push_back(name.text());
  return names;
}

Pose pose_of(const JsonValue& json) {
  Pose pose;
  if (json.has("position_m")) {
    const std::vector<JsonValue> p = json.at("position_m").tuple(3);
    for (int i = 0; i < 3; ++i) pose.position[i] = p[static_cast<size_t>(i)].number(-farthest_m, farthest_m);
  }
  if (json.has("orientation_wxyz")) {
    const std::vector<JsonValue> q = json.at("orientation_wxyz").tuple(4);
    const auto part = [&](size_t i) { return q[i].number(-1.01, 1.01); };
    pose.orientation = dquat(part(0), part(1), part(2), part(3));
  }
  return pose;
}

Pose mount_of(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  return metadata.root().has("body_from_sensor") ? pose_of(metadata.root().at("body_from_sensor")) : Pose();
}

std::string node_of(const SensorSpec& sensor) { return sensor.name.substr(0, sensor.name.find('/')); }

std::optional<Pose> world_from_sensor(const PanelSource& source, const IndexRow& row) {
  const std::optional<Pose> node = world_from_node(source, row, node_of(source.spec()));
  if (!node) return std::nullopt;
  return *node * mount_of(source);
}

std::optional<Pose> world_from_node(const PanelSource& source, const IndexRow& row, const std::string& node) {
  const std::vector<SensorSpec>& sensors = source.records.sensors();
  const auto has = [](const SensorSpec& sensor, const char* name) {
    return std::any_of(sensor.arrays.begin(), sensor.arrays.end(),
                       [&](const ArraySpec& array) { return array.name == name; });
  };
  const auto pose = std::find_if(sensors.begin(), sensors.end(), [&](const SensorSpec& s) {
    return s.kind == "pose" && has(s, "position") && has(s, "orientation");
  });
  if (pose == sensors.end()) return std::nullopt;
  const PanelSource poses{source.records, source.sequence, static_cast<size_t>(pose - sensors.begin()), {}};
  const std::vector<std::string> names = node_names(poses);
  const auto found = std::find(names.begin(), names.end(), node);
  if (found == names.end()) return std::nullopt;
  const std::vector<IndexRow> rows =
      source.records.records_of(source.sequence, static_cast<size_t>(pose - sensors.begin()));
  const auto at =
      std::find_if(rows.begin(), rows.end(), [&](const IndexRow& r) { return r.tick == row.tick; });
  if (at == rows.end()) return std::nullopt;
  const auto number = static_cast<size_t>(found - names.begin());
  const Array positions = poses.load(*at, "position", {DType::f64}, {0, 3});
  const Array orientations = poses.load(*at, "orientation", {DType::f64}, {0, 4});
  expect_same_rows(poses, {&positions, &orientations});
  if (number >= static_cast<size_t>(positions.shape[0]))
    throw_user_error("{}: expected poses of {} nodes, found {}", poses.place(), names.size(),
                     positions.shape[0]);
  const std::span<const double> p = positions.as<double>().subspan(3 * number, 3);
  const std::span<const double> q = orientations.as<double>().subspan(4 * number, 4);
  return Pose{{p[0], p[1], p[2]}, dquat(q[0], q[1], q[2], q[3])};
}

}  // namespace greatx::io
