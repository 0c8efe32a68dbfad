// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a picture of paths is taken from. No device: what is visible from there is asked of a function.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "draw/paths/facts.h"
#include "renderer/lens/lens.h"

namespace greatx::apps {

/// A camera in local coordinates (world - origin); pixel centres at (i + 0.5, j + 0.5), row 0 on top.
struct PictureView {
  Pose local_from_sensor;  ///< x forward, y left, z up
  uint32_t width = 1600, height = 1000;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< pixels
  double near_m = 0.5;
  render::Distortion distortion;  ///< set_lens() sets it
  render::LensBounds sees;  ///< of a lens that distorts: beyond it the model may fold back into the picture

  /// Column and row in pixels, and planar depth in metres; behind the camera, or beyond what a lens that
  /// distorts sees, the depth is negative and the rest means nothing.
  dvec3 project(const dvec3& local) const;
  /// The same as a pinhole would show it: there what is straight in space is straight, and 1 / depth is
  /// linear.
  dvec3 project_straight(const dvec3& local) const;
  /// Where the picture shows a point of the pinhole's picture that the lens sees.
  dvec2 bent(const dvec2& straight) const;
  /// The same view with another number of pixels.
  PictureView scaled(uint32_t new_width) const;
  /// Puts a lens on, whose size and intrinsics are the view's. Throws UserError naming it if the picture
  /// folds.
  void set_lens(const render::Distortion& lens, const std::string& name);
};

/// Pixels at the picture's edges that stay free of paths.
struct PictureMargins {
  double left = 60.0, right = 60.0, top = 60.0, bottom = 60.0;
};

/// The nearest view from a direction that has every point inside its margins: `azimuth` from x towards y and
/// `elevation` above the horizon say where the camera stands, seen from the points. The four planes through
/// the margins touch the points: closed form. Points closer together than `least_extent_m` are shown as if
/// they were that far apart.
PictureView fit_view(std::span<const dvec3> points, double azimuth, double elevation, uint32_t width,
                     uint32_t height, const PictureMargins& margins, double least_extent_m = 10.0);

/// Which part of the way along each path is in sight: the share of a view's length, by gain; 0 to 1.
/// `depth` [height, width] planar metres, +inf: sky. Length is measured in the picture.
double visible_share(const PictureView& view, std::span<const float> depth, std::span<const PathLink> links,
                     const PathScene& scene);

/// The best of a ring of oblique views from above: most of the paths in sight, large in the picture.
/// `depth_of` renders the planar depth of a view. Ties go to the first direction, so that the answer is
/// always the same.
PictureView choose_view(std::span<const PathLink> links, const PathScene& scene, uint32_t width,
                        uint32_t height,
                        const std::function<std::vector<float>(const PictureView&)>& depth_of);

/// Is a point at planar depth `point_m` hidden where the picture's surface is at `surface_m`? Points on the
/// surface are not: 0.5 % of the depth + 0.2 m.
inline bool is_hidden(double point_m, float surface_m) {
  return point_m > static_cast<double>(surface_m) * 1.005 + 0.2;
}

}  // namespace greatx::apps
