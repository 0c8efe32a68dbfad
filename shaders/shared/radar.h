// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Rays of a radar: what rf/radar/echoes/echo_pass.cpp and shaders/radar/echoes.comp.glsl agree on.
#ifndef GREATX_SHADERS_SHARED_RADAR_H
#define GREATX_SHADERS_SHARED_RADAR_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint radar_directions_binding = first_pass_binding;  // vec3[rays], unit, local axes
const uint radar_hits_binding =
    first_pass_binding + 1u;  // uint[max_bounces * rays + 1]: a bounce's rays side by side;
// then whether the source itself sees the receiver
const uint radar_group = 64u;

// A hit: its facet, and whether the receiver is seen from there, and over the first surface (the host says so); radar_none:
// nothing is met.
const uint radar_none = 0xffffffffu;
const uint radar_sees_receiver = 0x80000000u;
const uint radar_sees_over = 0x40000000u;
const uint radar_facet_mask = 0x3fffffffu;

struct EchoConstants {
  vec3 source;
  vec3 receiver;
  uint rays;
  uint max_bounces;
  uint source_body;    // that rays pass through; ~0: none
  uint receiver_body;  // that does not hide the receiver; ~0: none
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::EchoConstants) == 40);
#endif
#endif
