#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes what a pane lets through: its colour, less what both of its faces reflect. The products of all
// panes before what is solid stand in the target, whatever their order.
#include "camera/visibility_view.glsl"
#include "shared/pane.h"

layout(location = 1) in vec3 in_place;
layout(location = 2) flat in vec3 in_color;
layout(location = 0) out vec4 out_passes;

void main() {
  vec3 normal = cross(dFdx(in_place), dFdy(in_place));
  float distance = length(in_place);
  float size = length(normal);
  // A pane seen edge-on has no normal; it lets nothing through.
  float cosine = size > 0.0 ? min(abs(dot(normal, in_place)) / (size * distance), 1.0) : 0.0;
  float through = 1.0 - pane_reflectance(cosine, pane_index, 1.0);
  out_passes = vec4(in_color * (through * pane_shows(distance * length(camera.ray_x))), 1.0);
}
