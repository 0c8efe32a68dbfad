// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses the viewpoint of a picture of paths. The code needs no device; a function that the caller passes
// renders the depth of a view.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "draw/paths/facts.h"
#include "renderer/lens/lens.h"

namespace greatx::apps {

/// Describes a camera in local coordinates (world - origin). Pixel centres are at (i + 0.5, j + 0.5); row 0
/// is the top row.
struct PictureView {
  Pose local_from_sensor;  ///< x forward, y left, z up
  uint32_t width = 1600, height = 1000;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< pixels
  double near_m = 0.5;                            ///< planar depth of the near plane
  render::Distortion distortion;                  ///< from set_lens()
  /// The part of the pinhole picture that a lens with distortion sees. Beyond it, the model may fold back
  /// into the picture.
  render::LensBounds sees;

  /// Returns the column and row in pixels, and the planar depth in metres. If the point is behind the camera
  /// or outside `sees` of a lens with distortion, the depth is negative and the other values have no meaning.
  dvec3 project(const dvec3& local) const;
  /// Returns the same for a pinhole camera without distortion. In its picture, lines that are straight in
  /// space are straight, and 1 / depth is linear along them.
  dvec3 project_straight(const dvec3& local) const;
  /// Maps a point of the pinhole picture, within `sees`, to the distorted picture.
  dvec2 bent(const dvec2& straight) const;
  /// Returns the same view with a width of `new_width` pixels.
  PictureView scaled(uint32_t new_width) const;
  /// Sets the distortion, for the size and intrinsics of the view. Throws UserError, which begins with
  /// `name`, if the distorted picture folds.
  void set_lens(const render::Distortion& lens, const std::string& name);
};

/// Margins of the picture that stay free of paths, pixels.
struct PictureMargins {
  double left = 60.0, right = 60.0, top = 60.0, bottom = 60.0;
};

/// Returns the nearest view from a direction that shows all points inside the margins. `azimuth` (from x
/// towards y) and `elevation` (above the horizon) are the direction from the points to the camera, radians.
/// The solution is in closed form: the four planes through the margins touch the points. Each point counts as
/// a square with sides of `least_extent_m` that faces the camera, so that points close together do not bring
/// the camera too near.
PictureView fit_view(std::span<const dvec3> points, double azimuth, double elevation, uint32_t width,
                     uint32_t height, const PictureMargins& margins, double least_extent_m = 10.0);

/// Returns the visible fraction, 0 to 1, of the length of all paths. Lengths are measured in the picture, and
/// each path is weighted by the square root of its gain. `depth` [height, width] is the planar depth in
/// metres, +inf for sky.
double visible_share(const PictureView& view, std::span<const float> depth, std::span<const PathLink> links,
                     const PathScene& scene);

/// Returns the best of a set of oblique views from above, 16 azimuths at each of three elevations: it shows
/// most of the paths, and shows them large. `depth_of` renders the planar depth of a view. Of equal views the
/// first is taken, so that the result is always the same.
PictureView choose_view(std::span<const PathLink> links, const PathScene& scene, uint32_t width,
                        uint32_t height,
                        const std::function<std::vector<float>(const PictureView&)>& depth_of);

/// Returns true if a point at planar depth `point_m` is hidden by the visible surface at depth `surface_m`.
/// The tolerance of 0.5 % of the depth + 0.2 m keeps points on the surface visible.
inline bool is_hidden(double point_m, float surface_m) {
  return point_m > static_cast<double>(surface_m) * 1.005 + 0.2;
}

}  // namespace greatx::apps
