// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the number of an invocation in a dispatch of gpu::Cmd::dispatch_linear. That call lays groups out in
// rows, since a device need not take more than 65535 groups along an axis. The last row may reach beyond the
// count, so compare the number with the count. It is a macro, since the size of a group is known only after
// the shader has declared it. Groups extend along one axis only.
#ifndef GREATX_LIB_LINEAR_GLSL
#define GREATX_LIB_LINEAR_GLSL
#define linear_invocation \
  (gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x)
#endif
