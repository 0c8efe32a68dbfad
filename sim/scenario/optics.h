// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the part of a scenario about light, weather and the sensors that see light.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "core/vec.h"
#include "renderer/lens/lens.h"

namespace greatx::sim {

/// Holds the place of the scene's origin on the Earth, and the time. Sun and moon follow from them
/// (renderer/daylight/almanac.h).
struct PlaceAndTime {
  double latitude = 0.0, longitude = 0.0;  ///< rad, north and east positive (WGS 84)
  double height_m = 0.0;                   ///< above the sea
  std::string time;                        ///< RFC 3339 as written, "2026-06-21T12:00:00+02:00"
  double unix_s = 0.0;                     ///< the same instant, UTC seconds since 1970
  bool of_scene = false;                   ///< whether the place is that of the scene's georeference
};

/// Describes the moon, if it does not follow from place and time.
struct MoonConfig {
  double azimuth = 0.0, elevation = 0.0;  ///< rad, as the sun's
  std::optional<double> phase_angle;      ///< rad, 0 full, pi new; none: from the angle between sun and moon
  std::optional<double> illuminance_lux;  ///< on a surface facing the moon; none: from phase and elevation
};

/// Names the state of the sky above the scene.
enum class SkyKind { automatic, clear, overcast };

/// Names the land that pictures show beyond the scene.
enum class Horizon { automatic, none, plain, city, country };

/// Describes the light from outside and the air between. sim/plan/light_plan.h derives the rest from it.
struct Environment {
  std::optional<PlaceAndTime> place;  ///< given instead of the positions below
  double sun_azimuth = -0.25 * pi;    ///< rad, from x (east) towards y (north): the direction to the sun
  double sun_elevation = 0.25 * pi;   ///< rad above the horizon
  std::optional<double> sun_illuminance_lux;  ///< on a surface facing the sun
  std::optional<MoonConfig> moon;
  std::optional<double> moon_illuminance_lux;  ///< with a place: replaces the model's value
  std::optional<double> sky_illuminance_lux;   ///< on the ground from the sky alone
  SkyKind sky = SkyKind::automatic;  ///< automatic: overcast where it rains, unless the sun's light is given
  double sky_glow_cd_m2 = 0.0;       ///< luminance of city light in the night sky, at the zenith
  double turbidity = 2.0;            ///< turbidity of a clear sky, 1.1 (purest air) to 10
  std::optional<double> clouds;      ///< share of a clear sky's area under clouds; none: fair weather's
  Horizon horizon = Horizon::automatic;  ///< automatic: by the scene
  double temperature_k = 288.15;
  double pressure_hpa = 1013.25;  ///< dry-air pressure (ITU-R P.676)
  double water_vapour_g_m3 = 7.5;
  double rain_mm_h = 0.0;
  double fog_g_m3 = 0.0;          ///< liquid water
  double fog_height_m = 100.0;    ///< height of fog and rain above the scene, for light from above
  std::optional<double> wetness;  ///< of surfaces under the sky: 0 dry, 1 soaked; none: from the rain
  std::optional<double> puddles;  ///< share of level ground under water; none: from the wetness
  double snow = 0.0;              ///< share of what faces upwards under the sky that snow covers
};

/// These types describe a lens (docs/film.md).
using render::ChromaticAberration, render::Distortion, render::LensDrops, render::LensModel,
    render::RollingShutter, render::Vignetting, render::WideLens;

/// Describes the exposure of a picture. `automatic` meters each picture by itself, so that no picture depends
/// on another.
struct Exposure {
  bool automatic = false;
  double ev100 = 15.0;           ///< EV at ISO 100; ignored if `automatic`
  double compensation_ev = 0.0;  ///< if `automatic`: positive is brighter
  /// Exposure time. Objects that move meanwhile are blurred if `motion_blur_samples` > 0.
  std::optional<double> shutter_s;
};

/// Describes the noise of a sensor of light: electrons and digital numbers.
struct SensorNoise {
  double full_well_e = 10000.0;  ///< electrons that saturate the sensor at the exposure's L_max
  double read_noise_e = 2.5;     ///< rms
  uint32_t bits = 12;            ///< resolution of the converter
};

/// Holds the intrinsics that cameras and event cameras share, in pixels.
struct PinholeConfig {
  uint32_t width = 640, height = 480;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< from `fov_deg` (horizontal) if it is given
  double near_m = 0.1;
  uint32_t msaa = 1;         ///< samples per pixel of the colour: 1 or 4
  bool smooth_edges = true;  ///< with one sample: outlines are blended by their share of the pixel
  Distortion distortion;
  WideLens wide;  ///< instead of `distortion`; never of an event camera
};

struct CameraConfig : PinholeConfig {
  Exposure exposure;
  uint32_t motion_blur_samples = 0;  ///< instants within the shutter time, an odd number; 0: sharp
  Vignetting vignetting;
  std::optional<SensorNoise> noise;
  RollingShutter rolling;
  ChromaticAberration chromatic;
  double glare = 0.0;  ///< share of the light that the lens scatters over the picture
  LensDrops drops;
  // The members below select the arrays to deliver.
  bool rgb = true, depth = true, ids = true;
  bool listed = false;    ///< whether the scenario lists the outputs; otherwise they are the default ones
  bool depth_exr = true;  ///< `depth` as EXR; otherwise as an array of NumPy or HDF5
  bool hdr = false;       ///< the linear radiance as EXR
  bool depth_png24 = true, depth_log = false;
  bool depth_ray = false;  ///< distance along the ray
  bool normals = false, flow = false, boxes = false;
  /// Semantic classes that get boxes. Empty: everything but ground and buildings.
  std::vector<std::string> box_classes;
  bool see_own_body = false;
};

/// Describes an event camera (docs/events.md), which measures changes of brightness instead of pictures.
struct EventCameraConfig : PinholeConfig {
  /// The name of the camera of the same node that has the same pixels, as in a DAVIS sensor. At its samples
  /// the pictures are that camera's, and PinholeConfig, mount and see_own_body are too. Empty: none.
  std::string camera;
  uint32_t substeps = 4;  ///< pictures per interval between two samples; adaptive: at most
  enum class Steps { fixed, by_flow, by_brightness, by_pixel } steps = Steps::fixed;
  uint32_t instants = 256;  ///< for by_pixel: the most instants of a pixel between two pictures
  /// For by_flow the most motion from one picture to the next, for by_pixel that from one instant of a pixel
  /// to its next.
  double max_flow_px = 0.5;
  double max_change = 0.5;  ///< for by_brightness: the most change of the logarithm over the threshold
  double threshold_on = 0.2, threshold_off = 0.2;  ///< change of the natural logarithm
  double threshold_sigma = 0.0;                    ///< mismatch from pixel to pixel, standard deviation
  double refractory_s = 0.0;
  double leak_rate_hz = 0.0, shot_rate_hz = 0.0;
  double cutoff_hz = 0.0;             ///< bandwidth of the photoreceptor in bright light; 0: unlimited
  double dark_cd_m2 = 1e-3;           ///< epsilon of log(epsilon + luminance)
  double bright_cd_m2 = 1000.0;       ///< the luminance at which bandwidth is full and shot noise least
  uint32_t max_events_per_pixel = 0;  ///< average size of the buffer per interval; 0: chosen
  bool events = true, differences = false, instance = false;  ///< the outputs to deliver
  bool hdf5 = false, text = false;                            ///< also write DSEC's HDF5, v2e's text
  double difference_on = 0.1, difference_off = 0.1;  ///< thresholds of the difference image, over L_max
  double difference_ev100 = 15.0;                    ///< the exposure of that L_max
  bool see_own_body = false;
};

}  // namespace greatx::sim
