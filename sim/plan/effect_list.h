// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Declares every effect once. The members of EffectPlan, their names under `effects:`, their order and
// docs/effects.md follow from these rows (tests/apps/check_docs_effects.py --write makes the page).
//
//   X(name, switchable, passed, documentation)
//
// switchable: whether a scenario may switch the effect. An effect that it may not switch follows from the
// sensors.
// passed: the struct of switches with a member of the same name, which is set from the plan: `camera`
// (render::CameraEffects), `radio` (rf::RadioEffects), `field` (rf::FieldEffects), or `none`.
#pragma once

// clang-format off
#define GREATX_RAY_EFFECTS(X) \
  X(acceleration_structure, false, none, "structures over the scene through which rays are traced") \
  X(scene_motion, false, none, "these structures follow the meshes that move")

#define GREATX_CAMERA_EFFECTS(X) \
  X(camera, false, none, "cameras and event cameras") \
  X(rgb, false, none, "developed pictures") \
  X(depth, false, none, "planar depth") \
  X(ids, false, none, "numbers of instance, class and material of each pixel") \
  X(hdr, false, none, "radiance before development") \
  X(depth_ray, false, none, "distance along the ray of each pixel") \
  X(normals, false, none, "normals of the surfaces that pixels see") \
  X(flow, false, none, "motion of each pixel to the next picture") \
  X(boxes, false, none, "boxes around the instances in a picture") \
  X(event_camera, false, none, "event cameras") \
  X(adaptive_steps, false, none, "sub-steps of event cameras as fine as the picture changes") \
  X(sun, true, camera, "direct light of the sun or the moon") \
  X(sky, true, camera, "light of the sky") \
  X(static_shadows, true, camera, "shadows of static meshes in that direct light") \
  X(moving_shadows, true, camera, "shadows of meshes that move in that direct light") \
  X(shadow_cascades, true, camera, "finer maps of the shadows of static meshes around each camera") \
  X(ambient_occlusion, true, camera, "the share of the sky that each place sees") \
  X(contact_occlusion, true, camera, "light of the sky that meshes hide which move near a place") \
  X(bounced_light, true, camera, "light that the static world reflects once") \
  X(glass, true, camera, "the static world mirrored in smooth surfaces") \
  X(panes, true, camera, "objects behind panes of glass are seen through them") \
  X(textures, true, camera, "textures of materials") \
  X(normal_maps, true, camera, "relief of surfaces from textures") \
  X(alpha_mask, true, camera, "holes in materials") \
  X(emissive, true, camera, "materials that glow") \
  X(switched_lamps, true, camera, "signals, stop lamps and direction indicators that switch") \
  X(punctual_lights, true, camera, "lamps") \
  X(haze, true, camera, "fog and rain before the camera") \
  X(night_sky, true, camera, "stars and the disc of the moon") \
  X(clouds, true, camera, "clouds in the sky, in its light and in its mirror images") \
  X(horizon, true, camera, "the land beyond the scene, as a background of pictures") \
  X(markings, true, camera, "far markings of roads keep their share of each pixel") \
  X(thin_lines, true, camera, "poles and wires narrower than pixels keep their share of each") \
  X(wet_surfaces, true, camera, "water on surfaces: dark, smooth ground, puddles, mirror images") \
  X(snow_cover, true, camera, "snow on what faces upwards") \
  X(rain_streaks, true, camera, "falling drops as streaks") \
  X(lamp_shadows, true, camera, "shadows in the light of lamps") \
  X(lamp_halos, true, camera, "light of lamps that fog and rain scatter towards the camera") \
  X(smooth_edges, false, none, "antialiasing along the edges of meshes") \
  X(lens_distortion, false, none, "distortion by the lens") \
  X(wide_lens, false, none, "fisheye and equirectangular lenses") \
  X(rolling_shutter, false, none, "rows of a picture exposed one after the other") \
  X(chromatic_aberration, false, none, "red and blue pictures that differ in size from the green one") \
  X(vignetting, false, none, "loss of light towards the corners of a picture") \
  X(lens_drops, false, none, "drops of rain on the glass before a lens") \
  X(glare, false, none, "light that the lens scatters over the picture") \
  X(motion_blur, false, none, "motion during the exposure") \
  X(auto_exposure, false, none, "exposure that follows the light of the scene") \
  X(sensor_noise, false, none, "noise of photons and of the sensor")

