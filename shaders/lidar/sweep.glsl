// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Each invocation traces one ray. It goes from the sensor's pose at the shot's own time to the first surface,
// and through panes of glass to the first surface that is not a pane. Without divergence a shot is one ray.
// sweep.comp.glsl includes this with all surfaces solid and one reflectance a material.
// sweep_textured.comp.glsl includes it with alpha masks that let beams through and base-colour textures that
// vary the reflectance.
#include "shared/lidar.h"
uint trace_mask = 0xffu;
#define GREATX_TRACE_MASK trace_mask
#include "lib/trace.glsl"

layout(constant_id = lidar_exclude_body_id) const bool exclude_body = false;
layout(constant_id = lidar_divergence_id) const bool divergence = false;
layout(constant_id = lidar_glass_id) const bool glass = false;
layout(constant_id = lidar_target_motion_id) const bool target_motion = false;
layout(constant_id = lidar_alpha_mask_id) const bool alpha_mask = false;
layout(constant_id = lidar_textured_reflectance_id) const bool textured_reflectance = false;

layout(local_size_x = lidar_patch_columns, local_size_y = lidar_patch_rows) in;

layout(set = 0, binding = lidar_beams_binding, scalar) readonly buffer BeamsBlock { LidarBeam beams[]; };
layout(set = 0, binding = lidar_poses_binding, scalar) readonly buffer PosesBlock { GpuBody poses[]; };
layout(set = 0, binding = lidar_echoes_binding, scalar) writeonly buffer EchoesBlock { LidarEcho echoes[]; };
layout(set = 0, binding = lidar_sub_rays_binding, scalar) readonly buffer SubRaysBlock { vec2 offsets[]; };
layout(set = 0, binding = lidar_panes_binding, scalar) readonly buffer PanesBlock { LidarPane panes[]; };
layout(set = 0, binding = lidar_targets_binding, scalar) readonly buffer TargetsBlock {
  LidarTarget targets[];
};
layout(set = 0, binding = lidar_motions_binding, scalar) readonly buffer MotionsBlock { GpuBody motions[]; };

layout(push_constant, scalar) uniform Constants { LidarConstants constants; };

vec3 turned(GpuBody body, vec3 d) {
  return vec3(dot(body.row0.xyz, d), dot(body.row1.xyz, d), dot(body.row2.xyz, d));
}
vec3 moved(GpuBody body, vec3 p) { return turned(body, p) + vec3(body.row0.w, body.row1.w, body.row2.w); }

/// Describes a hit, and the motion that took the ray to where its body stands at the tick. The data of a
/// body's triangles hold there.
struct ShotHit {
  Hit hit;
  uint motion;  // lidar_still: no motion
};

/// Returns the first surface among the bodies of `trace_mask` where they stand at the tick. `behind` is the
/// facet that the ray leaves.
Hit first_surface(vec3 origin, float t_min, vec3 direction, uint behind) {
#ifdef GREATX_TRACE_TREE
  // The trees take the same path in all cases, since passing over triangles costs them nothing.
  return trace_closest_except(origin, t_min, direction, constants.max_range,
                              exclude_body ? constants.excluded_body : no_body, behind, alpha_mask);
#else
  if (glass && behind != no_facet)
    return trace_closest_except(origin, t_min, direction, constants.max_range,
                                exclude_body ? constants.excluded_body : no_body, behind, alpha_mask);
  Hit hit;
#ifdef GREATX_TRACE_ALPHA
  if (alpha_mask)
    hit = trace_closest_masked(origin, t_min, direction, constants.max_range);
  else
#endif
    hit = trace_closest(origin, t_min, direction, constants.max_range);
  // Only beams that meet the own body pay for looking at every triangle on their way.
  if (exclude_body && hit.hit && scene_primitive(hit.primitive).owner == constants.excluded_body)
    hit = trace_closest_except(origin, t_min, direction, constants.max_range, constants.excluded_body,
                               no_facet, alpha_mask);
  return hit;
#endif
}

/// Returns whether the ray comes near a body somewhere between its ends. The cross product is used, since
/// differences of squares of hundreds of metres would lose the body.
bool may_meet(vec4 sphere, vec3 origin, float t_min, vec3 direction, float t_max) {
  vec3 to = sphere.xyz - origin;
  vec3 side = cross(to, direction);
  float along = dot(to, direction);
  return dot(side, side) <= sphere.w * sphere.w && along + sphere.w >= t_min && along - sphere.w <= t_max;
}

/// Returns the first surface with every body where it is at the shot's time. The acceleration structure has
/// the bodies where they are at the tick. Therefore the ray is moved instead of the body. The motion is
/// rigid, which keeps lengths along the ray.
ShotHit trace_shot(vec3 origin, float t_min, vec3 direction, uint instant, uint behind) {
  bool apart = target_motion && constants.apart != 0u;
  trace_mask = apart ? static_mask : 0xffu;
  ShotHit found = ShotHit(first_surface(origin, t_min, direction, behind), lidar_still);
  if (!apart) return found;
  for (uint i = 0u; i < constants.targets; ++i) {
    LidarTarget target = targets[i];
    if (!may_meet(target.sphere, origin, t_min, direction, found.hit.t)) continue;
    uint motion = target.first_motion == lidar_still ? lidar_still : target.first_motion + instant;
    vec3 from = origin, to = direction;
    if (motion != lidar_still) {
      from = moved(motions[motion], origin);
      to = turned(motions[motion], direction);
    }
    Hit hit = trace_closest_of_body(from, t_min, to, found.hit.t, target.body, behind, alpha_mask);
    if (hit.hit) found = ShotHit(hit, motion);
  }
  return found;
}

