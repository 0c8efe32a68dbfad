// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Shades the triangles that the visibility pass found. Each triangle that a pixel's samples saw is shaded
// once and weighed by the number of these samples. Depth and id are those of the triangle that the pixel's
// centre looks at. With GREATX_MULTISAMPLED a pixel has four samples. With GREATX_PANES the triangles are the
// nearest panes before what is solid, which is shaded after them. With GREATX_LINES the triangles are those
// of thin lines, which are blended into the finished picture.
#include "camera/contact.glsl"
#include "camera/halos.glsl"
#include "camera/haze.glsl"
#include "camera/lamps.glsl"
#include "camera/lens_ray.glsl"
#include "camera/light.glsl"
#include "camera/pane_layer.glsl"
#include "camera/picture.glsl"
#include "camera/sky.glsl"
#include "camera/surface.glsl"
#include "camera/weather.glsl"

#ifdef GREATX_LINES
#include "shared/lines.h"
layout(local_size_x = line_group_pixels) in;
#else
layout(local_size_x = shade_group_width, local_size_y = shade_group_height) in;
#endif
#ifdef GREATX_MULTISAMPLED
layout(set = 0, binding = visibility_binding) uniform usampler2DMS visibility;
const uint sample_count = 4u;
#else
layout(set = 0, binding = visibility_binding, r32ui) uniform readonly uimage2D visibility;
const uint sample_count = 1u;
#endif
/// Returns triangle + 1 as a sample of the pinhole picture sees it; 0: nothing.
uint visible_at(ivec2 at, uint s) {
#ifdef GREATX_MULTISAMPLED
  return texelFetch(visibility, at, int(s)).r;
#else
  return imageLoad(visibility, at).r;
#endif
}
#include "camera/through_lens.glsl"
#ifndef GREATX_PANES
layout(set = 0, binding = shade_color_binding, scalar) buffer ColorBlock { uvec2 picture_color[]; };
layout(set = 0, binding = shade_seen_binding, scalar) writeonly buffer SeenBlock { uvec2 picture_seen[]; };
layout(set = 0, binding = shade_luminance_binding, scalar) buffer LuminanceBlock {
  float picture_luminance[];
};
#endif

/// Returns the radiance towards the eye of the triangle around the ray. It adds `weight` times its mirror.
vec3 surface_radiance(Seen seen, vec3 ray, float weight, inout Mirror mirror) {
  Surface s = surface_at(seen, ray);
  float f0 = dielectric_f0, water = 0.0;
  if (wet_on || snow_on) {
    water = weather_surface(s, seen.body);
    f0 = mix(dielectric_f0, water_f0, water);
  }
  Reflectance r = lambertian_reflectance(s.base_color);
  if (specular_on) r = reflectance_below(s.base_color, s.metallic, s.roughness, dot(s.n, s.v), f0);
  if (specular_on && s.pane) r = pane_reflectance_of(s.base_color, s.roughness, dot(s.n, s.v));
  vec3 radiance = s.glow;
  bool lit = sun_on && dot(s.n, lighting.sun_direction) > 0.0;
  if (lit) {
    vec3 direct = reflect_light(r, s.n, s.v, lighting.sun_direction, lighting.sun_illuminance);
    radiance += direct * sun_visibility(s.p, s.geometric);
  }
  float open = sky_on && contact_occlusion_on ? contact_open(s.p, s.n, seen.body) : 1.0;
  if (sky_on) radiance += open * reflect_sky(r, s.n, s.v, s.roughness, s.p);
  if (mirrors_on) add_mirror(mirror, s, r, weight * water, open);
  if (lights_on)
    radiance += reflect_lamps(r, s.n, s.geometric, s.v, s.p,
                              s.roughness < lamp_most_roughness || s.metallic > 0.5);
  if (haze_on) radiance = through_haze(radiance, -s.v, length(s.p));
  return radiance;
}

/// Makes the triangle the one that the centre sees, if it covers the centre and is nearer than the one found
/// so far.
void look(inout Center center, Seen seen, vec3 ray) {
  float facing = dot(ray, seen.normal);
  float depth = dot(seen.p0, seen.normal) / facing;
  const float rim = 1e-4;  // on an edge both neighbours cover the centre
  vec2 b = vec2(dot(ray, seen.u_numerator), dot(ray, seen.v_numerator)) / facing;
  bool covers = sample_count == 1u ||  // the sample is the centre itself
                (b.x >= -rim && b.y >= -rim && b.x + b.y <= 1.0 + rim);
  if (covers && depth > 0.0 && depth < center.depth) center = Center(depth, seen.triangle + 1u);
}

/// Returns the point of the triangle's rim that comes closest to the centre.
Center rim_of(Seen seen, vec3 ray) {
  vec2 b = inside(barycentrics(seen, ray));
  return Center(dot(camera.forward, seen.p0 + seen.e1 * b.x + seen.e2 * b.y), seen.triangle + 1u);
}

