// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/sensing/azimuth_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "rf/radar/signal/maps.h"

namespace greatx::rf {
namespace {

/// Places nearer to each other than this count as one: their phases differ by less than 1e-5 rad.
constexpr double same_place_wavelengths = 1e-6;

}  // namespace

AzimuthMap::Layout AzimuthMap::layout_of(const RadarSignalConfig& signal) {
  const double same_m = same_place_wavelengths * signal.waveform.wavelength_m();
  Layout layout;
  for (const dvec3& receive : signal.arrays.receive_m)
    for (uint32_t t = 0; t < signal.waveform.transmitters; ++t) {
      BeamPlace place{receive, signal.bistatic ? t : 0};
      if (!signal.bistatic) place.at_m += signal.arrays.transmit_m[t];
      place.at_m.z = 0.0;  // no beam at elevation 0 depends on it
      const auto found = std::ranges::find_if(layout.places, [&](const BeamPlace& p) {
        return p.beam == place.beam && glm::distance(p.at_m, place.at_m) < same_m;
      });
      layout.place_of_pair.push_back(static_cast<uint32_t>(found - layout.places.begin()));
      if (found == layout.places.end()) layout.places.push_back(place);
    }
  return layout;
}

AzimuthMap::AzimuthMap(const RadarSignalConfig& signal, uint32_t transmit_polarizations,
                       uint32_t receive_polarizations, const Window& doppler)
    : AzimuthMap(signal, layout_of(signal), transmit_polarizations, receive_polarizations, doppler) {}

AzimuthMap::AzimuthMap(const RadarSignalConfig& signal, Layout layout, uint32_t transmit_polarizations,
                       uint32_t receive_polarizations, const Window& doppler)
    : transmitters_(signal.waveform.transmitters),
      transmit_polarizations_(transmit_polarizations),
      receive_polarizations_(receive_polarizations),
      velocities_(doppler.size()),
      place_of_pair_(std::move(layout.place_of_pair)),
      beams_(layout.places, signal.waveform.wavelength_m(), radar_axes(signal).azimuth) {
  const double beams = signal.bistatic ? transmitters_ : 1, each = double(place_of_pair_.size()) / beams;
  scale_ = 1.0 /
           (each * each * beams * transmit_polarizations * receive_polarizations * doppler.noise_bandwidth());
}

std::vector<float> AzimuthMap::of(std::span<const std::complex<float>> spectrum, uint32_t ranges,
                                  uint32_t threads) const {
  const size_t plane = size_t{ranges} * velocities_, azimuths = beams_.azimuths();
  const size_t tx_ports = size_t{transmitters_} * transmit_polarizations_;
  GREATX_CHECK(
      spectrum.size() == place_of_pair_.size() * transmit_polarizations_ * receive_polarizations_ * plane,
      "{} values of the spectrum", spectrum.size());
  const uint32_t padded = (velocities_ + AzimuthBeams::lanes - 1) / AzimuthBeams::lanes * AzimuthBeams::lanes;
  std::vector<float> map(ranges * azimuths, 0.0f);
  parallel_for(ranges, threads, [&](size_t range) {
    std::vector<float> re(beams_.places() * padded), im(re.size());
    float* const out = map.data() + range * azimuths;
    for (uint32_t q = 0; q < receive_polarizations_; ++q)
      for (uint32_t p = 0; p < transmit_polarizations_; ++p) {
        std::ranges::fill(re, 0.0f), std::ranges::fill(im, 0.0f);
        for (size_t pair = 0; pair < place_of_pair_.size(); ++pair) {
          const size_t r = pair / transmitters_ * receive_polarizations_ + q,
                       t = pair % transmitters_ * transmit_polarizations_ + p;
          const std::complex<float>* row = spectrum.data() + (r * tx_ports + t) * plane + range * velocities_;
          float* const sum_re = re.data() + size_t{place_of_pair_[pair]} * padded;
          float* const sum_im = im.data() + size_t{place_of_pair_[pair]} * padded;
          for (uint32_t k = 0; k < velocities_; ++k) sum_re[k] += row[k].real(), sum_im[k] += row[k].imag();
        }
        beams_.add_powers(re.data(), im.data(), padded, out);
      }
    // Rounding errors may make a sum negative.
    for (size_t k = 0; k < azimuths; ++k) out[k] = std::max(out[k], 0.0f) * static_cast<float>(scale_);
  });
  return map;
}

}  // namespace greatx::rf
