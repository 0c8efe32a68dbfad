// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives access to the buffers of the scene.
#ifndef GREATX_LIB_SCENE_GLSL
#define GREATX_LIB_SCENE_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#include "shared/scene.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec3Buffer { vec3 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec4Buffer { vec4 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec2Buffer { vec2 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer UintBuffer { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer PrimitiveBuffer {
  GpuPrimitive v[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MaterialBuffer {
  GpuMaterial v[];
};

layout(set = 0, binding = scene_binding, scalar) readonly buffer SceneBlock { GpuSceneAddresses scene; };
layout(set = 0, binding = bodies_binding, scalar) readonly buffer BodiesBlock { GpuBody bodies[]; };

GpuPrimitive scene_primitive(uint i) { return PrimitiveBuffer(scene.primitives).v[i]; }
GpuMaterial scene_material(uint i) { return MaterialBuffer(scene.materials).v[i]; }
uint scene_index(uint i) { return UintBuffer(scene.indices).v[i]; }
vec3 scene_position(uint i) { return Vec3Buffer(scene.positions).v[i]; }
vec3 scene_normal(uint i) { return Vec3Buffer(scene.normals).v[i]; }
vec4 scene_tangent(uint i) { return Vec4Buffer(scene.tangents).v[i]; }
vec2 scene_uv(uint i) { return Vec2Buffer(scene.uvs).v[i]; }
uint scene_facet(uint triangle) { return UintBuffer(scene.facet_of_triangle).v[triangle]; }

vec3 body_point(uint body, vec3 p) {
  vec4 h = vec4(p, 1.0);
  return vec3(dot(bodies[body].row0, h), dot(bodies[body].row1, h), dot(bodies[body].row2, h));
}
vec3 body_direction(uint body, vec3 d) {
  return vec3(dot(bodies[body].row0.xyz, d), dot(bodies[body].row1.xyz, d), dot(bodies[body].row2.xyz, d));
}
/// Returns the factor of a switched lamp's emission, by its number in the whole buffer of the bodies.
float lamp_factor(uint number) {
  GpuBody element = bodies[number / lamp_factors_of_element];
  uint place = number % lamp_factors_of_element;
  vec4 row = place < 4u ? element.row0 : place < 8u ? element.row1 : element.row2;
  return row[place & 3u];
}
/// Takes a ray into the frame of a moving body.
void enter_body(uint body, inout vec3 origin, inout vec3 direction) {
  GpuBody pose = bodies[body];
  // The columns of the inverse of a rotation are its rows.
  mat3 body_from_local = mat3(pose.row0.xyz, pose.row1.xyz, pose.row2.xyz);
  origin = body_from_local * (origin - vec3(pose.row0.w, pose.row1.w, pose.row2.w));
  direction = body_from_local * direction;
}
#endif
