// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A template, included once for each function that it defines. The function GREATX_WALK follows a ray and
// decides about each triangle that the ray passes through between t_min and t_max, in any order. It returns
// the first triangle that is solid, or with GREATX_WALK_ANY any one that is:
//
//   Hit GREATX_WALK(vec3 origin, float t_min, vec3 direction, float t_max GREATX_WALK_PARAMETERS)
//
// These macros are its parameters. Names in them must differ from the local names of the back ends.
//   GREATX_WALK_PARAMETERS  parameters of the function, after a comma
//   GREATX_WALK_SOLID       an expression of `candidate` (Candidate) and the parameters: whether it is solid.
//                           It may change inout parameters.
//   GREATX_WALK_SKIPS       optional, an expression of `owner`: bodies of this owner are passed over
//   GREATX_WALK_BODY        optional: only the triangles of this one moving body are there
//   GREATX_WALK_ANY         optional: any solid triangle ends the walk
//   GREATX_WALK_OPAQUE      optional: everything is solid, so the driver need not ask
//   GREATX_WALK_MASKED      optional: everything without a mask is solid, as above
#ifdef GREATX_TRACE_TREE
#include "lib/tree_walk.glsl"
#else
#include "lib/driver_walk.glsl"
#endif
#undef GREATX_WALK
#undef GREATX_WALK_PARAMETERS
#undef GREATX_WALK_SOLID
#undef GREATX_WALK_SKIPS
#undef GREATX_WALK_BODY
#undef GREATX_WALK_ANY
#undef GREATX_WALK_OPAQUE
#undef GREATX_WALK_MASKED