#define GREATX_LIDAR_EFFECTS(X) \
  X(lidar, false, none, "LiDARs") \
  X(lidar_alpha_mask, true, none, "shots pass through holes in materials") \
  X(lidar_textures, true, none, "reflectance from textures") \
  X(lidar_sweep_motion, true, none, "each shot starts from the pose at its own time") \
  X(lidar_target_motion, true, none, "each shot meets moving meshes where they are at its own time") \
  X(lidar_divergence, true, none, "sub-rays over the cross-section of the beam") \
  X(lidar_glass, true, none, "panes let a part of the light through") \
  X(lidar_haze, true, none, "attenuation by fog and rain") \
  X(lidar_backscatter, true, none, "light that drops of fog and rain send back") \
  X(lidar_detection, true, none, "returns have to exceed a threshold") \
  X(lidar_range_noise, true, none, "noise of ranges")

#define GREATX_RADAR_EFFECTS(X) \
  X(radar, false, none, "radars") \
  X(radar_roughness, true, none, "roughness of materials weakens echoes") \
  X(radar_clutter, true, none, "what rough surfaces and foliage send back to radars") \
  X(radar_air, true, none, "attenuation of echoes by gases, rain and fog") \
  X(radar_transmission, true, none, "what stands behind foliage and thin panes sends back") \
  X(radar_edges, true, none, "what edges send back beyond physical optics") \
  X(radar_noise, true, none, "noise of the receiver") \
  X(radar_phase_noise, true, none, "phase noise of the oscillator") \
  X(radar_quantisation, true, none, "steps of the converter") \
  X(radar_leakage, true, none, "what the receiver takes from its transmitters without the scene") \
  X(radar_interference, true, none, "ramps of other radars in the receiver") \
  X(radar_rain, true, none, "what raindrops send back to radars")

#define GREATX_RADIO_EFFECTS(X) \
  X(channel, false, none, "channels") \
  X(line_of_sight, true, radio, "paths without interactions") \
  X(reflection, true, radio, "paths that surfaces reflect") \
  X(moving_reflectors, true, none, "meshes that move reflect, too") \
  X(transmission, true, radio, "paths through walls; off: walls block") \
  X(diffraction, true, radio, "paths into shadows, by UTD at edges") \
  X(diffraction_lit_region, true, radio, "diffracted fields beside lit paths, too") \
  X(corner_diffraction, true, radio, "ends of edges diffract, too") \
  X(free_edges, true, radio, "edges that belong to only one facet diffract, too") \
  X(scattering, true, radio, "diffuse scattering by materials with a scattering coefficient") \
  X(roughness, true, field, "roughness of materials weakens reflections") \
  X(finite_reflectors, true, field, "reflections count what their surfaces cover of the Fresnel zones") \
  X(gas, true, field, "attenuation by oxygen and water vapour") \
  X(rain, true, field, "attenuation by rain") \
  X(fog, true, field, "attenuation by fog") \
  X(foliage, true, field, "attenuation by crowns of trees") \
  X(dispersion, true, none, "materials and air at the frequency of every subcarrier") \
  X(doppler, true, none, "time samples turn with the Doppler shift of each path") \
  X(wave_curvature, true, none, "a wave passes an array as a sphere, not as a plane") \
  X(beam_squint, true, none, "a wave reaches each element of an array at its own delay over the band") \
  X(every_element, true, none, "paths between every two elements of arrays that are near each other") \
  X(target_echoes, true, none, "paths over the targets of a channel") \
  X(sensing, false, none, "range-Doppler maps and detections from a channel's symbols") \
  X(sensing_noise, true, none, "noise of the receiver of a channel that senses") \
  X(sensing_quantisation, true, none, "steps of its converter") \
  X(sensing_leakage, true, none, "what its receiver takes from its transmitter without the scene")

#define GREATX_CHECKS(X) \
  X(consistency, true, none, "the check that all sensors see one world")

#define GREATX_EFFECTS(X) \
  GREATX_RAY_EFFECTS(X) \
  GREATX_CAMERA_EFFECTS(X) \
  GREATX_LIDAR_EFFECTS(X) \
  GREATX_RADAR_EFFECTS(X) \
  GREATX_RADIO_EFFECTS(X) \
  GREATX_CHECKS(X)
// clang-format on
