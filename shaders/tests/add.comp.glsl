// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes, for tests/gpu, out[i] = in[i] + specialization constant + push constant.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/glsl.h"
#include "lib/linear.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint addend = 0;
layout(set = 0, binding = 0, scalar) readonly buffer In { uint values_in[]; };
layout(set = 0, binding = 1, scalar) writeonly buffer Out { uint values_out[]; };
layout(push_constant, scalar) uniform Push { uint count; uint more; };
void main() {
  uint i = linear_invocation;
  if (i < count) values_out[i] = values_in[i] + addend + more;
}
