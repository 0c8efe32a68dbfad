#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Develops the picture and unpacks depth and ids into tightly packed arrays, four pixels an invocation, so that the
// host only copies.
#include "lib/scene.glsl"
#include "shared/camera.h"
#include "shared/develop.h"

layout(local_size_x = develop_group_size) in;
layout(constant_id = develop_spec_rgb) const bool want_rgb = true;
layout(constant_id = develop_spec_hdr) const bool want_hdr = true;
layout(constant_id = develop_spec_depth) const bool want_depth = true;
layout(constant_id = develop_spec_instance) const bool want_instance = true;
layout(constant_id = develop_spec_semantic) const bool want_semantic = true;
layout(constant_id = develop_spec_material) const bool want_material = true;

layout(set = 0, binding = develop_color_binding, rgba16f) uniform readonly image2D color_image;
layout(set = 0, binding = develop_seen_binding, rg32ui) uniform readonly uimage2D seen_image;
layout(set = 0, binding = develop_triangle_primitives_binding, scalar) readonly buffer TrianglePrimitivesBlock {
  uint triangle_primitives[];
};
layout(push_constant, scalar) uniform Constants { DevelopConstants picture; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Words { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Floats { float v[]; };

void main() {
  uint group = gl_GlobalInvocationID.x;
  uint first = group * develop_pixels;
  uint count = picture.width * picture.height;
  if (first >= count) return;

  uint bytes[3 * develop_pixels];
  uint semantic_word = 0u;
  uvec2 material_words = uvec2(0u);
  for (uint i = 0u; i < develop_pixels; ++i) {
    uint pixel = min(first + i, count - 1u);  // the arrays are padded to whole invocations
    ivec2 at = ivec2(pixel % picture.width, pixel / picture.width);
    if (want_rgb || want_hdr) {
      vec3 color = imageLoad(color_image, at).rgb;
      if (want_hdr) {
        for (uint c = 0u; c < 3u; ++c)
          Floats(picture.hdr).v[3u * (first + i) + c] = color[c] * picture.radiance_scale;
      }
      if (want_rgb) {
        vec3 mapped = tone_map(color);
        for (uint c = 0u; c < 3u; ++c) bytes[3u * i + c] = srgb_byte(mapped[c]);
      }
    }
    if (want_depth || want_instance || want_semantic || want_material) {
      uvec2 seen = imageLoad(seen_image, at).rg;
      if (want_depth) Words(picture.depth).v[first + i] = seen.x;
      if (want_instance || want_semantic || want_material) {
        uvec3 found = uvec3(0u);
        if (seen.y != 0u) {
          GpuPrimitive primitive = scene_primitive(triangle_primitives[seen.y - 1u]);
          found = uvec3(primitive.instance + 1u, primitive.semantic_class, primitive.material + 1u);
        }
        if (want_instance) Words(picture.instance).v[first + i] = found.x;
        semantic_word |= found.y << (8u * i);
        material_words[i >> 1] |= found.z << (16u * (i & 1u));
      }
    }
  }
  if (want_rgb) {
    for (uint w = 0u; w < 3u; ++w)
      Words(picture.rgb).v[3u * group + w] =
          bytes[4u * w] | bytes[4u * w + 1u] << 8 | bytes[4u * w + 2u] << 16 | bytes[4u * w + 3u] << 24;
  }
  if (want_semantic) Words(picture.semantic).v[group] = semantic_word;
  if (want_material) {
    Words(picture.material).v[2u * group] = material_words.x;
    Words(picture.material).v[2u * group + 1u] = material_words.y;
  }
}
