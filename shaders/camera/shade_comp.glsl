// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Shades what the visibility pass found: each triangle that a pixel's samples saw once, weighed by its samples. Depth
// and id are those of the triangle that the pixel's centre looks at. GREATX_MULTISAMPLED: four samples a pixel.
#extension GL_EXT_nonuniform_qualifier : require
#include "camera/haze.glsl"
#include "camera/light.glsl"
#include "camera/sky.glsl"
#include "camera/visibility_view.glsl"

layout(local_size_x = shade_group_width, local_size_y = shade_group_height) in;
layout(set = 1, binding = 0) uniform sampler2D textures[];
#ifdef GREATX_MULTISAMPLED
layout(set = 0, binding = visibility_binding) uniform usampler2DMS visibility;
ivec2 picture_size() { return textureSize(visibility); }
const uint sample_count = 4u;
#else
layout(set = 0, binding = visibility_binding) uniform usampler2D visibility;
ivec2 picture_size() { return textureSize(visibility, 0); }
const uint sample_count = 1u;
#endif
layout(set = 0, binding = triangle_primitives_binding, scalar) readonly buffer TrianglePrimitivesBlock {
  uint triangle_primitives[];
};
layout(set = 0, binding = shade_color_binding, rgba16f) uniform writeonly image2D color_image;
layout(set = 0, binding = shade_seen_binding, rg32ui) uniform writeonly uimage2D seen_image;
layout(set = 0, binding = shade_luminance_binding, r32f) uniform writeonly image2D luminance_image;

/// A triangle as the eye sees it along a ray d with dot(d, forward) = 1: planar depth and barycentrics of the second
/// and third corner are quotients of functions linear in d (Moeller and Trumbore 1997, sorted by d).
struct Seen {
  uint triangle;
  uint primitive;
  uvec3 vertices;
  vec3 p0, e1, e2;       // from the eye, local axes
  vec3 normal;           // not unit
  vec3 u_numerator, v_numerator;
};

Seen see(uint triangle) {
  Seen seen;
  seen.triangle = triangle;
  seen.primitive = triangle_primitives[triangle];
  uint body = scene_primitive(seen.primitive).body;
  seen.vertices = uvec3(scene_index(3u * triangle), scene_index(3u * triangle + 1u), scene_index(3u * triangle + 2u));
  vec3 a = scene_position(seen.vertices.x);
  seen.p0 = from_eye(body, a);
  seen.e1 = scene_position(seen.vertices.y) - a;
  seen.e2 = scene_position(seen.vertices.z) - a;
  if (body != 0u) {
    seen.e1 = body_direction(body, seen.e1);
    seen.e2 = body_direction(body, seen.e2);
  }
  seen.normal = cross(seen.e1, seen.e2);
  seen.u_numerator = cross(seen.e2, seen.p0);
  seen.v_numerator = cross(seen.p0, seen.e1);
  return seen;
}

vec2 barycentrics(Seen seen, vec3 ray) {
  return vec2(dot(ray, seen.u_numerator), dot(ray, seen.v_numerator)) / dot(ray, seen.normal);
}

/// The nearest point of the triangle, roughly: a sample at the rim may see a triangle that the centre misses.
vec2 inside(vec2 b) {
  b = clamp(b, vec2(0.0), vec2(1.0));
  return b / max(b.x + b.y, 1.0);
}

/// Where textures are read, and how wide a pixel is there.
struct Footprint {
  vec2 uv, dx, dy;
};

vec4 texel(int index, Footprint at) {
  return textureGrad(textures[nonuniformEXT(index)], at.uv, at.dx, at.dy);
}

