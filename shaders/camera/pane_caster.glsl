// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the vertices of panes tell camera/shadow_pane.frag.glsl.

layout(set = 0, binding = material_records_binding, scalar) readonly buffer MaterialRecordsBlock {
  u64vec2 material_records[];
};
layout(location = 0) out vec3 out_place;
layout(location = 1) flat out vec3 out_to_light;
layout(location = 2) flat out vec3 out_color;

/// `to_light` has any length.
void put_pane(vec3 place, vec3 to_light) {
  out_place = place;
  out_to_light = normalize(to_light);
  uint material = scene_primitive(uint(gl_InstanceIndex)).material;
  uint color = quad_of(material_records[material * material_record_quads + 2u]).w;
  out_color = vec3(color & 1023u, color >> 10 & 1023u, color >> 20 & 1023u) / 1023.0;
}
