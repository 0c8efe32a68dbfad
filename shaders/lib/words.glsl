// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Quadruples of words, read as 64 bits twice. On drivers that run several invocations in a CPU's vector
// registers a load is a branch for each invocation and each component, whatever its size.
#ifndef GREATX_LIB_WORDS_GLSL
#define GREATX_LIB_WORDS_GLSL
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

uvec4 quad_of(u64vec2 words) { return uvec4(unpack32(words.x), unpack32(words.y)); }

struct QuadPair {
  uvec4 first, second;
};
QuadPair pair_of(u64vec4 words) { return QuadPair(quad_of(words.xy), quad_of(words.zw)); }
#endif
