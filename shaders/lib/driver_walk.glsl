// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The body of lib/walk.glsl for the driver's ray query. Of several triangles at the same t, any one is met.
Hit GREATX_WALK(vec3 origin, float t_min, vec3 direction, float t_max GREATX_WALK_PARAMETERS) {
  uint mask = GREATX_TRACE_MASK, flags = gl_RayFlagsNoOpaqueEXT;
#ifdef GREATX_WALK_BODY
  mask = moving_mask;
#endif
#ifdef GREATX_WALK_OPAQUE
  flags = gl_RayFlagsOpaqueEXT;
#endif
#ifdef GREATX_WALK_MASKED  // only geometries that were uploaded as not opaque are looked at one by one
  flags = gl_RayFlagsNoneEXT;
#endif
#ifdef GREATX_WALK_ANY
  flags |= gl_RayFlagsTerminateOnFirstHitEXT;
#endif
  rayQueryEXT query;
  rayQueryInitializeEXT(query, tlas, flags, mask, origin, t_min, direction, t_max);
#ifdef GREATX_WALK_OPAQUE
  while (rayQueryProceedEXT(query)) {}
#else
  while (rayQueryProceedEXT(query)) {
    uint index = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false)) +
                 uint(rayQueryGetIntersectionGeometryIndexEXT(query, false));
    GpuPrimitive primitive = scene_primitive(index);
    uint owner = primitive.owner,
         triangle = primitive.first_triangle + uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
#ifdef GREATX_WALK_BODY
    if (primitive.body != GREATX_WALK_BODY) continue;
#endif
#ifdef GREATX_WALK_SKIPS
    if (GREATX_WALK_SKIPS) continue;
#endif
    Candidate candidate = Candidate(rayQueryGetIntersectionTEXT(query, false),
                                    rayQueryGetIntersectionBarycentricsEXT(query, false), triangle, index,
                                    scene_facet(triangle), primitive.body, owner, true);
    if (GREATX_WALK_SOLID) rayQueryConfirmIntersectionEXT(query);
  }
#endif
  Hit hit = no_hit(t_max);
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
    hit.hit = true;
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.primitive = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)) +
                    uint(rayQueryGetIntersectionGeometryIndexEXT(query, true));
    hit.triangle = scene_primitive(hit.primitive).first_triangle +
                   uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    hit.barycentric = rayQueryGetIntersectionBarycentricsEXT(query, true);
    hit.front = rayQueryGetIntersectionFrontFaceEXT(query, true);
  }
  return hit;
}
