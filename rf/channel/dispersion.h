// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes dispersion, which is an option: walls and air whose properties change over the channel's band.
// Without it every subcarrier has the carrier's properties.
#pragma once

#include <cstdint>
#include <vector>

#include "rf/atmosphere/weather.h"
#include "rf/channel/frequency_response.h"
#include "rf/field/field.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// Computes the field at every subcarrier from permittivities, slab phases, roughness, diffraction, gas,
/// rain, fog and foliage at the subcarrier's own frequency. Each subcarrier is computed exactly. Nothing is
/// interpolated, because a wall of half a metre has a resonance every 120 MHz and a material's row may end
/// within the band. At the carrier's subcarrier the result equals path_field() to the bit.
///
/// Four things keep their value at the carrier: lambda/4 pi and the arrays' phases
/// (rf/channel/frequency_response.h), the Doppler shift, and the random phases of scattering patches. At
/// every frequency, delay and phase in air are those of vacuum.
class Dispersion {
 public:
  /// `carrier`: the field model at the grid's carrier, with facets of `scene`. spectrum() reads the wedges
  /// that it refers to, which must outlive this object. `weather`: the weather that causes the attenuation.
  /// The object keeps one set of surfaces per subcarrier, about 0.25 kB for each material. Throws UserError,
  /// which names the material or the effect, if a frequency of the band is outside its range.
  Dispersion(const scene::Scene& scene, const FieldModel& carrier, const Weather& weather,
             const ChannelGrid& grid);

  /// Return the transfers for frequency_response_into(paths, spectra, ...). The cost is that of path_field()
  /// for each subcarrier. `world` holds the facets as they stood when the paths were solved. Thread-safe.
  TransferSpectrum spectrum(const Path& path, const FacetWorld& world) const;
  std::vector<TransferSpectrum> spectra(std::span<const Path> paths, const FacetWorld& world) const;

 private:
  TransferSpectrum echo_spectrum(const TargetEcho& echo, const FacetWorld& world) const;
  struct Subcarrier {
    RadioSurfaces surfaces;
    PathAttenuation attenuation;
  };
  FieldModel carrier_;
  std::vector<Subcarrier> subcarriers_;
};

}  // namespace greatx::rf
