// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The invocation's number in a dispatch of gpu::Cmd::dispatch_linear, which lays groups out in rows: a device need not take
// more than 65535 along an axis. The last row reaches beyond the count: compare with it. A macro, since the size of a
// group is known only after the shader has declared it (one axis alone).
#ifndef GREATX_LIB_LINEAR_GLSL
#define GREATX_LIB_LINEAR_GLSL
#define linear_invocation (gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x)
#endif
