// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws drops of rain on the plane glass before a lens: spherical caps of water that refract. Their volumes
// are those of falling drops. They appear, stay, and run down the glass while they lose their water. What a
// drop shows is the picture itself, at an eighth of its size; beyond the rim the rim goes on.
#pragma once

#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "shaders/shared/lens_drops.h"

namespace greatx::render {

/// A drop on the glass: its base is a disc.
struct GlassDrop {
  dvec2 middle{0.0};  ///< m, to the right and downwards from the camera's axis
  double radius = 0.0;
};

/// Returns the radius of the base of a cap that has the volume of a ball of diameter `diameter_m`.
double cap_radius(double diameter_m, double contact_rad);

/// The diameters, m, of the drops that fall onto a surface: their number in the air (J. S. Marshall and W.
/// Mc K. Palmer, 1948) times their speed 9.65 - 10.3 exp(-0.6 D) m/s, D in mm (D. Atlas, R. C. Srivastava
/// and R. S. Sekhon, Rev. Geophys. 11 (1973)), from 0.5 to 5 mm.
class FallenDrops {
 public:
  explicit FallenDrops(double rain_mm_h);
  double diameter(double share) const;  ///< below which this share of the drops lies, from 0 to 1
  double mean_square() const { return mean_square_; }

 private:
  std::vector<double> shares_;  ///< [bins + 1], of the drops up to each diameter
  double mean_square_ = 0.0;    ///< of the diameters, m^2
};

/// Returns the drops that may lie between two corners of the glass at a time. The bases cover
/// `drops.coverage` of the glass in the mean, those that overlap counted twice. Everything depends on (seed,
/// stream, sequence, time) alone, and a drop keeps its place in all pictures.
std::vector<GlassDrop> drops_on_glass(const LensDrops& drops, const FallenDrops& fallen,
                                      const RainView& numbers, uint32_t sequence, double time_s,
                                      const dvec2& low, const dvec2& high);

class LensDropPass {
 public:
  LensDropPass(const SceneLighting& lighting, const CameraDesc& desc);
  /// Records drops into `color`, the stored radiance of the picture.
  void record(gpu::TickSlot& slot, const gpu::Buffer& color, const FrameNumber& frame);

 private:
  /// Returns the words of the shader.
  std::vector<uint32_t> words_of(std::vector<GlassDrop> drops) const;

  LensDrops drops_;
  RainView numbers_;
  double seconds_per_tick_;
  FallenDrops fallen_;
  std::string scope_;
  gpu::ComputePipeline pipeline_;
  gpu::Buffer small_;
  shared::DropConstants constants_{};
};

}  // namespace greatx::render
