// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#ifndef GREATX_SHADERS_SHARED_PROBE_H
#define GREATX_SHADERS_SHARED_PROBE_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint probe_workgroup = 64u;

struct ProbeRay {
  vec3 origin;
  vec3 direction;  // hits are at multiples of its length
};

struct ProbeHit {
  float t;         // +inf: nothing
  uint primitive;  // index + 1; 0: nothing
};

struct ProbeConstants {
  uint count;
  uint excluded_body;  // ~0: none
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::ProbeRay) == 24);
static_assert(sizeof(greatx::shared::ProbeHit) == 8);
#endif
#endif
