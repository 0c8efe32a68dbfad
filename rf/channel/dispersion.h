// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Dispersion, an option: walls and air that change over the channel's band. Without it every subcarrier has
// the carrier's.
#pragma once

#include <cstdint>
#include <vector>

#include "rf/atmosphere/weather.h"
#include "rf/channel/frequency_response.h"
#include "rf/field/field.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// The field at every subcarrier: permittivities, the slabs' phases, roughness, diffraction, gas, rain, fog
/// and foliage of its own frequency. Each subcarrier is worked out exactly; nothing is interpolated (a wall
/// of half a metre has a resonance every 120 MHz, and a material's row may end within the band). At the
/// carrier's subcarrier it is what path_field says, to the bit.
///
/// What stays the carrier's: lambda/4 pi and the arrays' phases (rf/channel/frequency_response.h), the
/// Doppler shift, and the random phases of scattering patches. Delay and phase of the air are those of vacuum
/// at every frequency.
class Dispersion {
 public:
  /// `carrier`: the model of the grid's carrier, of facets of `scene`; spectrum() reads the wedges that it
  /// names, which must outlive this. `weather`: its attenuation is of that. One set of surfaces per
  /// subcarrier is kept, some 0.25 kB for each material. Throws UserError naming the material or the effect
  /// that a frequency of the band is outside of.
  Dispersion(const scene::Scene& scene, const FieldModel& carrier, const Weather& weather,
             const ChannelGrid& grid);

  /// For frequency_response(paths, spectra, ...); costs as much as path_field for each subcarrier. `world`:
  /// the facets as they stood when the paths were solved. Thread-safe.
  TransferSpectrum spectrum(const Path& path, const FacetWorld& world) const;
  std::vector<TransferSpectrum> spectra(std::span<const Path> paths, const FacetWorld& world) const;

 private:
  struct Subcarrier {
    RadioSurfaces surfaces;
    PathAttenuation attenuation;
  };
  FieldModel carrier_;
  std::vector<Subcarrier> subcarriers_;
};

}  // namespace greatx::rf
