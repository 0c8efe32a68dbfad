// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/sensing/ofdm_sensing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "core/random.h"

namespace greatx::rf {
namespace {

/// An instance must account for this share of the power of a cell (as rf/radar/signal/attribution.h).
constexpr double least_share = 0.1;
constexpr double reach_bins = 2.0;
/// A bin with less of its noise than this holds nothing that moves.
constexpr double least_noise_left = 0.1;
/// Bins beyond which a tone at rest leaves less than the sidelobes of every window.
constexpr double farthest_rest = 32.0;

/// Returns a radar whose beat signal over samples and chirps is conj(H) over subcarriers and symbols. Its
/// ramps are symbols: N samples at the rate B, with the slope B times the spacing.
RadarSignalConfig signal_of(const SensingConfig& config, const SensingWaveform& waveform) {
  RadarSignalConfig signal;
  RadarWaveform& w = signal.waveform;
  w.carrier_hz = waveform.carrier_hz;
  w.samples = waveform.subcarriers;
  w.sample_rate_hz = waveform.bandwidth_hz();
  w.slope_hz_per_s = waveform.bandwidth_hz() * waveform.spacing_hz;
  w.chirp_s = w.interval_s = waveform.interval_s;
  w.adc_start_s = 0.0;
  w.slots = waveform.symbols;
  w.transmitters = 1;
  signal.processing.range_window = config.range_window;
  signal.processing.doppler_window = config.doppler_window;
  signal.processing.cfar = config.cfar;
  signal.processing.range_azimuth = false;  // that of RadarMaps; AzimuthMap makes that of a channel
  signal.processing.azimuths = config.azimuths;
  signal.processing.azimuth_limit = config.azimuth_limit;
  return signal;
}

/// Returns the radar whose pairs of elements share a direction.
RadarSignalConfig steered(RadarSignalConfig signal, const SensingArrays& arrays) {
  signal.arrays = {arrays.transmit_m, arrays.receive_m};
  signal.waveform.transmitters = static_cast<uint32_t>(arrays.transmit_m.size());
  signal.bistatic = !arrays.monostatic;
  return signal;
}

void check(const std::string& name, const SensingConfig& config, const SensingWaveform& w,
           const SensingArrays& arrays) {
  const uint64_t range = uint64_t{config.cfar.guard_range} + config.cfar.train_range,
                 doppler = uint64_t{config.cfar.guard_doppler} + config.cfar.train_doppler;
  if (config.detections && range >= w.subcarriers)
    throw_user_error(
        "channel '{}': sensing.cfar: expected guard and training cells within {} range bins "
        "(subcarriers), found {} on each side",
        name, w.subcarriers, range);
  if (config.detections && 2 * doppler + 1 > w.symbols)
    throw_user_error(
        "channel '{}': sensing.cfar: expected guard and training cells within {} velocity bins "
        "(time_samples), found {} on each side",
        name, w.symbols, doppler);
  const size_t pairs = arrays.transmit_m.size() * arrays.receive_m.size();
  if (pairs > OfdmSensing::most_pairs)
    throw_user_error(
        "channel '{}': sensing: expected at most {} pairs of a transmitting and a receiving element, "
        "found {}",
        name, OfdmSensing::most_pairs, pairs);
}

/// Refuses a map whose azimuths would all show the same.
void check_azimuths(const std::string& name, const RadarSignalConfig& beams) {
  const double extent = extent_wavelengths(beams, dvec3(0.0, 1.0, 0.0));
  if (extent < least_extent_wavelengths)
    throw_user_error(
        "channel '{}': sensing.outputs: range_azimuth: expected elements that measure an azimuth, at least "
        "{} "
        "wavelengths apart along y, found {:.3g}",
        name, least_extent_wavelengths, extent);
}

double around(double value, double period) { return value - period * std::nearbyint(value / period); }

double wrapped(double value, double low, double period) {
  const double moved = value - period * std::floor((value - low) / period);
  return moved < low + period ? moved : low;
}

dvec3 middle_of(const std::vector<dvec3>& places) {
  return std::accumulate(places.begin(), places.end(), dvec3(0.0)) / double(places.size());
}

/// Returns the shares of white noise that remain in the bins when the weighted mean c = sum w n/sum w is
/// removed. A bin is Y - c R, with the window's response R to a tone at rest; Y and c are correlated as the
/// bins are.
std::vector<double> noise_left_of(const Window& window, uint32_t bins, bool removed) {
  std::vector<double> left(bins, 1.0);
  if (!removed) return left;
  const std::vector<float>& w = window.values();
  double squares = 0.0;
  for (const float value : w) squares += double(value) * value;
  for (uint32_t bin = 0; bin < bins; ++bin) {
    const double turns = doppler_turns(bin, bins);
    if (std::abs(turns) > farthest_rest) continue;
    const std::complex<double> rest = window.response(-turns);
    std::complex<double> both = 0.0;
    for (uint32_t n = 0; n < bins; ++n)
      both += double(w[n]) * w[n] * unit_phasor(-turns * (double(n) - 0.5 * bins) / bins);
    left[bin] = std::max(0.0, 1.0 - 2.0 * std::real(both / squares * std::conj(rest)) + std::norm(rest));
  }
  return left;
}

}  // namespace

OfdmSensing::OfdmSensing(const std::string& name, const SensingConfig& config,
                         const SensingWaveform& waveform, const SensingArrays& arrays)
    : config_(config), waveform_(waveform), arrays_(arrays) {
  check(name, config, waveform, arrays);
  const RadarSignalConfig signal = signal_of(config, waveform);
  maps_ = std::make_unique<RadarMaps>(signal);
  noise_left_ = noise_left_of(maps_->doppler_window(), waveform.symbols, config.remove_static);
  const RadarSignalConfig beams = steered(signal, arrays);
  if (config.range_azimuth) {
    check_azimuths(name, beams);
    azimuth_map_ = std::make_unique<AzimuthMap>(beams, arrays.transmit_polarizations,
                                                arrays.receive_polarizations, maps_->doppler_window());
  }
  if (!config.detections) return;
  cfar_ = std::make_unique<Cfar>(config.cfar, maps_->range_window(), maps_->doppler_window(),
                                 static_cast<uint32_t>(arrays.pairs()));
  const RadarGain any = [](const dvec3&) { return 1.0; };
  maker_ = std::make_unique<DetectionMaker>(signal, *maps_, any, any);
  finder_ = std::make_unique<DirectionFinder>(beams);
}

double OfdmSensing::noise_w() const {
  return config_.noise_figure_db ? noise_power_w(waveform_.bandwidth_hz(), *config_.noise_figure_db) : 0.0;
}

double OfdmSensing::cell_snr(double gain) const {
  const double noise = noise_w();
  if (noise == 0.0) return gain > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  const double cells = double(waveform_.subcarriers) * waveform_.symbols;
  return config_.power_w * gain * cells /
         (noise * maps_->range_window().noise_bandwidth() * maps_->doppler_window().noise_bandwidth());
}

/// The leakage of a pair of ports has one phase for all symbols, drawn from the seed.
void OfdmSensing::add_leakage(const RadarSeeds& seeds, std::span<std::complex<float>> cube) const {
  const double amplitude = std::sqrt(config_.power_w * from_decibels(*config_.leakage_db));
  const size_t symbols = waveform_.symbols, subcarriers = waveform_.subcarriers;
  RandomStream random(seeds.seed, seeds.stream ^ fnv1a32("leakage"));
  for (size_t pair = 0; pair < arrays_.pairs(); ++pair) {
    const double phase = random.uniform();
    std::vector<std::complex<float>> row(subcarriers);
    for (size_t k = 0; k < subcarriers; ++k) {
      const double offset_hz = (double(k) - double(subcarriers / 2)) * waveform_.spacing_hz;
      row[k] = std::complex<float>(amplitude * unit_phasor(phase - turns_of(waveform_.carrier_hz + offset_hz,
                                                                            config_.leakage_delay_s)));
    }
    for (size_t m = 0; m < symbols; ++m)
      for (size_t k = 0; k < subcarriers; ++k) cube[(pair * symbols + m) * subcarriers + k] += row[k];
  }
}

/// Rounds the samples in time. The symbols carry random phases of a quarter turn, which the receiver knows
/// and removes again; without them the signal of a few paths would be a pulse in time.
uint64_t OfdmSensing::convert(const RadarSeeds& seeds, uint32_t threads,
                              std::span<std::complex<float>> cube) const {
  const uint32_t count = waveform_.subcarriers;
  const Fft to_time(count, Fft::Direction::backward), to_frequency(count, Fft::Direction::forward);
  const size_t rows = cube.size() / count, groups = (rows + Fft::lanes - 1) / Fft::lanes;
  const float scale = 1.0f / std::sqrt(float(count));
  constexpr std::complex<float> quarter[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  std::vector<uint64_t> saturated(groups, 0);
  parallel_for(groups, threads, [&](size_t group) {
    std::vector<std::vector<std::complex<float>>> lines(Fft::lanes, std::vector<std::complex<float>>(count));
    std::vector<std::vector<uint8_t>> data(Fft::lanes, std::vector<uint8_t>(count));
    std::vector<Fft::Value> in(count), out(count);
    std::complex<float>* pointers[Fft::lanes];
    for (size_t lane = 0; lane < Fft::lanes; ++lane) {
      pointers[lane] = lines[lane].data();
      const size_t row = group * Fft::lanes + lane;
      if (row >= rows) continue;
      // All pairs of ports receive the same symbol.
      RandomStream random(seeds.seed ^ mix64(seeds.sequence), seeds.stream ^ fnv1a32("symbols"),
                          static_cast<uint32_t>(row % waveform_.symbols));
      uint64_t bits = 0;
      for (uint32_t k = 0; k < count; ++k, bits >>= 2) {
        if (k % 32 == 0) bits = random.bits();
        data[lane][k] = bits & 3u;
        lines[lane][k] = cube[row * count + k] * quarter[data[lane][k]] * scale;
      }
    }
    Fft::gather(pointers, count, in.data());
    to_time.transform(in.data(), out.data());
    Fft::scatter(out.data(), count, pointers);
    for (size_t lane = 0; lane < Fft::lanes; ++lane)
      if (group * Fft::lanes + lane < rows) saturated[group] += digitize(*config_.adc, 1, lines[lane]);
    Fft::gather(pointers, count, in.data());
    to_frequency.transform(in.data(), out.data());
    Fft::scatter(out.data(), count, pointers);
    for (size_t lane = 0; lane < Fft::lanes; ++lane)
      for (uint32_t k = 0; k < count && group * Fft::lanes + lane < rows; ++k)
        cube[(group * Fft::lanes + lane) * count + k] =
            lines[lane][k] * std::conj(quarter[data[lane][k]]) * scale;
  });
  return std::accumulate(saturated.begin(), saturated.end(), uint64_t{0});
}

/// The mean is weighted by the window over the symbols. What it takes from a moving target's tone, and leaves
/// at rest in its place, is then as low as the window's sidelobes; that of a plain mean would be found as a
/// ghost.
void OfdmSensing::remove_mean(uint32_t threads, std::span<std::complex<float>> cube) const {
  const size_t symbols = waveform_.symbols, subcarriers = waveform_.subcarriers;
  const std::vector<float>& weights = maps_->doppler_window().values();
  const double total = maps_->doppler_window().coherent_gain() * double(symbols);
  parallel_for(cube.size() / (symbols * subcarriers), threads, [&](size_t pair) {
    std::complex<float>* const block = cube.data() + pair * symbols * subcarriers;
    std::vector<std::complex<double>> mean(subcarriers);
    for (size_t m = 0; m < symbols; ++m)
      for (size_t k = 0; k < subcarriers; ++k)
        mean[k] += double(weights[m]) * std::complex<double>(block[m * subcarriers + k]);
    for (size_t m = 0; m < symbols; ++m)
      for (size_t k = 0; k < subcarriers; ++k)
        block[m * subcarriers + k] -= std::complex<float>(mean[k] / total);
  });
}

/// Returns the map with equal noise in all bins, for CFAR. What the removal of the mean has emptied is filled
/// with the mean of the nearest bins on both sides, so that it does not count as a lack of noise there.
std::vector<float> OfdmSensing::whitened(std::span<const float> map) const {
  std::vector<float> result(map.begin(), map.end());
  const uint32_t bins = waveform_.symbols;
  const auto kept_from = [&](uint32_t bin, uint32_t step) {
    while (noise_left_[bin] < least_noise_left) bin = (bin + step) % bins;
    return bin;
  };
  for (size_t first = 0; first < map.size(); first += bins)
    for (uint32_t bin = 0; bin < bins; ++bin) {
      const auto white = [&](uint32_t at) { return map[first + at] / static_cast<float>(noise_left_[at]); };
      result[first + bin] = 0.5f * (white(kept_from(bin, 1)) + white(kept_from(bin, bins - 1)));
    }
  return result;
}

SensingFrame OfdmSensing::process(const SensingInput& input, uint32_t threads) const {
  const size_t plane = size_t{waveform_.symbols} * waveform_.subcarriers;
  GREATX_CHECK(input.h.size() == arrays_.pairs() * plane, "{} values of H, {} needed", input.h.size(),
               arrays_.pairs() * plane);
  SensingFrame frame;
  const float amplitude = static_cast<float>(std::sqrt(config_.power_w));
  std::vector<std::complex<float>> cube(input.h.size());
  for (size_t i = 0; i < cube.size(); ++i) cube[i] = amplitude * input.h[i];
  if (config_.leakage_db) add_leakage(input.seeds, cube);
  if (config_.noise_figure_db) add_noise(input.seeds, noise_w(), threads, cube);
  if (config_.adc) frame.saturated_samples = convert(input.seeds, threads, cube);
  if (config_.remove_static) remove_mean(threads, cube);
  for (std::complex<float>& value : cube) value = std::conj(value);
  const std::vector<std::complex<float>> spectrum = maps_->spectrum(cube, threads);
  frame.range_doppler = maps_->range_doppler(spectrum, threads);
  if (azimuth_map_) frame.range_azimuth = azimuth_map_->of(spectrum, waveform_.subcarriers, threads);
  if (config_.detections) {
    const std::vector<float> white = whitened(frame.range_doppler);
    std::vector<CfarPeak> peaks = cfar_->peaks(white, threads);
    std::erase_if(peaks, [&](const CfarPeak& p) { return noise_left_[p.velocity] < least_noise_left; });
    maker_->drop_sidelobes(peaks, white);
    frame.detections.resize(peaks.size());
    parallel_for(peaks.size(), threads,
                 [&](size_t i) { frame.detections[i] = detection(peaks[i], white, spectrum, input); });
  }
  if (!config_.range_doppler) frame.range_doppler.clear();
  return frame;
}

double OfdmSensing::response(const SensingTone& tone, uint32_t range_bin, uint32_t velocity_bin) const {
  const uint32_t ranges = waveform_.subcarriers, velocities = waveform_.symbols;
  const double range_off = around(tone.delay_s * waveform_.bandwidth_hz() - range_bin, ranges);
  // conj(H) turns by -nu T from symbol to symbol, so that receding targets have positive turns.
  const double turns = -tone.doppler_hz * waveform_.interval_s * velocities;
  const double bin = doppler_turns(velocity_bin, velocities), velocity_off = around(turns - bin, velocities);
  if (std::abs(range_off) > reach_bins || std::abs(velocity_off) > reach_bins) return 0.0;
  std::complex<double> of_velocity = maps_->doppler_window().response(velocity_off);
  if (config_.remove_static)
    of_velocity -=
        maps_->doppler_window().response(around(turns, velocities)) * maps_->doppler_window().response(-bin);
  return maps_->range_window().power(range_off) * std::norm(of_velocity);
}

uint32_t OfdmSensing::instance_of(const CfarPeak& peak, std::span<const SensingTone> tones) const {
  std::map<uint32_t, double> powers;
  for (const SensingTone& tone : tones)
    powers[tone.instance] += config_.power_w * tone.gain * response(tone, peak.range, peak.velocity);
  uint32_t best = 0;
  double largest = least_share * (peak.power_w - peak.noise_w);
  for (const auto& [instance, power] : powers)
    if (power > largest) largest = power, best = instance;
  return best;
}

Direction OfdmSensing::direction_of(const CfarPeak& peak,
                                    std::span<const std::complex<float>> spectrum) const {
  const size_t plane = size_t{waveform_.symbols} * waveform_.subcarriers;
  const size_t cell = size_t{peak.range} * waveform_.symbols + peak.velocity;
  const size_t tx_ports = arrays_.transmit_ports();
  std::vector<std::complex<double>> best;
  double strongest = -1.0;
  // The pair of polarizations with the most power gives the direction.
  for (uint32_t q = 0; q < arrays_.receive_polarizations; ++q)
    for (uint32_t p = 0; p < arrays_.transmit_polarizations; ++p) {
      std::vector<std::complex<double>> snapshot;
      double power = 0.0;
      for (size_t r = 0; r < arrays_.receive_m.size(); ++r)
        for (size_t t = 0; t < arrays_.transmit_m.size(); ++t) {
          const size_t pair =
              (r * arrays_.receive_polarizations + q) * tx_ports + t * arrays_.transmit_polarizations + p;
          snapshot.emplace_back(spectrum[pair * plane + cell]);
          power += std::norm(snapshot.back());
        }
      if (power > strongest) strongest = power, best = std::move(snapshot);
    }
  return finder_->find(best);
}

SensingDetection OfdmSensing::detection(const CfarPeak& peak, std::span<const float> map,
                                        std::span<const std::complex<float>> spectrum,
                                        const SensingInput& input) const {
  const uint32_t ranges = waveform_.subcarriers, velocities = waveform_.symbols;
  const auto power = [&](uint32_t range, uint32_t velocity) {
    return std::max(0.0, map[size_t{range % ranges} * velocities + velocity % velocities] - peak.noise_w);
  };
  const double here = power(peak.range, peak.velocity);
  const double range_off = maps_->range_window().peak_offset(power(peak.range + ranges - 1, peak.velocity),
                                                             here, power(peak.range + 1, peak.velocity));
  const double velocity_off = maps_->doppler_window().peak_offset(
      power(peak.range, peak.velocity + velocities - 1), here, power(peak.range, peak.velocity + 1));
  SensingDetection result;
  result.range_bin = peak.range, result.velocity_bin = peak.velocity;
  result.snr = (peak.power_w - peak.noise_w) / std::max(peak.noise_w, 1e-300);
  result.power_w =
      here / (maps_->range_window().power(range_off) * maps_->doppler_window().power(velocity_off));
  result.instance = instance_of(peak, input.tones);
  const Direction direction = direction_of(peak, spectrum);
  result.azimuth = direction.azimuth, result.elevation = direction.elevation;
  const dvec3 unit = direction.unit();
  double way = 2.0 * (peak.range + range_off) * waveform_.range_bin_m();
  // The middle of the elements saw the path, and the range is that between the origins.
  if (arrays_.monostatic) way += glm::dot(unit, middle_of(arrays_.transmit_m));
  way += glm::dot(unit, middle_of(arrays_.receive_m));
  result.range_m = wrapped(0.5 * way, -0.5 * waveform_.range_bin_m(), waveform_.range_span_m());
  const double turns =
      wrapped(doppler_turns(peak.velocity, velocities) + velocity_off, -0.5 * velocities, velocities);
  result.velocity_m_s = turns * waveform_.velocity_bin_m_s();
  // The point on the ray of arrival at which the path over it has this length.
  way = 2.0 * result.range_m;
  const dvec3 arrival = input.receiver_orientation * unit;
  const double back = (way * way - glm::dot(input.baseline_m, input.baseline_m)) /
                      (2.0 * (way - glm::dot(arrival, input.baseline_m)));
  result.position_m = (std::isfinite(back) ? back : 0.0) * unit;
  return result;
}

}  // namespace greatx::rf
