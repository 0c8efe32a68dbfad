// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets C++ and GLSL read one header alike: scalar layout, the same type names, inline functions. Every header
// of shaders/shared includes this file first. Structs hold 4-byte members (or addresses as uint64_t on an
// 8-byte boundary), so that GLSL's scalar layout and C++'s are the same. Check sizes with static_assert in
// C++.
#ifndef GREATX_SHADERS_SHARED_GLSL_H
#define GREATX_SHADERS_SHARED_GLSL_H

#ifdef __cplusplus
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace greatx::shared {
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
}  // namespace greatx::shared

#define GREATX_SHARED_BEGIN namespace greatx::shared {
#define GREATX_SHARED_END }
#define GREATX_FUNCTION inline
#else
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define GREATX_SHARED_BEGIN
#define GREATX_SHARED_END
#define GREATX_FUNCTION
#endif

#endif
