// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The base scenario of campaigns in tests: a drone between two walls, with a link to a mast and a small
// camera.
#pragma once

#include <string>

#include <fmt/format.h>

namespace greatx::apps::test {

/// `outputs` are those of the camera, as in "rgb, depth".
inline std::string campaign_base(int ticks, const std::string& outputs) {
  return fmt::format(R"(greatx: 1
name: base
seed: 4
ticks: {}
tick_rate_hz: 10
scene: {{generate: {{kind: canyon, seed: 3, size_m: 60}}}}
environment: {{clouds: 0}}
nodes:
  - name: bs
    trajectory: {{type: static, position_m: [1, -20, 6]}}
    sensors: [{{name: a, type: antenna}}]
  - name: uav
    trajectory: {{type: bezier, box: {{min_m: [-3, -15, 3], max_m: [3, 15, 8]}}, offset_m: [1, 1, 1]}}
    sensors:
      - {{name: a, type: antenna}}
      - {{name: cam, type: camera, rate_hz: 10, width: 48, height: 32, fov_deg: 90, outputs: [{}]}}
channels:
  - {{name: csi, tx: bs/a, rx: [uav/a], rate_hz: 10, bandwidth_hz: 20e6, subcarriers: 16, max_depth: 1}}
)",
                     ticks, outputs);
}

}  // namespace greatx::apps::test
