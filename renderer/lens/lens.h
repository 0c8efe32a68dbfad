// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the effects of a lens on directions and on light: distortion (Brown-Conrady) and its inverse, and
// vignetting. The code runs on the host in fp64 and needs no device. docs/film.md has the formulas.
//
// Normalised coordinates are (x, y) = (X/Z, Y/Z) in optical axes. *Undistorted* ones are directions in the
// world, and *distorted* ones are where the picture shows them: pixel = (cx + fx x', cy + fy y').
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"
#include "renderer/lens/wide_lens.h"

namespace greatx::render {

/// Describes Brown-Conrady distortion with the order and signs of OpenCV's calib3d (D. Brown, "Decentering
/// Distortion of Lenses", 1966):
///   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
///   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y,   r^2 = x^2 + y^2.
struct Distortion {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
  bool any() const { return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0; }

  /// Maps undistorted coordinates to distorted ones.
  dvec2 distort(const dvec2& undistorted) const;
  /// Returns the derivatives of distort(): [i][j] = d x'_j / d x_i (GLM's columns).
  glm::dmat2 jacobian(const dvec2& undistorted) const;
  /// Returns the undistorted radius up to which the radial part grows with r: the first root of
  /// 1 + 3 k1 r^2 + 5 k2 r^4 + 7 k3 r^6, or +inf if there is none. Beyond it the picture folds back.
  double fold_radius() const;
};

/// Describes the loss of light towards the rim, as factors of the light that reaches a pixel.
struct Vignetting {
  bool natural = false;  ///< cos^4 of the angle between the pixel's ray and the axis
  /// The factor is 1 + a1 q^2 + a2 q^4 + a3 q^6; q is the distance from the principal point over half of the
  /// picture's diagonal.
  std::array<double, 3> radial{0.0, 0.0, 0.0};
  bool any() const { return natural || radial[0] != 0.0 || radial[1] != 0.0 || radial[2] != 0.0; }
};

/// Describes drops of rain on the glass before a lens (renderer/camera/lens_drops.h).
struct LensDrops {
  double coverage = 0.0;      ///< mean share of the glass under drops; 0: none
  double rain_mm_h = 5.0;     ///< the rain that the drops come from, which gives their sizes
  double glass_m = 0.1;       ///< from the entrance pupil to the glass
  double aperture_m = 0.002;  ///< diameter of the entrance pupil, out of whose focus the drops lie
  double contact_deg = 40.0;  ///< between the glass and the surface of a drop at its rim
  double stay_s = 20.0;       ///< the time from a drop's fall to its end
  bool any() const { return coverage > 0.0; }
};

/// Holds the pixels of a picture, and its lens.
struct LensGeometry {
  std::string name = "camera";  ///< for messages
  uint32_t width = 0, height = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
  Distortion distortion;
  WideLens wide;  ///< instead of `distortion`; renderer/lens/lens_rays.h
};

/// Describes a part of the plane of undistorted normalised coordinates.
struct LensBounds {
  dvec2 least{0.0}, most{0.0};
};

/// Represents a pinhole camera's lens over a whole picture. Every result is exact to `tolerance` in
/// normalised coordinates before it is rounded.
class Lens {
 public:
  /// An inverse counts as found at this step of Newton's iteration.
  static constexpr double tolerance = 1e-12;

  /// Throws UserError naming the camera if some point of the picture, its rim included, has no undistorted
  /// direction that is connected to the axis without a fold (Jacobian's determinant > 0 all along). The
  /// message says up to which radius in pixels the model holds.
  explicit Lens(const LensGeometry& geometry);

  const LensGeometry& geometry() const { return geometry_; }
  /// Returns the undistorted coordinates of pixel coordinates (a pixel's centre is at + 0.5) within the
  /// picture.
  dvec2 undistorted(const dvec2& pixel) const;
  /// Returns the place where the picture shows a direction. Only within bounds() is it certain that nothing
  /// folds.
  dvec2 pixel(const dvec2& undistorted) const;
  /// Returns the bounds of the view of the whole picture, rim included. A pinhole picture over this rectangle
  /// covers it.
  const LensBounds& bounds() const { return bounds_; }
  /// Returns [height, width] undistorted coordinates of the pixels' centres.
  std::vector<dvec2> centers() const;
  /// Returns the same in pixels of a pinhole picture with the given focal lengths and principal point.
  std::vector<dvec2> centers(const dvec2& focal, const dvec2& principal) const;

 private:
  dvec2 inverse(const dvec2& distorted) const;
  dvec2 normalised(const dvec2& pixel) const;
  void find_bounds();

  LensGeometry geometry_;
  LensBounds bounds_;
};

/// Returns [height, width] the share of the light that reaches each pixel's centre (a flat field), (0, 1].
/// Throws UserError naming the camera if a factor is not positive or beyond 1.
std::vector<float> flat_field(const Vignetting& vignetting, const LensGeometry& geometry);

}  // namespace greatx::render
