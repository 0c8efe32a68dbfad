// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Magnifies the red and the blue picture about the principal point (docs/film.md). The including shader has
// picture_color and the block `picture` of DevelopConstants.
#ifndef GREATX_CAMERA_CHROMATIC_GLSL
#define GREATX_CAMERA_CHROMATIC_GLSL

layout(constant_id = develop_spec_chromatic) const bool chromatic_on = false;
layout(constant_id = develop_spec_chromatic_x) const float principal_x = 0.0;
layout(constant_id = develop_spec_chromatic_y) const float principal_y = 0.0;
layout(constant_id = develop_spec_chromatic_red) const float red_shrinks = 1.0;
layout(constant_id = develop_spec_chromatic_blue) const float blue_shrinks = 1.0;

vec3 color_of_pixel(uint column, uint row) {
  uint pixel = row * picture.width + column;
  uvec4 two = picture_color[pixel / 2u];
  return unpack_color((pixel & 1u) == 0u ? two.xy : two.zw).rgb;
}

/// Returns the colour at a place between pixels, interpolated. Beyond the rim it is that of the rim.
vec3 color_at(vec2 place) {
  vec2 at = clamp(place - 0.5, vec2(0.0), vec2(picture.width - 1u, picture.height - 1u));
  uvec2 first = uvec2(at), second = min(first + 1u, uvec2(picture.width - 1u, picture.height - 1u));
  vec2 share = at - vec2(first);
  vec3 upper = mix(color_of_pixel(first.x, first.y), color_of_pixel(second.x, first.y), share.x);
  vec3 lower = mix(color_of_pixel(first.x, second.y), color_of_pixel(second.x, second.y), share.x);
  return mix(upper, lower, share.y);
}

/// Returns a pixel's colour with the red and the blue of the places that the lens magnifies to it.
vec3 through_prism(vec3 color, uint pixel) {
  vec2 principal = vec2(principal_x, principal_y);
  vec2 from_axis = vec2(pixel % picture.width, pixel / picture.width) + 0.5 - principal;
  return vec3(color_at(principal + from_axis * red_shrinks).r, color.g,
              color_at(principal + from_axis * blue_shrinks).b);
}
#endif
