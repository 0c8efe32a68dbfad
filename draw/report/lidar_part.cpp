// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of LiDARs: points in the frame of the sensor, rounded to a step.
#include <algorithm>
#include <cmath>

#include "draw/report/parts.h"

namespace greatx::io::report {

namespace {
/// Coordinates are multiples of this, or of a longer step if 16 bits would not do.
constexpr double shortest_step_m = 0.001, intensity_ratio = 1.01;
}  // namespace

Json describe_lidar(const PanelSource&) { return Json::object(); }

Json encode_lidar(const Context& context, const PanelSource& source, const IndexRow& row) {
  Json json = {{"pose", pose_json(context, context.poses.world_from(node_of(source.spec()), mount_of(source),
                                                                    row.tick))}};
  if (!source.has("points")) return json;
  const Array points = source.load(row, "points", {DType::f32}, {-1, 4});
  const std::span<const float> p = points.as<float>();
  const size_t all = p.size() / 4, by = std::max<size_t>(1, (all + context.detail.cloud_points - 1) /
                                                                context.detail.cloud_points);
  double farthest = 0.0;
  for (size_t i = 0; i < all; ++i)
    for (size_t c = 0; c < 3; ++c)
      if (std::isfinite(p[4 * i + c])) farthest = std::max(farthest, std::abs(double{p[4 * i + c]}));
  const double step = std::max(shortest_step_m, farthest / 32767.0);
  std::vector<uint32_t> codes, ids;
  std::vector<float> intensities;
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < all; i += by)
      codes.push_back(static_cast<uint32_t>(nearest(p[4 * i + c] / step)) & 0xffffu);
  for (size_t i = 0; i < all; i += by) intensities.push_back(p[4 * i + 3]);
  const size_t kept = intensities.size();
  const LogCode code = LogCode::of(intensities, intensity_ratio);
  std::vector<uint32_t> levels;
  for (const float intensity : intensities) levels.push_back(code.code(intensity));
  if (by > 1)
    context.collected.notes.insert(fmt::format("Clouds of {} show every {} point of their records.",
                                               printable(source.spec().name),
                                               by == 2   ? "second"
                                               : by == 3 ? "third"
                                                         : fmt::format("{}th", by)));
  json["points"] = {
      {"blob", context.blobs.add(packed(codes, 2, kept))}, {"count", kept}, {"all", all}, {"step", step}};
  json["intensity"] = {
      {"blob", context.blobs.add(packed(levels, 2, 0))}, {"low", code.low}, {"ratio", code.ratio}};
  if (source.has("instance")) {
    const Array instance = source.load(row, "instance", {DType::u32}, {-1});
    expect_same_rows(source, {&points, &instance});
    for (size_t i = 0; i < all; i += by) ids.push_back(instance.as<uint32_t>()[i]);
    for (const uint32_t id : ids) context.collected.instances.insert(id);
    json["instance"] = {{"blob", context.blobs.add(packed(ids, 4, 0))}};
  }
  return json;
}

}  // namespace greatx::io::report
