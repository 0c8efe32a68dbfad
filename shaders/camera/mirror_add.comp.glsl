#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds mirror images to level films of water. The few rays of rough mirrors are smoothed over 3 x 3 pixels of
// the same kind of surface at nearly the same depth.
#include "camera/mirror_weight.glsl"
#include "camera/picture.glsl"
#include "shared/weather.h"

layout(local_size_x = shade_group_width, local_size_y = shade_group_height) in;
layout(set = 0, binding = mirror_seen_binding, scalar) readonly buffer SeenBlock { uvec2 picture_seen[]; };
layout(set = 0, binding = mirror_from_binding, scalar) readonly buffer FromBlock { uvec2 from_color[]; };
layout(set = 0, binding = mirror_to_binding, scalar) writeonly buffer ToBlock { uvec2 to_color[]; };
layout(set = 0, binding = mirror_words_binding, scalar) readonly buffer MirrorBlock { uvec3 mirrors[]; };
layout(set = 0, binding = mirror_images_binding, scalar) readonly buffer ImagesBlock { uvec2 images[]; };

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (outside_picture(at)) return;
  uint element = picture_element(at);
  vec4 color = unpack_color(from_color[element]);
  uvec3 words = mirrors[element];
  vec2 mine = unpackHalf2x16(words.x);
  if (mine.x > 0.0) {
    vec3 shows = vec3(unpackHalf2x16(words.y), unpackHalf2x16(words.z).x);
    float depth = uintBitsToFloat(picture_seen[element].x);
    int reach = mine.y < smooth_mirror ? 0 : 1;
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        uint near = picture_element(clamp(at + ivec2(i, j), ivec2(0), picture_size() - 1));
        vec2 its = unpackHalf2x16(mirrors[near].x);
        float apart = abs(uintBitsToFloat(picture_seen[near].x) - depth);
        bool same = its.x > 0.0 && abs(its.y - mine.y) < 0.1 && apart < 0.05 * depth;
        vec3 image = unpack_color(images[near]).rgb;
        float share = !same ? 0.0 : reach > 0 ? image_weight(image) : 1.0;
        sum += share * image;
        count += share;
      }
    color.rgb = clamp(color.rgb + mine.x * (sum / count - shows), vec3(0.0), vec3(65504.0));
  }
  to_color[element] = pack_color(color);
}
