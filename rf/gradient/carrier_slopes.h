// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "rf/atmosphere/path_attenuation.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// Holds how the parts of a FieldModel that follow models over frequency change with the carrier.
struct CarrierSlopes {
  /// d eta/df of the layers of a material and of its windows, 1/Hz, in the order of RadioMaterial.
  struct Layers {
    std::vector<Complex> wall, windows;
    double scattering = 0.0;  ///< of the scattering coefficient at the carrier
  };
  std::vector<Layers> materials;  ///< [materials of the scene]; empty where the material has no radio wall
  /// The attenuation at the carrier; the first slope is that by the carrier.
  PathAttenuationOf<Dual> attenuation;
};

/// Returns the slopes at `carrier_hz` of the materials' rows (P.2040-4, eq. 28 and 29: eta' = a f^b, eta'' =
/// c f^d/(2 pi f eps_0)) and of gas, rain and fog. `effects` are those of the model. Throws UserError as
/// RadioSurfaces and path_attenuation() do.
CarrierSlopes carrier_slopes(const scene::Scene& scene, const Weather& weather, const WeatherEffects& effects,
                             double carrier_hz);

}  // namespace greatx::rf
