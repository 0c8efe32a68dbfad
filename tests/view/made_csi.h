// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Records of a channel that tests of overlays make by hand.
#pragma once

#include <cmath>

#include "core/units.h"
#include "tests/view/overlay_support.h"
#include "view/overlay/path_shapes.h"

namespace greatx::view::testing {

inline constexpr double overlay_carrier_hz = 3.5e9;

struct MadePath {
  int32_t rx = 0, tx = 0;
  uint64_t id = 1;
  double gain_db = -80.0;
  std::vector<uint8_t> interactions;
};

/// A channel of two transmitters and two receivers. The i-th interaction of path n is at (n, i, 5).
inline Made made_csi(const std::vector<MadePath>& paths, int64_t depth = 3) {
  Made made;
  made.spec.name = "csi";
  made.spec.kind = "csi";
  const auto end = [](const char* name, double x) {
    return nlohmann::json{
        {"name", name}, {"pattern", "isotropic"}, {"body_from_antenna", json_of(Pose{{x, 0.0, 1.0}})}};
  };
  made.spec.metadata_json = nlohmann::json{{"carrier_hz", overlay_carrier_hz},
                                           {"transmitters", {end("mast/left", -1.0), end("mast/right", 1.0)}},
                                           {"receivers", {end("uav/antenna", 0.5), end("point 0", 77.0)}}}
                                .dump();
  const auto n = static_cast<int64_t>(paths.size());
  std::vector<int32_t> rx, tx;
  std::vector<uint64_t> id;
  std::vector<double> delay, doppler, departure, arrival, vertex;
  std::vector<std::complex<float>> transfer;
  std::vector<uint8_t> interaction;
  std::vector<uint32_t> object, material;
  for (size_t i = 0; i < paths.size(); ++i) {
    const MadePath& path = paths[i];
    rx.push_back(path.rx);
    tx.push_back(path.tx);
    id.push_back(path.id);
    delay.push_back(1e-7 * static_cast<double>(i + 1));
    doppler.push_back(25.5);
    departure.insert(departure.end(), {0.5 * pi, 0.25 * pi});
    arrival.insert(arrival.end(), {pi / 3.0, -0.5 * pi});
    // Both diagonal terms, so that the gain is (lambda/4 pi)^2 |t|^2.
    const double t = std::sqrt(from_decibels(path.gain_db)) * 4.0 * pi * overlay_carrier_hz / speed_of_light;
    for (const double value : {t, 0.0, 0.0, t}) transfer.emplace_back(static_cast<float>(value), 0.0f);
    for (int64_t k = 0; k < depth; ++k) {
      const bool there = k < std::ssize(path.interactions);
      interaction.push_back(there ? path.interactions[static_cast<size_t>(k)] : 0);
      object.push_back(there ? static_cast<uint32_t>(k + 1) : 0);
      material.push_back(there ? 1 : 0);
      const double none = std::numeric_limits<double>::quiet_NaN();
      for (const double value : {static_cast<double>(i), static_cast<double>(k), 5.0})
        vertex.push_back(there ? value : none);
    }
  }
  made.add<int32_t>("rx", {n}, rx).add<int32_t>("tx", {n}, tx).add<uint64_t>("id", {n}, id);
  made.add<double>("delay", {n}, delay).add<double>("doppler", {n}, doppler);
  made.add<double>("departure", {n, 2}, departure).add<double>("arrival", {n, 2}, arrival);
  made.add<std::complex<float>>("transfer", {n, 2, 2}, transfer);
  made.add<uint8_t>("interaction", {n, depth}, interaction).add<double>("vertex", {n, depth, 3}, vertex);
  made.add<uint32_t>("object", {n, depth}, object).add<uint32_t>("object_material", {n, depth}, material);
  return made;
}

struct Shown {
  Made csi, poses;
  RecordTables tables;
  NodePoses at;

  explicit Shown(const std::vector<MadePath>& paths)
      : csi(made_csi(paths)),
        poses(made_poses({{"mast", {{0, 0, 10}, dquat(1, 0, 0, 0)}},
                          {"uav", {{40, 0, 20}, orientation_from_yaw_pitch_roll(0.5 * pi, 0, 0)}}})),
        tables(R"({"instances": [{"name": "ground"}, {"name": "tower"}], "materials": ["itu_glass"]})",
               std::vector{csi.spec, poses.spec}, "test"),
        at(tables, poses.record) {}
  Shapes shapes(const PathOptions& options = {}) const {
    return path_shapes(tables, csi.spec, csi.record, &at, options);
  }
};

}  // namespace greatx::view::testing
