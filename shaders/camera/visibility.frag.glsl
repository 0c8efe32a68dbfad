#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the triangle that a sample sees.
layout(location = 0) flat in uint in_triangle;
layout(location = 0) out uint out_triangle;

void main() { out_triangle = in_triangle; }
