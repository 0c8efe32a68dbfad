// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the vertex stage hands to the fragment stage, and the effects as specialization constants.
#ifndef GREATX_CAMERA_SURFACE_INTERFACE_GLSL
#define GREATX_CAMERA_SURFACE_INTERFACE_GLSL
#include "lib/scene.glsl"
#include "shared/camera.h"

layout(constant_id = spec_sun) const bool sun_on = true;
layout(constant_id = spec_sky) const bool sky_on = true;
layout(constant_id = spec_static_shadows) const bool static_shadows_on = true;
layout(constant_id = spec_moving_shadows) const bool moving_shadows_on = true;
layout(constant_id = spec_textures) const bool textures_on = true;
layout(constant_id = spec_normal_maps) const bool normal_maps_on = true;
layout(constant_id = spec_alpha_mask) const bool alpha_mask_on = true;
layout(constant_id = spec_emissive) const bool emissive_on = true;
layout(constant_id = spec_lights) const bool lights_on = true;
layout(constant_id = spec_specular) const bool specular_on = true;
layout(constant_id = spec_multisampled) const bool multisampled = true;

layout(push_constant, scalar) uniform Constants { CameraConstants camera; };
#endif
