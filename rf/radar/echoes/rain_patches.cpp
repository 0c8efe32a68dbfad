// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/rain_patches.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/antenna/field_vector.h"
#include "rf/atmosphere/path_attenuation.h"

namespace greatx::rf {
namespace {

constexpr uint32_t columns_across_beam = 2;  ///< four in each beam
constexpr double nearest_rain_m = 1.0;       ///< nearer, the arrays see no plane waves
constexpr uint32_t rain_stream = 0x7261696eu;

/// A part of the field of view: azimuths, and sines of elevations.
struct Column {
  double azimuth_low, azimuth_high, sine_low, sine_high;
  double solid_angle() const { return (azimuth_high - azimuth_low) * (sine_high - sine_low); }
};

std::vector<Column> columns_of(const FieldOfView& view, double beam_rad) {
  const auto parts = [&](double extent) {
    return std::max(1u, static_cast<uint32_t>(std::ceil(columns_across_beam * extent / beam_rad)));
  };
  const double width = view.azimuth_max - view.azimuth_min, height = view.elevation_max - view.elevation_min;
  const uint32_t across = parts(width), up = parts(height);
  const double low = std::sin(view.elevation_min), high = std::sin(view.elevation_max);
  std::vector<Column> all;
  for (uint32_t i = 0; i < across; ++i)
    for (uint32_t k = 0; k < up; ++k)
      all.push_back({view.azimuth_min + width * i / across, view.azimuth_min + width * (i + 1) / across,
                     low + (high - low) * k / up, low + (high - low) * (k + 1) / up});
  return all;
}

/// Returns two independent normal numbers of variance 1.
std::complex<double> normals(RandomStream& random) {
  return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::polar(1.0, 2.0 * pi * random.uniform());
}

/// Returns f_t . f_r, what a sphere returns between two elements but for its sign.
std::complex<double> sphere_gain(const RainRadar& radar, const dvec3& direction) {
  const FieldVector sent = field_towards(radar.transmitter, direction),
                    heard = field_towards(radar.receiver, direction);
  return {glm::dot(sent.re, heard.re) - glm::dot(sent.im, heard.im),
          glm::dot(sent.re, heard.im) + glm::dot(sent.im, heard.re)};
}

/// Cuts patches into more blocks. Each takes the rate of the block that it was part of.
void refine(const RadarWaveform& w, const EchoMotion& motion, uint32_t blocks, PatchList& patches) {
  const uint32_t slots = static_cast<uint32_t>(motion.slot_start_s.size());
  const size_t count = patches.size();
  std::vector<double> delays, rates;
  for (uint32_t block = 0; block < blocks; ++block) {
    const PatchBlock to = patch_block(w, motion.first_slot, slots, blocks, block);
    uint32_t best = 0;
    double nearest = 1e300;
    for (uint32_t old = 0; old < patches.blocks; ++old) {
      const double apart =
          std::abs(patch_block(w, motion.first_slot, slots, patches.blocks, old).middle_s - to.middle_s);
      if (apart < nearest) nearest = apart, best = old;
    }
    const double later =
        to.middle_s - patch_block(w, motion.first_slot, slots, patches.blocks, best).middle_s;
    for (size_t i = 0; i < count; ++i) {
      rates.push_back(patches.rate[best * count + i]);
      delays.push_back(patches.delay_s[best * count + i] + later * rates.back());
    }
  }
  patches.delay_s = std::move(delays), patches.rate = std::move(rates), patches.blocks = blocks;
}

struct Drop {
  std::complex<double> amplitude;
  dvec3 direction;
  double range_m, rate_m_s;  ///< at the start of the frame
};

class RainColumns {
 public:
  RainColumns(const RainRadar& radar, const EchoMotion& motion) : radar_(radar), frame_(motion.frame) {
    const double step_s = std::max(motion.frame_s(), 1e-6);
    velocity_ = (motion.transmitter(motion.traced_s + step_s).position -
                 motion.transmitter(motion.traced_s).position) /
                step_s;
  }
  const dvec3& velocity() const { return velocity_; }

