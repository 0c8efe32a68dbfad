// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/path_records.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace greatx::view {

namespace {

/// (zenith, azimuth) as a direction.
dvec3 direction_of(std::span<const double> angles) {
  return {std::sin(angles[0]) * std::cos(angles[1]), std::sin(angles[0]) * std::sin(angles[1]),
          std::cos(angles[0])};
}

}  // namespace

PathArrays path_arrays(const RecordArrays& record, const SensorSpec& spec) {
  PathArrays paths;
  const int64_t n = paths.count = record.rows("id");
  const auto declared = std::ranges::find(spec.arrays, "interaction", &ArraySpec::name);
  if (declared == spec.arrays.end() || declared->shape.size() != 2 || declared->shape[1] < 1)
    record.fail("interaction", "|u1 [n, depth]", declared == spec.arrays.end() ? "none" : "another shape");
  const int64_t depth = paths.depth = declared->shape[1];
  paths.id = record.get<uint64_t>("id", {n});
  paths.rx = record.get<int32_t>("rx", {n});
  paths.tx = record.get<int32_t>("tx", {n});
  paths.delay = record.finite<double>("delay", {n});
  paths.doppler = record.finite<double>("doppler", {n});
  paths.departure = record.finite<double>("departure", {n, 2});
  paths.arrival = record.finite<double>("arrival", {n, 2});
  paths.transfer = record.get<std::complex<float>>("transfer", {n, 2, 2});
  paths.interaction = record.get<uint8_t>("interaction", {n, depth});
  paths.vertex = record.get<double>("vertex", {n, depth, 3});
  paths.object = record.get<uint32_t>("object", {n, depth});
  paths.material = record.get<uint32_t>("object_material", {n, depth});
  return paths;
}

rf::Path path_of(const RecordArrays& record, const PathArrays& arrays, size_t i) {
  rf::Path path;
  path.delay_s = arrays.delay[i];
  path.length_m = path.delay_s * speed_of_light;
  path.doppler_hz = arrays.doppler[i];
  path.departure = direction_of(arrays.departure.subspan(2 * i, 2));
  path.arrival = direction_of(arrays.arrival.subspan(2 * i, 2));
  for (size_t k = 0; k < 4; ++k) {
    const std::complex<float> t = arrays.transfer[4 * i + k];
    if (!std::isfinite(t.real()) || !std::isfinite(t.imag()))
      record.fail("transfer", "finite values", fmt::format("({}, {}) in row {}", t.real(), t.imag(), i));
    path.transfer[k] = rf::Complex(t);
  }
  const auto depth = static_cast<size_t>(arrays.depth);
  for (size_t k = 0; k < depth; ++k) {
    const uint8_t type = arrays.interaction[i * depth + k];
    if (type == 0) break;
    if (type >= apps::path_kinds.size())
      record.fail("interaction", "0 to 4", fmt::format("{} in row {}", type, i));
    const double* const v = arrays.vertex.data() + 3 * (i * depth + k);
    const dvec3 vertex(v[0], v[1], v[2]);
    if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y) || !std::isfinite(vertex.z))
      record.fail("vertex", "a place of every interaction",
                  fmt::format("({}, {}, {}) in row {}", vertex.x, vertex.y, vertex.z, i));
    path.interactions.push_back({static_cast<rf::InteractionType>(type)});
    path.vertices.push_back(vertex);
  }
  return path;
}

std::vector<std::optional<dvec3>> positions_of(const std::vector<AntennaFacts>& ends,
                                               const NodePoses& poses) {
  std::vector<std::optional<dvec3>> positions;
  for (const AntennaFacts& end : ends) {
    const std::optional<Pose> pose = poses.world_from(end.place);
    positions.push_back(pose ? std::optional(pose->position) : std::nullopt);
  }
  return positions;
}

uint64_t path_row_id(uint64_t id, uint64_t link) {
  return link == 0 ? id : id ^ (link * 0x9e3779b97f4a7c15u);  // 2^64 over the golden ratio: odd
}

}  // namespace greatx::view
