// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures the radar cross-section of a body as a measurement on a turntable does: a radar at a stated range
// and height, one azimuth after the other, and the mean power over a band of frequencies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rf/radar/echoes/echo_finder.h"
#include "scene/description/scene.h"
#include "scene/device/gpu_scene.h"

namespace greatx::rf::testing {

/// Where a body is measured from, and how. The radar looks at the point `aim_z_m` above the origin.
struct Turntable {
  double carrier_hz = 77e9, band_hz = 1e9;
  double range_m = 30.0, height_m = 0.6, aim_z_m = 0.7;
  double half_m = 3.0;     ///< of the square about the body that has tubes
  double tube_m = 0.25;    ///< width of a tube at the body
  double square_m = 0.05;  ///< side of the squares with one scatterer each
  bool edges = true, diffuse = true, transmission = true;
  uint32_t max_bounces = 3;
};

/// A radar cross-section, m^2, and those of its parts alone: the echoes of the first and of more bounces, and
/// the scatterers of rough surfaces.
struct BodySection {
  double all = 0.0, first = 0.0, more = 0.0, scattered = 0.0;
};

class TurntableRadar {
 public:
  TurntableRadar(scene::Scene scene, const Turntable& table);
  /// Returns the cross-section, a mean over the band, from an azimuth: 0 is ahead of a body that faces +x.
  BodySection at(double azimuth_rad);
  /// Returns those of `count` azimuths, all around.
  std::vector<BodySection> around(int count);
  const scene::Scene& scene() const { return scene_; }

 private:
  EchoList list_at(double azimuth_rad);

  Turntable table_;
  scene::Scene scene_;
  scene::GpuScene gpu_;
  RadioSurfaces surfaces_;
  std::optional<EchoFinder> finder_;
};

/// Returns a vehicle or a person of the generator alone, its parts at rest.
scene::Scene generated_body(const std::string& kind, const std::string& variant, uint64_t seed = 1);

/// Returns the mean, the median and the largest of BodySection::all, dBsm.
struct SectionFigures {
  double mean = 0.0, median = 0.0, largest = 0.0;
};
SectionFigures figures_of(const std::vector<BodySection>& sections);

}  // namespace greatx::rf::testing
