// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines lenses that see more than a pinhole camera can draw: fisheye (Kannala-Brandt) and equirectangular.
// Also defines two effects of cameras on request: rows exposed one after the other, and colours that differ
// in magnification. docs/film.md has the formulas.
#pragma once

#include <cstdint>

#include "core/units.h"

namespace greatx::render {

/// `pinhole` may have Brown-Conrady distortion (renderer/lens/lens.h).
enum class LensModel : uint32_t { pinhole, fisheye, equirectangular };

/// Describes a lens that is drawn as several pinhole pictures (renderer/camera/faces.h).
///
/// Fisheye (J. Kannala and S. Brandt, "A Generic Camera Model and Calibration Method for Conventional,
/// Wide-Angle, and Fish-Eye Lenses", PAMI 28(8), 2006, with the signs and the order of OpenCV's fisheye). For
/// a direction (X, Y, Z) in optical axes with the angle t from the axis and r = |(X, Y)|:
///   t_d = t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8),   u = cx + fx t_d X / r,   v = cy + fy t_d Y / r.
///
/// Equirectangular: u = cx + fx a and v = cy - fy e, with the azimuth a = atan2(X, Z) from -pi to pi and the
/// elevation e = atan2(-Y, |(X, Z)|). The sphere fills the picture: fx = width / 2 pi, fy = height / pi.
struct WideLens {
  LensModel model = LensModel::pinhole;
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, k4 = 0.0;  ///< fisheye
  /// Fisheye: the angle from the axis, rad, at which the image circle ends.
  double half_angle = radians(110.0);
  /// Whether the image circle was asked for. Otherwise the whole picture has to lie within the model.
  bool circle_given = false;

  bool any() const { return model != LensModel::pinhole; }
  bool fisheye() const { return model == LensModel::fisheye; }
  /// Returns t_d, the distance from the principal point over the focal length, for an angle from the axis.
  double shown(double angle) const;
  double slope(double angle) const;  ///< d t_d / d t
  /// Returns the angle up to which t_d grows, at most pi. Beyond it the picture folds back.
  double fold_angle() const;
  /// Returns the angle from the axis that is shown at `distance` = t_d; NaN beyond the fold. The error is
  /// below 1e-14 rad times the condition of the model.
  double angle(double distance) const;

 private:
  double angle_below(double distance, double fold) const;
  friend class LensRays;
};

/// Describes a shutter that exposes the rows of a picture one after the other, the upper one first. Bands of
/// rows are drawn at the instant of their middle. The tick is the instant of the picture's middle row.
struct RollingShutter {
  double readout_s = 0.0;  ///< from the beginning of the first row to the end of the last; 0: all at once
  uint32_t bands = 16;     ///< the most bands; each is a multiple of 8 rows
  bool any() const { return readout_s > 0.0; }
};

/// Describes lateral chromatic aberration: the factors by which the red and the blue picture are larger than
/// the green one, about the principal point.
struct ChromaticAberration {
  double red = 1.0, blue = 1.0;
  bool any() const { return red != 1.0 || blue != 1.0; }
};

}  // namespace greatx::render
