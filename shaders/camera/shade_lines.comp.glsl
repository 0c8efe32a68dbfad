#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#define GREATX_LINES
#include "camera/shade_comp.glsl"