#ifdef GREATX_LINES
#include "camera/shade_lines.glsl"
#else
#ifdef GREATX_PANES
/// Returns the light of the air before a pane, times what the pane lets through, summed over its samples
/// (bits of `same`). The light from behind has the air's light of the whole way, and the pane takes no part
/// of that before it.
vec3 air_before(Seen seen, vec3 ray, ivec2 at, uint same) {
  float distance = dot(seen.p0, seen.normal) / dot(ray, seen.normal) * length(ray);
  vec3 air = through_haze(vec3(0.0), normalize(ray), distance), passes = vec3(0.0);
  for (uint s = 0u; s < sample_count; ++s)
    if ((same >> s & 1u) != 0u) passes += passes_at(at, s);
  return passes * air;
}
#endif

void main() {
  ivec2 at = own_pixel();
  if (outside_picture(at)) return;
  uint element = picture_element(at);
  vec2 pixel = own_place(at);
  ivec2 in_pinhole = distortion_on ? ivec2(pixel) : at;  // a conversion costs a CPU driver more than a sum
  vec3 ray = pixel_ray(pixel);
  if (faces_on) {
    footprint_of_lens_x = face_step(ivec2(1, 0), pixel);
    footprint_of_lens_y = face_step(ivec2(0, 1), pixel);
  }
  const float infinity = uintBitsToFloat(0x7f800000u);

  vec3 radiance = vec3(0.0);
  Center center = Center(infinity, 0u), first = center;
  Mirror mirror = Mirror(0.0, 0.0, vec3(0.0));
  uint ids[sample_count];
  bool looks_through = distortion_on && (ids_on || sample_count == 1u);
  if (looks_through) center = through_lens(pixel, ray);
  for (uint s = 0u; s < sample_count; ++s) ids[s] = visible_at(in_pinhole, s);
  if (looks_through && sample_count == 1u) ids[0] = center.id;
  float sky = 0.0;  // share of the samples
  uint left = (1u << sample_count) - 1u;  // samples not yet accounted for
  while (left != 0u) {
    uint id = 0u, same = 0u;
    for (uint s = sample_count; s-- > 0u;) id = (left >> s & 1u) != 0u ? ids[s] : id;
    for (uint s = 0u; s < sample_count; ++s) same |= uint(ids[s] == id) << s;
    left &= ~same;
    float weight = float(bitCount(same)) / float(sample_count);
    if (id == 0u) {
      sky += weight;
#ifndef GREATX_PANES
      if (color_on || luminance_on) radiance += weight * sky_radiance(ray);
#endif
    } else {
      Seen seen = see(id - 1u);
      if (ids_on && !distortion_on) look(center, seen, ray);
      if (ids_on && !distortion_on && sample_count > 1u && id == ids[0]) first = rim_of(seen, ray);
      if (color_on || luminance_on) radiance += weight * surface_radiance(seen, ray, weight, mirror);
#ifdef GREATX_PANES
      if (haze_on) radiance -= air_before(seen, ray, in_pinhole, same) / float(sample_count);
#endif
    }
  }
  // If samples around the centre hit and the centre itself slips through, the first sample stands for the
  // centre.
  if (!distortion_on && center.id == 0u && sky == 0.0) center = first;
#ifdef GREATX_PANES
  vec3 passes = vec3(0.0);
  for (uint s = 0u; s < sample_count; ++s) passes += passes_at(in_pinhole, s) / float(sample_count);
  uint id = center.id != 0u ? center.id : sky < 1.0 ? pane_beside : 0u;
  store_panes(element, id, center.depth, radiance * camera.exposure, passes);
#else
  if (lamp_halos_on && (color_on || luminance_on)) {
    float stretch = length(ray), far = min(center.depth, 1e6) * stretch;
    radiance += lamp_halos(pixel, ray / stretch, far);
  }
  bool panes = panes_on && (camera.first & camera_sees_panes) != 0u;
  if (panes) {
    Panes before = panes_before(element);
    bool nearer = before.id == pane_beside || (before.id != 0u && before.depth < center.depth);
    if (nearer) {
      radiance = before.radiance + before.passes * radiance;
      mirror.weight = 0.0;  // its place lies behind
      if (before.id != pane_beside) {
        center = Center(before.depth, before.id);
        sky = 0.0;
      }
    }
  }
  radiance *= camera.weight;
  // to the result of the earlier parts of the exposure
  bool adds = blend_on && (camera.first & camera_first_part) == 0u;
  if (color_on) {
    vec4 stored = vec4(min(radiance * camera.exposure, vec3(65504.0)), (1.0 - sky) * camera.weight);
    if (adds) stored = min(stored + unpack_color(picture_color[element]), vec4(65504.0));
    picture_color[element] = pack_color(stored);
  }
  if (luminance_on) {
    float stored = dot(radiance, vec3(0.2126, 0.7152, 0.0722));
    if (adds) stored += picture_luminance[element];
    picture_luminance[element] = stored;
  }
  if (range_on) center.depth *= length(ray);
  if (mirrors_on) {
    uvec3 words = pack_mirror(mirror);
    for (uint i = 0u; i < 3u; ++i) picture_beside[3u * element + i] = words[i];
  }
  if (ids_on) picture_seen[element] = uvec2(floatBitsToUint(center.depth), center.id);
#endif
}
#endif
