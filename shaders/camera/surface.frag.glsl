#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radiance, depth and ids.
#define GREATX_COLOR
#define GREATX_IDS
#include "camera/surface_frag.glsl"
