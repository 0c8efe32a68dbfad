// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Splits a picture into pinhole views that are drawn one after the other. A lens that sees more than a
// pinhole camera can draw looks at the faces of a cube around the eye. A rolling shutter draws bands of rows
// at their own instants. Each pixel looks through one view, along its own ray.
#pragma once

#include <vector>

#include "renderer/camera/camera_view.h"
#include "renderer/lens/lens_rays.h"

namespace greatx::render {

/// Returns whether a camera is drawn through a FaceTable.
inline bool has_faces(const CameraDesc& desc) { return desc.wide.any() || desc.bands > 0; }

/// Returns the rows of each band but the last, a multiple of the height of a group of the shading pass.
uint32_t rows_of_band(const CameraDesc& desc);

/// Holds one view and the pixels that look through it.
struct CameraFace {
  PinholeView pinhole;    ///< no larger than these pixels need
  Pose sensor_from_face;  ///< a turn: x forward, y left, z up
  uint32_t band = 0;
  gpu::Slice pixels;  ///< shared::FacePixel, padded to whole groups
};

/// Holds the views of a picture and the table of their pixels on the device.
class FaceTable {
 public:
  /// Throws UserError naming the camera if the lens has no inverse (LensRays), or if a view would be larger
  /// than the device's largest image.
  FaceTable(gpu::Device& device, const CameraDesc& desc);
  const std::vector<CameraFace>& faces() const { return faces_; }
  /// Returns the size that holds every view.
  PinholeView largest() const;

 private:
  struct Builder;
  std::vector<CameraFace> faces_;
  gpu::Buffer pixels_;
};

}  // namespace greatx::render