/// Radiance towards the eye of the triangle around the ray.
vec3 surface_radiance(Seen seen, vec3 ray) {
  GpuPrimitive primitive = scene_primitive(seen.primitive);
  GpuMaterial material = scene_material(primitive.material);
  vec2 center = barycentrics(seen, ray), b = inside(center);
  vec3 p = seen.p0 + seen.e1 * b.x + seen.e2 * b.y;
  vec3 v = -normalize(p);
  // A surface is solid from both sides: its normals look at the side that the eye is on.
  vec3 geometric = normalize(seen.normal);
  geometric = dot(geometric, v) < 0.0 ? -geometric : geometric;
  vec3 n = scene_normal(seen.vertices.x) * (1.0 - b.x - b.y) + scene_normal(seen.vertices.y) * b.x +
           scene_normal(seen.vertices.z) * b.y;
  n = normalize(primitive.body == 0u ? n : body_direction(primitive.body, n));

  vec3 base_color = material.base_color.rgb;
  float metallic = material.metallic, roughness = material.roughness;
  vec3 glow = emissive_on ? material.emissive * emissive_nits : vec3(0.0);
  if (textures_on || normal_maps_on) {
    Footprint at;
    vec2 uv0 = scene_uv(seen.vertices.x);
    mat2 along = mat2(scene_uv(seen.vertices.y) - uv0, scene_uv(seen.vertices.z) - uv0);
    at.uv = uv0 + along * b;
    at.dx = along * (barycentrics(seen, ray + camera.ray_x) - center);
    at.dy = along * (barycentrics(seen, ray + camera.ray_y) - center);
    if (textures_on) {
      if (material.base_color_texture >= 0) base_color *= texel(material.base_color_texture, at).rgb;
      if (material.metallic_roughness_texture >= 0) {
        vec4 mr = texel(material.metallic_roughness_texture, at);
        metallic *= mr.b;
        roughness *= mr.g;
      }
      if (emissive_on && material.emissive_texture >= 0) glow *= texel(material.emissive_texture, at).rgb;
    }
    if (normal_maps_on && material.normal_texture >= 0) {
      vec4 tangent = scene_tangent(seen.vertices.x) * (1.0 - b.x - b.y) + scene_tangent(seen.vertices.y) * b.x +
                     scene_tangent(seen.vertices.z) * b.y;
      vec3 t = primitive.body == 0u ? tangent.xyz : body_direction(primitive.body, tangent.xyz);
      vec3 bitangent = cross(n, t) * tangent.w;
      vec3 m = texel(material.normal_texture, at).xyz * 2.0 - 1.0;
      n = normalize(t * (m.x * material.normal_scale) + bitangent * (m.y * material.normal_scale) + n * m.z);
    }
  }
  n = dot(n, geometric) < 0.0 ? -n : n;

  Reflectance r = lambertian_reflectance(base_color);
  if (specular_on) r = reflectance_of(base_color, metallic, roughness, dot(n, v));
  vec3 radiance = glow;
  if (sun_on && dot(n, lighting.sun_direction) > 0.0) {
    vec3 direct = reflect_light(r, n, v, lighting.sun_direction, lighting.sun_illuminance);
    radiance += direct * sun_visibility(p, geometric);
  }
  if (sky_on) {
    radiance += r.diffuse * sky_irradiance_over_pi(n);
    if (specular_on) radiance += r.albedo * environment_radiance(reflect(-v, n), roughness);
  }
  if (lights_on) radiance += reflect_lights(r, n, v, p);
  if (haze_on) radiance = through_haze(radiance, -v, length(p));
  return radiance;
}

/// What the pixel's centre looks at, as triangle by triangle comes along.
struct Center {
  float depth;
  uint id;
};

/// Takes the triangle as what the centre sees if it covers the centre and is nearer than what did so far.
void look(inout Center center, Seen seen, vec3 ray) {
  float facing = dot(ray, seen.normal);
  float depth = dot(seen.p0, seen.normal) / facing;
  const float rim = 1e-4;  // on an edge both neighbours cover the centre
  vec2 b = vec2(dot(ray, seen.u_numerator), dot(ray, seen.v_numerator)) / facing;
  bool covers = sample_count == 1u || (b.x >= -rim && b.y >= -rim && b.x + b.y <= 1.0 + rim);
  if (covers && depth > 0.0 && depth < center.depth) center = Center(depth, seen.triangle + 1u);
}

/// The triangle's rim where it comes closest to the centre.
Center rim_of(Seen seen, vec3 ray) {
  vec2 b = inside(barycentrics(seen, ray));
  return Center(dot(camera.forward, seen.p0 + seen.e1 * b.x + seen.e2 * b.y), seen.triangle + 1u);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, picture_size()))) return;
  vec2 pixel = vec2(at) + 0.5;
  vec3 ray = camera.ray_0 + camera.ray_x * pixel.x + camera.ray_y * pixel.y;
  const float infinity = uintBitsToFloat(0x7f800000u);

  uint ids[sample_count];
  for (int s = 0; s < int(sample_count); ++s) ids[s] = texelFetch(visibility, at, s).r;
  vec3 radiance = vec3(0.0);
  Center center = Center(infinity, 0u), first = center;
  bool sky = false;
  uint left = (1u << sample_count) - 1u;  // samples not yet accounted for
  while (left != 0u) {
    uint id = 0u, same = 0u;
    for (uint s = sample_count; s-- > 0u;) id = (left >> s & 1u) != 0u ? ids[s] : id;
    for (uint s = 0u; s < sample_count; ++s) same |= uint(ids[s] == id) << s;
    left &= ~same;
    float weight = float(bitCount(same)) / float(sample_count);
    if (id == 0u) {
      sky = true;
      if (color_on || luminance_on) radiance += weight * sky_radiance(ray);
    } else {
      Seen seen = see(id - 1u);
      if (ids_on) look(center, seen, ray);
      if (ids_on && sample_count > 1u && id == ids[0]) first = rim_of(seen, ray);
      if (color_on || luminance_on) radiance += weight * surface_radiance(seen, ray);
    }
  }
  // Samples around the centre hit, the centre itself slips through: the first sample stands for it.
  if (center.id == 0u && !sky) center = first;
  if (color_on) imageStore(color_image, at, vec4(min(radiance * camera.exposure, vec3(65504.0)), 1.0));
  if (luminance_on) imageStore(luminance_image, at, vec4(dot(radiance, vec3(0.2126, 0.7152, 0.0722))));
  if (ids_on) imageStore(seen_image, at, uvec4(floatBitsToUint(center.depth), center.id, 0u, 0u));
}
