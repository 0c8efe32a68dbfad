// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/radar/radar_arrays.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include "core/units.h"

namespace greatx::sim {

namespace {

double db(double power) { return 10.0 * std::log10(power); }

/// Describes a quantity of every detection.
struct Column {
  const char* name;
  const char* unit;
  const char* description;
  double (*value)(const rf::RadarDetection&);
};

constexpr Column columns[] = {
    {"range", "m", "[detection] half the way from transmitter over target to receiver, at the frame's middle",
     [](const rf::RadarDetection& d) { return d.range_m; }},
    {"velocity", "m/s", "[detection] rate of the range, positive receding, in [-v_max, v_max)",
     [](const rf::RadarDetection& d) { return d.velocity_m_s; }},
    {"azimuth", "rad", "[detection] from x towards y of the sensor",
     [](const rf::RadarDetection& d) { return d.azimuth; }},
    {"elevation", "rad", "[detection] above the sensor's x-y plane",
     [](const rf::RadarDetection& d) { return d.elevation; }},
    {"snr", "dB", "[detection] signal to noise in its cell of the map",
     [](const rf::RadarDetection& d) { return db(d.snr); }},
    {"power", "dBm", "[detection] received",
     [](const rf::RadarDetection& d) { return db(d.power_w) + 30.0; }},
};

Array one_of(std::vector<int64_t> shape, const std::vector<float>& values) {
  return Array::of<float>(std::move(shape), std::span<const float>(values));
}

/// Returns the description of the cube.
std::string cube_text(const rf::RadarWaveform& w) {
  const std::string all = w.bands() > 1 ? ", of all transmitters together" : "";
  switch (w.modulation) {
    case rf::RadarModulation::fmcw:
      return "[rx, tx, chirp, sample] beat signal at the receivers' ports" + all;
    case rf::RadarModulation::stepped:
      return "[rx, tx, sweep, step] samples of the frequency steps at the receivers' ports" + all;
    case rf::RadarModulation::ofdm:
      return "[rx, tx, symbol, subcarrier] conjugate of what is received, divided by the symbols" + all;
    case rf::RadarModulation::pmcw:
      break;
  }
  return "[rx, tx, block, line] spectral lines of the correlation with the code, conjugate" + all;
}

nlohmann::json waveform_metadata(const rf::RadarWaveform& w) {
  constexpr const char* types[] = {"fmcw", "stepped", "ofdm", "pmcw"};
  nlohmann::json json = {{"carrier_hz", w.carrier_hz},
                         {"slope_hz_per_s", w.slope_hz_per_s},
                         {"bandwidth_hz", w.bandwidth_hz()},
                         {"chirp_s", w.chirp_s},
                         {"interval_s", w.interval_s},
                         {"adc_start_s", w.adc_start_s},
                         {"sample_rate_hz", w.sample_rate_hz},
                         {"samples", w.samples},
                         {"chirps", w.chirps()},
                         {"transmitters", w.transmitters},
                         {"slot_order", "slot = chirp * transmitters + transmitter"}};
  // What follows was added later. Radars with ramps in turn keep their metadata byte for byte.
  if (w.modulation != rf::RadarModulation::fmcw) json["type"] = types[static_cast<size_t>(w.modulation)];
  if (w.bands() > 1) {
    json["multiplexing"] = "ddm";
    json["empty_bands"] = w.empty_bands;
    json["slot_order"] = "slot = chirp; transmitter t turns by t/(transmitters + empty_bands) a slot";
  }
  if (w.modulation == rf::RadarModulation::stepped) json["integration_s"] = w.integration_s;
  if (w.modulation == rf::RadarModulation::pmcw) {
    json["code"] = w.code == rf::RadarCode::apas ? "apas" : "m_sequence";
    json["averages"] = w.averages;
  }
  return json;
}

}  // namespace

void describe_radar(const RadarConfig& config, const rf::RadarProcessor& processor, SensorSpec& spec) {
  const rf::RadarSignalConfig& signal = config.signal;
  const int64_t rx = std::ssize(signal.arrays.receive_m), tx = signal.waveform.loop(),
                chirps = signal.waveform.chirps(), samples = signal.waveform.samples;
  const rf::RadarAxes& axes = processor.axes();
  if (config.outputs.cube) {
    spec.arrays.push_back(
        {"cube", DType::complex64, {rx, tx, chirps, samples}, "sqrt(W)", cube_text(signal.waveform)});
    spec.outputs.push_back({"cube", FileFormat::npy_stack, {"cube"}});
  }
  if (config.outputs.range_doppler) {
    spec.arrays.push_back({"range_doppler",
                           DType::f32,
                           {std::ssize(axes.range_m), std::ssize(axes.velocity_m_s)},
                           "W",
                           "[range, velocity] mean power of the virtual antennas"});
    spec.outputs.push_back({"range_doppler", FileFormat::npy_stack, {"range_doppler"}});
  }
  if (config.outputs.range_azimuth) {
    spec.arrays.push_back({"range_azimuth",
                           DType::f32,
                           {std::ssize(axes.range_m), std::ssize(axes.azimuth)},
                           "W",
                           "[range, azimuth] power of the beam, over all velocities"});
    spec.outputs.push_back({"range_azimuth", FileFormat::npy_stack, {"range_azimuth"}});
  }
  if (!config.outputs.detections) return;
  spec.arrays.push_back(
      {"detections",
       DType::f32,
       {-1, 4},
       "m, dBsm",
       "[detection, x y z rcs] in the sensor's frame; radar cross-section by the radar equation"});
  for (const Column& column : columns)
    spec.arrays.push_back({column.name, DType::f32, {-1}, column.unit, column.description});
  spec.arrays.push_back(
      {"instance", DType::u32, {-1}, "1", "[detection] index into instances + 1; 0: a false alarm"});
  std::vector<std::string> all{"detections"};
  for (const Column& column : columns) all.push_back(column.name);
  all.push_back("instance");
  for (const std::string& name : all) spec.outputs.push_back({name, FileFormat::npy_ragged, {name}});
}

std::vector<Array> radar_arrays(const RadarConfig& config, const rf::RadarProcessor& processor,
                                const rf::RadarFrame& frame) {
  const rf::RadarSignalConfig& signal = config.signal;
  const rf::RadarAxes& axes = processor.axes();
  std::vector<Array> arrays;
  if (config.outputs.cube)
    arrays.push_back(
        Array::of<std::complex<float>>({std::ssize(signal.arrays.receive_m), signal.waveform.loop(),
                                        signal.waveform.chirps(), signal.waveform.samples},
                                       std::span<const std::complex<float>>(frame.cube)));
  if (config.outputs.range_doppler)
    arrays.push_back(one_of({std::ssize(axes.range_m), std::ssize(axes.velocity_m_s)}, frame.range_doppler));
  if (config.outputs.range_azimuth)
    arrays.push_back(one_of({std::ssize(axes.range_m), std::ssize(axes.azimuth)}, frame.range_azimuth));
  if (!config.outputs.detections) return arrays;
  const int64_t count = std::ssize(frame.detections);
  std::vector<float> points;
  std::vector<uint32_t> instances;
  for (const rf::RadarDetection& d : frame.detections) {
    for (const double value : {d.position_m.x, d.position_m.y, d.position_m.z, db(d.rcs_m2)})
      points.push_back(static_cast<float>(value));
    instances.push_back(d.instance);
  }
  arrays.push_back(one_of({count, 4}, points));
  for (const Column& column : columns) {
    std::vector<float> values;
    for (const rf::RadarDetection& d : frame.detections)
      values.push_back(static_cast<float>(column.value(d)));
    arrays.push_back(one_of({count}, values));
  }
  arrays.push_back(Array::of<uint32_t>({count}, std::span<const uint32_t>(instances)));
  return arrays;
}

nlohmann::json radar_metadata(const RadarConfig& config, const rf::RadarProcessor& processor) {
  const rf::RadarWaveform& w = config.signal.waveform;
  const rf::RadarAxes& axes = processor.axes();
  nlohmann::json json;
  json["waveform"] = waveform_metadata(w);
  const auto positions = [](const std::vector<dvec3>& elements) {
    nlohmann::json list = nlohmann::json::array();
    for (const dvec3& at : elements) list.push_back({at.x, at.y, at.z});
    return list;
  };
  json["transmit_m"] = positions(config.signal.arrays.transmit_m);
  json["receive_m"] = positions(config.signal.arrays.receive_m);
  json["transmit_power_w"] = config.signal.transmit_power_w;
  json["bistatic"] = config.signal.bistatic;
  json["range_bin_m"] = w.range_bin_m();
  json["range_span_m"] = w.range_span_m();
  json["velocity_bin_m_s"] = w.velocity_bin_m_s();
  json["velocity_min_m_s"] = axes.velocity_m_s.front();
  json["azimuth_min_rad"] = axes.azimuth.front();
  json["azimuth_max_rad"] = axes.azimuth.back();
  json["frame_middle_s"] = w.frame_middle_s();
  json["sign"] = "beat phase e^{+j 2 pi f_c tau}; velocities are rates of range, positive receding";
  json["updates"] = config.updates;
  json["frame"] = "x forward, y left, z up";
  return json;
}

}  // namespace greatx::sim
