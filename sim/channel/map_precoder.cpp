// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/map_precoder.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "core/budget.h"
#include "core/error.h"
#include "core/expected.h"

namespace greatx::sim {

namespace {

constexpr uint32_t most_oversampling = 32;

bool has_beams(MapPrecoding precoding) {
  return precoding == MapPrecoding::beam || precoding == MapPrecoding::best_beam;
}

}  // namespace

MapPrecoding map_precoding(const std::string& name) {
  for (size_t i = 0; i < map_precodings.size(); ++i)
    if (name == map_precodings[i]) return static_cast<MapPrecoding>(i);
  throw_user_error("--precoder: {}", expected_one_of(map_precodings, name));
}

void check_map_precoder(const MapPrecoder& precoder) {
  const char* const name = map_precodings[static_cast<size_t>(precoder.precoding)];
  if (precoder.precoding == MapPrecoding::beam && !precoder.beam)
    throw_user_error("--beam: expected the index of a beam for --precoder beam, found none");
  if (precoder.precoding != MapPrecoding::beam && precoder.beam)
    throw_user_error("--beam: expected --precoder beam beside it, found {}", name);
  if (!precoder.oversampling) return;
  if (!has_beams(precoder.precoding))
    throw_user_error("--oversampling: expected --precoder beam or best_beam beside it, found {}", name);
  for (const uint32_t factor : *precoder.oversampling)
    if (factor < 1 || factor > most_oversampling)
      throw_user_error("--oversampling: expected 1 to {} beams per element, found {}", most_oversampling,
                       factor);
}

MapBeams::MapBeams(const MapPrecoder& precoder, const rf::AntennaArray& array, const std::string& name)
    : precoding_(precoder.precoding), ports_(array.port_count()) {
  check_map_precoder(precoder);
  if (!has_beams(precoding_)) return;
  if (!array.positions_m.empty())
    throw_user_error(
        "--precoder: expected arrays of rows and columns, which have DFT beams, found elements_wl "
        "of '{}'",
        name);
  const rf::DftBeams beams =
      rf::dft_beams(array, precoder.oversampling.value_or(std::array<uint32_t, 2>{1, 1}));
  uint64_t last = beams.count();
  if (precoding_ == MapPrecoding::beam) {
    if (*precoder.beam >= beams.count())
      throw_user_error("--beam: expected 0 to {}, one of the beams of '{}', found {}", beams.count() - 1,
                       name, *precoder.beam);
    first_beam_ = *precoder.beam;
    last = first_beam_ + 1;
  }
  const uint64_t weights = saturating_product({last - first_beam_, ports_});
  if (weights > most_beam_weights)
    throw_user_error("--precoder: expected at most {} beams times ports, found {} of '{}'", most_beam_weights,
                     weights, name);
  weights_.reserve(weights);
  for (uint64_t beam = first_beam_; beam < last; ++beam) {
    const std::vector<rf::Complex> of_beam = beams.weights(beam);
    weights_.insert(weights_.end(), of_beam.begin(), of_beam.end());
  }
}

MapLink MapBeams::link(std::span<const rf::Path> paths, const rf::ArrayPose& transmitter,
                       const rf::ArrayPose& receiver, double carrier_hz) const {
  MapLink link{rf::link_statistics(paths, rf::path_powers(paths, transmitter, receiver, carrier_hz))};
  link.beam_gain = link.path_gain;
  if (precoding_ == MapPrecoding::mean) return link;
  if (precoding_ == MapPrecoding::maximum_ratio) {
    // |h|^2 of the channel h from all ports to a receiving one, its paths' phases averaged over the band.
    link.beam_gain *= ports_;
    return link;
  }
  const std::vector<double> gains = rf::beam_gains(paths, transmitter, receiver, carrier_hz, weights_);
  const auto best = std::max_element(gains.begin(), gains.end());  // the first of equals
  link.beam_gain = *best;
  if (*best > 0.0)
    link.beam = static_cast<int32_t>(first_beam_ + static_cast<uint64_t>(best - gains.begin()));
  return link;
}

}  // namespace greatx::sim