  /// Adds the drops of a column up to a distance.
  void fill(uint32_t index, const Column& column, double farthest_m,
            const std::function<double(const dvec3&)>& free_way, std::vector<Drop>& drops) const {
    const EchoOptions& o = radar_.options;
    const double bin = o.waveform.range_bin_m();
    RandomStream random(o.seed ^ (frame_ << 20), rain_stream, index);
    const double azimuth = random.uniform(column.azimuth_low, column.azimuth_high),
                 sine = random.uniform(column.sine_low, column.sine_high),
                 flat = std::sqrt(std::max(0.0, 1.0 - sine * sine));
    const dvec3 direction =
        radar_.pose.orientation * dvec3(flat * std::cos(azimuth), flat * std::sin(azimuth), sine);
    const double end = std::min(farthest_m, free_way(direction));
    const std::complex<double> gain = sphere_gain(radar_, direction);
    const double scale = std::norm(gain) * radar_.wavelength_m * radar_.wavelength_m *
                         o.rain.reflectivity_per_m / std::pow(4.0 * pi, 3);
    for (uint32_t k = std::max(1u, static_cast<uint32_t>(std::ceil(nearest_rain_m / bin)));
         (k + 1) * bin <= end; ++k) {
      const double low = k * bin, high = low + bin;
      const double volume = column.solid_angle() * (high * high * high - low * low * low) / 3.0;
      const double range = std::cbrt(random.uniform(low * low * low, high * high * high));
      const std::complex<double> draw = normals(random), motion = normals(random);
      const double power = scale * volume / (range * range * range * range);
      if (power < o.hidden_ratio / hidden_share_) continue;
      const double fall = o.rain.fall_m_s + o.rain.fall_spread_m_s * motion.real();
      const double rate =
          -glm::dot(direction, velocity_) - direction.z * fall + o.rain.turbulence_m_s * motion.imag();
      drops.push_back(
          {std::sqrt(0.5 * power) * draw * amplitude(o.air_db_per_km, 2.0 * range), direction, range, rate});
    }
  }

 private:
  /// So many scatterers of a range may add up in a cell of the map.
  static constexpr double hidden_share_ = 64.0;
  const RainRadar& radar_;
  uint64_t frame_;
  dvec3 velocity_{0.0};
};

}  // namespace

void add_rain(const RainRadar& radar, const FacetWorld& world, const EchoTracer& tracer,
              const EchoMotion& motion, PatchList& patches) {
  const EchoOptions& o = radar.options;
  if (o.rain.reflectivity_per_m <= 0.0) return;
  const RadarWaveform& w = o.waveform;
  const RainColumns rain(radar, motion);
  const EchoTracer::View view = tracer.view(world, radar.own_body);
  const auto free_way = [&](const dvec3& direction) {
    return tracer.first(view, radar.pose.position, direction, ~0u).distance;
  };
  const std::vector<Column> columns = columns_of(o.field_of_view, o.beam_rad);
  std::vector<Drop> drops;
  for (uint32_t i = 0; i < columns.size(); ++i) rain.fill(i, columns[i], w.range_span_m(), free_way, drops);
  if (drops.empty()) return;

  double fastest = 0.0;
  for (const Drop& drop : drops) fastest = std::max(fastest, std::abs(drop.rate_m_s));
  const uint32_t slots = static_cast<uint32_t>(motion.slot_start_s.size());
  const uint32_t blocks = patch_blocks(w, slots, 2.0 * fastest / speed_of_light, 0.0);
  if (blocks > patches.blocks) refine(w, motion, blocks, patches);
  const bool with_arrivals = !patches.arrival.empty();
  std::vector<double> delays, rates;
  const size_t before = patches.size();
  for (uint32_t block = 0; block < patches.blocks; ++block) {
    const double at_s = patch_block(w, motion.first_slot, slots, patches.blocks, block).middle_s;
    delays.insert(delays.end(), patches.delay_s.begin() + block * before,
                  patches.delay_s.begin() + (block + 1) * before);
    rates.insert(rates.end(), patches.rate.begin() + block * before,
                 patches.rate.begin() + (block + 1) * before);
    for (const Drop& drop : drops) {
      delays.push_back(2.0 * (drop.range_m + drop.rate_m_s * at_s) / speed_of_light);
      rates.push_back(2.0 * drop.rate_m_s / speed_of_light);
    }
  }
  patches.delay_s = std::move(delays), patches.rate = std::move(rates);
  for (const Drop& drop : drops) {
    patches.re.push_back(static_cast<float>(drop.amplitude.real()));
    patches.im.push_back(static_cast<float>(drop.amplitude.imag()));
    patches.departure.push_back(vec3(drop.direction));
    if (with_arrivals) patches.arrival.push_back(vec3(drop.direction));
    patches.instance.push_back(0);
  }
}

}  // namespace greatx::rf