/// Returns the Lambertian reflectance at the sensor's wavelength. Where the file states none, it is the
/// luminance of the base colour (ITU-R BT.709's weights), with its texture if the effect is on.
float reflectance_at(Hit hit, GpuMaterial material) {
  bool near = constants.wavelength_nm == 905u;
#ifdef GREATX_TRACE_ALPHA
  uint stated = near ? material_flag_reflectance_905nm : material_flag_reflectance_1550nm;
  if (textured_reflectance && (material.flags & stated) == 0u)
    return dot(hit_base_color(material, hit.triangle, hit.barycentric).rgb, vec3(0.2126, 0.7152, 0.0722));
#endif
  return near ? material.reflectance_905nm : material.reflectance_1550nm;
}

/// Holds the fractions of the light on a pane that the pane returns and transmits.
struct PaneLight {
  float back, through;
};
PaneLight pane_light(LidarPane pane, vec3 normal, vec3 direction, float cosine, vec3 axis) {
  float mirrored = pane_reflectance(cosine, constants.refractive_index, pane.sheets);
  float rest = 1.0 - mirrored;
  float back = rest * pane.scattering * cosine;
  // The axis of the beam decides whether the mirrored beam returns to the receiver.
  float axis_cosine = min(abs(dot(normal, axis)), 1.0);
  if (constants.half_divergence > 0.0 && axis_cosine > 0.5)
    back += mirrored * glare_intensity(length(cross(normal, axis)), axis_cosine, constants.half_divergence);
  return PaneLight(back, rest * (1.0 - pane.scattering) * pane.clearness);
}

vec3 off_axis(vec3 axis, vec2 offset) {
  vec2 level = vec2(-axis.y, axis.x);
  float size = length(level);
  vec3 left = size > 1e-6 ? vec3(level / size, 0.0) : vec3(0.0, 1.0, 0.0);
  return normalize(axis + offset.x * left + offset.y * cross(axis, left));
}

void main() {
  uint column = gl_GlobalInvocationID.x, row = gl_GlobalInvocationID.y, ray = gl_GlobalInvocationID.z;
  if (column >= constants.columns || row >= constants.rows) return;
  uint shot = column * constants.rows + row;
  uint shots = constants.columns * constants.rows;

  LidarBeam beam = beams[shot];
  GpuBody pose = poses[constants.pose_count == 1u ? 0u : beam.instant];
  vec3 origin = vec3(pose.row0.w, pose.row1.w, pose.row2.w);
  vec3 axis = turned(pose, beam.direction);
  vec3 direction = divergence ? turned(pose, off_axis(beam.direction, offsets[ray])) : axis;

  uint stride = shots * constants.sub_rays;
  uint slot = shot * constants.sub_rays + ray;
  float t_min = constants.min_range;
  float carried = 1.0;  // the share of the ray's light that is left, one way
  uint behind = no_facet;
  uint written = 0u;
  for (uint surface = 0u; surface < (glass ? lidar_most_panes + 1u : 1u); ++surface) {
    ShotHit found = trace_shot(origin, t_min, direction, beam.instant, behind);
    if (!found.hit.hit) break;
    GpuPrimitive primitive = scene_primitive(found.hit.primitive);
    vec3 normal = geometric_normal(triangle_corners(found.hit.triangle, primitive.body));
    vec3 ray_there = direction, axis_there = axis;
    if (target_motion && found.motion != lidar_still) {
      ray_there = turned(motions[found.motion], direction);
      axis_there = turned(motions[found.motion], axis);
    }
    float cosine = min(abs(dot(normal, ray_there)), 1.0);
    float through = 0.0, back;
    LidarPane pane = LidarPane(0.0, 0.0, 0.0);
    if (glass) pane = panes[primitive.material];
    if (pane.sheets > 0.0) {
      PaneLight light = pane_light(pane, normal, ray_there, cosine, axis_there);
      back = light.back;
      through = light.through;
    } else {
      back = reflectance_at(found.hit, scene_material(primitive.material)) * cosine;
    }
    // A clean pane returns nothing and makes no echo. The last slot is kept for the surface that ends the
    // ray.
    if (pane.sheets == 0.0 || (back > 0.0 && written + 1u < lidar_glass_slots)) {
      echoes[written * stride + slot] =
          LidarEcho(found.hit.t, carried * carried * back, carried * (1.0 - through),
                    primitive.instance + 1u, primitive.material + 1u);
      ++written;
    }
    if (through <= 0.0) break;
    carried *= through;
    t_min = found.hit.t;
    behind = scene_facet(found.hit.triangle);
  }
  if (written < (glass ? lidar_glass_slots : 1u))
    echoes[written * stride + slot] =
        LidarEcho(uintBitsToFloat(0x7f800000u), 0.0, 0.0, lidar_no_object, lidar_no_object);
}
