#version 460
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#extension GL_GOOGLE_include_directive : require
#define GREATX_TRACE_ALPHA
#include "lidar/sweep.glsl"
