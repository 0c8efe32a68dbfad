#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#extension GL_GOOGLE_include_directive : require
#define GREATX_TRACE_ALPHA
#include "shared/lidar.h"
layout(constant_id = lidar_base_color_arrays_id) const uint base_color_arrays = 0u;
#include "lidar/sweep.glsl"
