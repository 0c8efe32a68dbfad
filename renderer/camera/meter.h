// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the automatic exposure. Each picture is metered by itself, so that no picture depends on another
// (docs/film.md).
#pragma once

#include <string>

#include "gpu/cmd.h"
#include "gpu/pipeline.h"
#include "gpu/tick_ring.h"
#include "shaders/shared/film.h"

namespace greatx::render {

struct CameraDesc;

/// Returns the EV100 that a reflected-light meter sets for a mean luminance, cd/m^2: log2(L 100 / K) with
/// K = 12.5 (ISO 2720; Lagarde and de Rousiers, "Moving Frostbite to PBR", SIGGRAPH course 2014, section
/// 5.1).
double metered_ev100(double luminance_cd_m2);

/// Returns the cd/m^2 that a stored radiance of 1 stands for under automatic exposure. It is L_max for grey
/// of 18 % on the ground at this illuminance, at least 1 lux. Halves then hold 2^-14 to 2^16 times that at
/// full precision.
double anchor_luminance(double ground_illuminance_lux);

/// Finds the exposure of a picture from its radiance. It is the mean of log2 of the luminance without the
/// darkest and the brightest twentieth, within EV100 -4 to 20. Pixels of the sky count an eighth, and black
/// ones do not count.
class MeterPass {
 public:
  /// `stored_luminance` is the cd/m^2 of a stored 1.
  MeterPass(gpu::Device& device, const CameraDesc& desc, double stored_luminance);
  /// `color` is PictureBuffers::color; alpha is the fraction of a pixel that shows the scene. The result (a
  /// shared::MeterResult) lies in the slot's readback arena and is ready for compute shaders.
  gpu::Slice record(gpu::TickSlot& slot, const gpu::Buffer& color);

 private:
  gpu::ComputePipeline histogram_, result_;
  gpu::Buffer bins_;  ///< shared::MeterBin [meter_bins]
  shared::MeterConstants constants_{};
  std::string scope_;
};

}  // namespace greatx::render
