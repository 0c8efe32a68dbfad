// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One fragment of a surface: radiance, planar depth, id. GREATX_COLOR and GREATX_IDS choose what is written.
#extension GL_EXT_nonuniform_qualifier : require
#include "camera/surface_interface.glsl"
#ifdef GREATX_COLOR
#include "camera/light.glsl"
#endif

layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) flat in uint in_primitive;
layout(location = 1) flat in uint in_material;
#ifdef GREATX_COLOR
layout(location = 2) in vec3 in_normal;
layout(location = 4) in vec4 in_tangent;
#endif
layout(location = 3) in vec2 in_uv;

#ifdef GREATX_COLOR
layout(location = 0) out vec4 out_color;
#ifdef GREATX_IDS
layout(location = 1) out uvec2 out_ids;
#endif
#else
layout(location = 0) out uvec2 out_ids;
#endif

vec4 texel(int index, vec4 none) {
  if (index < 0) return none;
  return texture(textures[nonuniformEXT(index)], in_uv);
}

#ifdef GREATX_COLOR
vec3 shading_normal(GpuMaterial material, vec3 geometric) {
  vec3 n = normalize(in_normal);
  if (normal_maps_on && material.normal_texture >= 0) {
    vec3 t = in_tangent.xyz;
    vec3 b = cross(n, t) * in_tangent.w;
    vec3 m = texel(material.normal_texture, vec4(0.5, 0.5, 1.0, 1.0)).xyz * 2.0 - 1.0;
    n = normalize(t * (m.x * material.normal_scale) + b * (m.y * material.normal_scale) + n * m.z);
  }
  // A surface is solid from both sides: its normal looks at the side that the eye is on.
  return dot(n, geometric) < 0.0 ? -n : n;
}

vec3 surface_radiance(GpuMaterial material, vec4 base_color, vec3 p_eye) {
  vec3 v = -normalize(p_eye);
  vec3 geometric = normalize(in_normal);
  geometric = dot(geometric, v) < 0.0 ? -geometric : geometric;
  vec3 n = shading_normal(material, geometric);
  float metallic = material.metallic;
  float roughness = material.roughness;
  if (textures_on) {
    vec4 mr = texel(material.metallic_roughness_texture, vec4(1.0));
    metallic *= mr.b;
    roughness *= mr.g;
  }
  Reflectance r = lambertian_reflectance(base_color.rgb);
  if (specular_on) r = reflectance_of(base_color.rgb, metallic, roughness, dot(n, v));
  vec3 radiance = vec3(0.0);
  if (sun_on) {
    vec3 direct = reflect_light(r, n, v, lighting.sun_direction, lighting.sun_illuminance);
    radiance += direct * sun_visibility(p_eye, geometric);
  }
  if (sky_on) {
    radiance += r.diffuse * sky_irradiance_over_pi(n);
    if (specular_on) radiance += r.albedo * environment_radiance(reflect(-v, n), roughness);
  }
  if (lights_on) radiance += reflect_lights(r, n, v, p_eye);
  if (emissive_on) {
    vec3 glow = material.emissive * emissive_nits;
    if (textures_on) glow *= texel(material.emissive_texture, vec4(1.0)).rgb;
    radiance += glow;
  }
  return radiance;
}
#endif

void main() {
  float depth = 1.0 / gl_FragCoord.w;
#if defined(GREATX_COLOR)
  GpuMaterial material = scene_material(in_material);
  vec4 base_color = material.base_color;
  if (textures_on) base_color *= texel(material.base_color_texture, vec4(1.0));
  if (alpha_mask_on) {
    float alpha = textures_on ? base_color.a : base_color.a * texel(material.base_color_texture, vec4(1.0)).a;
    if (alpha < material.alpha_cutoff) discard;
  }
  vec3 ray = camera.ray_0 + camera.ray_x * gl_FragCoord.x + camera.ray_y * gl_FragCoord.y;
  vec3 radiance = surface_radiance(material, base_color, ray * depth);
  out_color = vec4(min(radiance * camera.exposure, vec3(65504.0)), 1.0);
#else
  if (alpha_mask_on) {
    GpuMaterial material = scene_material(in_material);
    float alpha = material.base_color.a * texel(material.base_color_texture, vec4(1.0)).a;
    if (alpha < material.alpha_cutoff) discard;
  }
#endif
#ifdef GREATX_IDS
  out_ids = uvec2(floatBitsToUint(depth), in_primitive + 1u);
#endif
}
