// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// nodes[].sensors[]: event cameras.
#include "sim/scenario/scenario_parse.h"

namespace greatx::sim {

EventCameraConfig parse_event_camera(const FieldMap& map) {
  EventCameraConfig camera;
  parse_pinhole(map, camera);
  if (const auto f = map.find("see_own_body")) camera.see_own_body = f->boolean();
  return camera;
}

}  // namespace greatx::sim
