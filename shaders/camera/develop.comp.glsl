#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_control_flow_attributes : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Develops the picture and unpacks depth and ids into tightly packed arrays, so that the host only copies.
// The picture is padded to whole invocations, as the arrays are. An invocation handles eight pixels, in words
// of 64 bits: on a CPU driver each lane's access to memory costs the same, whatever its width.
#include "camera/stored_color.glsl"
#include "lib/linear.glsl"
#include "shared/develop.h"
#include "shared/film.h"

layout(local_size_x = develop_group_size) in;
layout(constant_id = develop_spec_rgb) const bool want_rgb = true;
layout(constant_id = develop_spec_hdr) const bool want_hdr = true;
layout(constant_id = develop_spec_depth) const bool want_depth = true;
layout(constant_id = develop_spec_instance) const bool want_instance = true;
layout(constant_id = develop_spec_semantic) const bool want_semantic = true;
layout(constant_id = develop_spec_material) const bool want_material = true;
layout(constant_id = develop_spec_metered) const bool metered = true;
layout(constant_id = develop_spec_flat_field) const bool flat_field_on = true;
layout(constant_id = develop_spec_noise) const bool noise_on = true;

// Each element holds two pixels.
layout(set = 0, binding = develop_color_binding, scalar) readonly buffer ColorBlock {
  uvec4 picture_color[];
};
layout(set = 0, binding = develop_seen_binding, scalar) readonly buffer SeenBlock { uvec4 picture_seen[]; };
layout(set = 0, binding = develop_triangle_ids_binding, scalar) readonly buffer TriangleIdsBlock {
  uint64_t triangle_ids[];
};
layout(push_constant, scalar) uniform Constants { DevelopConstants picture; };
#include "camera/chromatic.glsl"
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer Words { uint64_t v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Pairs { uint64_t v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Exposure { MeterResult v; };

const uint pairs = develop_pixels / 2u;

uint64_t pair(uint low, uint high) { return packUint2x32(uvec2(low, high)); }
uint four_bytes(uint a, uint b, uint c, uint d) { return a | b << 8 | c << 16 | d << 24; }

void main() {
  uint group = linear_invocation;
  uint first = group * develop_pixels;
  if (first >= picture.width * picture.height) return;

  const bool want_ids = want_instance || want_semantic || want_material;
  uint bytes[3u * develop_pixels];
  uint radiance[3u * develop_pixels];
  uint depths[develop_pixels];
  uint instances[develop_pixels];
  uint codes[develop_pixels];
  float gain = 1.0;
  if (want_rgb && metered) gain = Exposure(picture.exposure).v.gain;
  vec2 field[pairs];
  if (want_rgb && flat_field_on) {
    [[unroll]] for (uint w = 0u; w < pairs; ++w)
      field[w] = uintBitsToFloat(unpackUint2x32(Pairs(picture.flat_field).v[pairs * group + w]));
  }

  uvec4 color_words, seen_words;
  [[unroll]] for (uint i = 0u; i < develop_pixels; ++i) {
    if (want_rgb || want_hdr) {
      if ((i & 1u) == 0u) color_words = picture_color[pairs * group + i / 2u];
      vec3 color = unpack_color((i & 1u) == 0u ? color_words.xy : color_words.zw).rgb;
      if (chromatic_on && first + i < picture.width * picture.height) color = through_prism(color, first + i);
      if (want_hdr) {
        [[unroll]] for (uint c = 0u; c < 3u; ++c)
          radiance[3u * i + c] = floatBitsToUint(color[c] * picture.radiance_scale);
      }
      if (want_rgb) {
        if (metered) color *= gain;
        if (flat_field_on) color *= field[i >> 1][i & 1u];
        if (noise_on) color = sensed_color(color, picture.sensor, first + i);
        vec3 mapped = tone_map(color);
        [[unroll]] for (uint c = 0u; c < 3u; ++c) bytes[3u * i + c] = srgb_byte(mapped[c]);
      }
    }
    if (want_depth || want_ids) {
      if ((i & 1u) == 0u) seen_words = picture_seen[pairs * group + i / 2u];
      uvec2 seen = (i & 1u) == 0u ? seen_words.xy : seen_words.zw;
      depths[i] = seen.x;
      if (want_ids) {
        uvec2 ids = unpackUint2x32(triangle_ids[seen.y]);
        instances[i] = ids.x;
        codes[i] = ids.y;
      }
    }
  }

  if (want_rgb) {
    [[unroll]] for (uint w = 0u; w < 3u; ++w) {
      uint k = 8u * w;
      Words(picture.rgb).v[3u * group + w] =
          pair(four_bytes(bytes[k], bytes[k + 1u], bytes[k + 2u], bytes[k + 3u]),
               four_bytes(bytes[k + 4u], bytes[k + 5u], bytes[k + 6u], bytes[k + 7u]));
    }
  }
  if (want_hdr) {
    [[unroll]] for (uint w = 0u; w < 3u * pairs; ++w)
      Words(picture.hdr).v[3u * pairs * group + w] = pair(radiance[2u * w], radiance[2u * w + 1u]);
  }
  if (want_depth) {
    [[unroll]] for (uint w = 0u; w < pairs; ++w)
      Words(picture.depth).v[pairs * group + w] = pair(depths[2u * w], depths[2u * w + 1u]);
  }
  if (want_instance) {
    [[unroll]] for (uint w = 0u; w < pairs; ++w)
      Words(picture.instance).v[pairs * group + w] = pair(instances[2u * w], instances[2u * w + 1u]);
  }
  if (want_semantic) {
    uint c[develop_pixels];
    [[unroll]] for (uint i = 0u; i < develop_pixels; ++i) c[i] = codes[i] & 255u;
    Words(picture.semantic).v[group] = pair(four_bytes(c[0], c[1], c[2], c[3]),
                                            four_bytes(c[4], c[5], c[6], c[7]));
  }
  if (want_material) {
    uint c[pairs];
    [[unroll]] for (uint w = 0u; w < pairs; ++w)
      c[w] = codes[2u * w] >> 16 | (codes[2u * w + 1u] & 0xffff0000u);
    Words(picture.material).v[2u * group] = pair(c[0], c[1]);
    Words(picture.material).v[2u * group + 1u] = pair(c[2], c[3]);
  }
}
