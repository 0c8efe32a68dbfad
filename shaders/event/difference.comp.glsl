#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the difference image: 1 where the picture is brighter than the one before by the threshold or more,
// -1 where it is darker by as much, else 0. Each pixel is a byte, and an invocation writes four.
#extension GL_EXT_buffer_reference : require
#include "shared/events.h"
#include "lib/linear.glsl"

layout(local_size_x = event_group_size) in;
layout(set = 0, binding = event_luminance_binding, scalar) readonly buffer LuminanceBlock {
  float luminances[];
};
layout(set = 0, binding = event_previous_binding, scalar) buffer PreviousBlock { float previous[]; };
layout(push_constant, scalar) uniform Constants { DifferenceConstants difference; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Words { uint v[]; };

void main() {
  uint group = linear_invocation, count = difference.width * difference.height;
  if (4u * group >= count) return;
  uint word = 0u;
  for (uint i = 0u; i < 4u; ++i) {
    uint pixel = 4u * group + i;
    if (pixel >= count) break;
    float now = luminances[pixel];
    if (difference.first == 0u) {
      float change = now - previous[pixel];
      uint value = change >= difference.on ? 1u : -change >= difference.off ? 0xffu : 0u;
      word |= value << (8u * i);
    }
    previous[pixel] = now;
  }
  Words(difference.picture).v[group] = word;
}
