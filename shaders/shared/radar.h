// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The rays of a radar. rf/radar/echoes/echo_pass.cpp and shaders/radar/echoes.comp.glsl share these
// definitions.
#ifndef GREATX_SHADERS_SHARED_RADAR_H
#define GREATX_SHADERS_SHARED_RADAR_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint radar_directions_binding = first_pass_binding;  // vec3[rays], unit, local axes
// uint[max_bounces * rays + 1]: the rays of a bounce stand side by side. The last uint says whether the
// source itself sees the receiver.
const uint radar_hits_binding = first_pass_binding + 1u;
const uint radar_group = 64u;

// A hit consists of its facet, a flag that the facet sees the receiver, and a flag that it sees the receiver
// over the first surface (which the host sets). radar_none means that the ray hits nothing.
const uint radar_none = 0xffffffffu;
const uint radar_sees_receiver = 0x80000000u;
const uint radar_sees_over = 0x40000000u;
const uint radar_facet_mask = 0x3fffffffu;

struct EchoConstants {
  vec3 source;
  vec3 receiver;
  uint rays;
  uint max_bounces;
  uint source_body;    // rays pass through it; ~0: none
  uint receiver_body;  // it does not hide the receiver; ~0: none
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::EchoConstants) == 40);
#endif
#endif
