// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One shot per invocation: the beam from the sensor's pose at its own time to the first surface.
// Included by sweep.comp.glsl (all surfaces solid and of one reflectance per material) and sweep_textured.comp.glsl
// (alpha masks let beams through, base-colour textures vary the reflectance).
#include "shared/lidar.h"
#include "lib/trace.glsl"

layout(constant_id = lidar_exclude_body_id) const bool exclude_body = false;
layout(constant_id = lidar_alpha_mask_id) const bool alpha_mask = false;
layout(constant_id = lidar_textured_reflectance_id) const bool textured_reflectance = false;

layout(local_size_x = lidar_patch_azimuths, local_size_y = lidar_patch_channels) in;

layout(set = 0, binding = lidar_angles_binding, scalar) readonly buffer AnglesBlock { vec2 angles[]; };
layout(set = 0, binding = lidar_poses_binding, scalar) readonly buffer PosesBlock { GpuBody poses[]; };
layout(set = 0, binding = lidar_returns_binding, scalar) writeonly buffer ReturnsBlock { LidarReturn returns[]; };

layout(push_constant, scalar) uniform Constants { LidarConstants constants; };

Hit trace_beam(vec3 origin, vec3 direction) {
  Hit hit;
#ifdef GREATX_TRACE_ALPHA
  if (alpha_mask)
    hit = trace_closest_masked(origin, constants.min_range, direction, constants.max_range);
  else
#endif
    hit = trace_closest(origin, constants.min_range, direction, constants.max_range);
  // Only beams that meet the own body pay for looking at every triangle on their way.
  if (exclude_body && hit.hit && scene_primitive(hit.primitive).body == constants.excluded_body)
    hit = trace_closest_except(origin, constants.min_range, direction, constants.max_range, constants.excluded_body,
                               no_facet, alpha_mask);
  return hit;
}

/// Lambertian reflectance at the sensor's wavelength. Where the file states none it is the luminance of the base colour
/// (ITU-R BT.709's weights), with its texture if the effect is on.
float reflectance_at(Hit hit, GpuMaterial material) {
  bool near = constants.wavelength_nm == 905u;
#ifdef GREATX_TRACE_ALPHA
  uint stated = near ? material_flag_reflectance_905nm : material_flag_reflectance_1550nm;
  if (textured_reflectance && (material.flags & stated) == 0u)
    return dot(hit_base_color(material, hit.triangle, hit.barycentric).rgb, vec3(0.2126, 0.7152, 0.0722));
#endif
  return near ? material.reflectance_905nm : material.reflectance_1550nm;
}

void main() {
  uint step_index = gl_GlobalInvocationID.x;
  uint channel = gl_GlobalInvocationID.y;
  if (step_index >= constants.azimuth_steps || channel >= constants.channels) return;

  vec2 elevation = angles[channel];
  vec2 azimuth = angles[constants.channels + step_index];
  vec3 beam = vec3(elevation.x * azimuth.x, elevation.x * azimuth.y, elevation.y);
  GpuBody pose = poses[constants.pose_count == 1u ? 0u : step_index];
  vec3 origin = vec3(pose.row0.w, pose.row1.w, pose.row2.w);
  vec3 direction = vec3(dot(pose.row0.xyz, beam), dot(pose.row1.xyz, beam), dot(pose.row2.xyz, beam));

  Hit hit = trace_beam(origin, direction);
  LidarReturn result = LidarReturn(uintBitsToFloat(0x7f800000u), 0.0, lidar_no_object, lidar_no_object);
  if (hit.hit) {
    GpuPrimitive primitive = scene_primitive(hit.primitive);
    vec3 normal = geometric_normal(triangle_corners(hit.triangle, primitive.body));
    result.range = hit.t;
    result.intensity = reflectance_at(hit, scene_material(primitive.material)) *
                       min(abs(dot(normal, direction)), 1.0);
    result.instance = primitive.instance + 1u;
    result.material = primitive.material + 1u;
  }
  returns[step_index * constants.channels + channel] = result;
}
