// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The effects of the plan are specialization constants of the shading pipeline.
#ifndef GREATX_CAMERA_EFFECTS_GLSL
#define GREATX_CAMERA_EFFECTS_GLSL
#include "shared/camera.h"

layout(constant_id = spec_color) const bool color_on = true;
layout(constant_id = spec_ids) const bool ids_on = true;
layout(constant_id = spec_sun) const bool sun_on = true;
layout(constant_id = spec_sky) const bool sky_on = true;
layout(constant_id = spec_static_shadows) const bool static_shadows_on = true;
layout(constant_id = spec_moving_shadows) const bool moving_shadows_on = true;
layout(constant_id = spec_shadow_cascades) const uint shadow_cascades = 0u;
layout(constant_id = spec_pane_shadows) const bool pane_shadows_on = false;
layout(constant_id = spec_textures) const bool textures_on = true;
layout(constant_id = spec_normal_maps) const bool normal_maps_on = true;
layout(constant_id = spec_emissive) const bool emissive_on = true;
layout(constant_id = spec_switched_lamps) const bool switched_lamps_on = false;
layout(constant_id = spec_lights) const bool lights_on = true;
layout(constant_id = spec_luminance) const bool luminance_on = true;
layout(constant_id = spec_specular) const bool specular_on = true;
layout(constant_id = spec_haze) const bool haze_on = false;
layout(constant_id = spec_night_sky) const bool night_sky_on = false;
layout(constant_id = spec_ambient_occlusion) const bool ambient_occlusion_on = false;
layout(constant_id = spec_markings) const bool markings_on = false;
layout(constant_id = spec_thin_lines) const bool lines_on = false;
layout(constant_id = spec_clouds) const bool clouds_on = false;
layout(constant_id = spec_horizon) const uint horizon_kind = 0u;
layout(constant_id = spec_wet_surfaces) const bool wet_on = false;
layout(constant_id = spec_snow_cover) const bool snow_on = false;
layout(constant_id = spec_mirrors) const bool mirrors_on = false;
layout(constant_id = spec_lamp_shadows) const bool lamp_shadows_on = false;
layout(constant_id = spec_beam_shadows) const bool beam_shadows_on = false;
layout(constant_id = spec_lamp_halos) const bool lamp_halos_on = false;
layout(constant_id = spec_beams) const bool beams_on = false;
layout(constant_id = spec_contact_occlusion) const bool contact_occlusion_on = false;
layout(constant_id = spec_bounced_light) const bool bounced_light_on = false;
layout(constant_id = spec_glass) const bool glass_on = false;
layout(constant_id = spec_panes) const bool panes_on = false;
layout(constant_id = spec_distortion) const bool distortion_on = false;
layout(constant_id = spec_faces) const bool faces_on = false;
layout(constant_id = spec_range) const bool range_on = false;
layout(constant_id = spec_band_rows) const uint band_rows = 0u;
layout(constant_id = spec_blend) const bool blend_on = false;
layout(constant_id = spec_base_color_arrays) const uint base_color_arrays = 0u;
layout(constant_id = spec_metallic_roughness_arrays) const uint metallic_roughness_arrays = 0u;
layout(constant_id = spec_normal_arrays) const uint normal_arrays = 0u;
layout(constant_id = spec_emissive_arrays) const uint emissive_arrays = 0u;
#endif
