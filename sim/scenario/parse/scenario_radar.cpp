// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses nodes[].sensors[] of type radar.
#include <cmath>
#include <set>

#include "core/text.h"
#include "core/units.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_tubes = 4'000'000, most_updates = 4096;

/// Parses an array. Each element is one port, since positions tell a radar's channels apart.
AntennaConfig parse_radar_array(const Field& field, PatternFiles& patterns) {
  const AntennaConfig antenna = parse_antenna(FieldMap(field, antenna_keys), patterns);
  if (array_of(antenna, 1e9).polarization_count() != 1)
    field.fail("one polarization (v, h or slant_deg): a port for each element", "two");
  return antenna;
}

void parse_field_of_view(const Field& field, rf::FieldOfView& view) {
  const FieldMap map(field, {"azimuth_deg", "elevation_deg"});
  const auto parse = [&](const char* key, double most_deg, double& low, double& high) {
    const auto f = map.find(key);
    if (!f) return;
    const std::vector<Field> ends = f->list("ends", 2);
    if (ends.size() != 2) f->fail("two angles, the lower first", fmt::format("{}", ends.size()));
    low = radians(ends[0].between(-most_deg, most_deg));
    high = radians(ends[1].between(-most_deg, most_deg));
    if (!(low < high)) f->fail("the lower angle first");
  };
  parse("azimuth_deg", 180.0, view.azimuth_min, view.azimuth_max);
  parse("elevation_deg", 90.0, view.elevation_min, view.elevation_max);
}

const Keys echo_keys{"tubes",           "max_bounces",      "targets",     "updates",
                     "diffuse_patch_m", "antenna_radius_m", "merge_share", "max_echoes"};

void parse_echoes(const Field& field, RadarConfig& radar) {
  const FieldMap map(field, echo_keys);
  rf::EchoOptions& echoes = radar.echoes;
  if (const auto f = map.find("tubes")) echoes.tubes = f->integer32(1, most_tubes);
  if (const auto f = map.find("max_bounces")) echoes.max_bounces = f->integer32(1, rf::most_bounces);
  if (const auto f = map.find("diffuse_patch_m")) echoes.diffuse_patch_m = f->positive();
  if (const auto f = map.find("antenna_radius_m")) echoes.antenna_radius_m = f->non_negative();
  if (const auto f = map.find("merge_share")) echoes.merge_share = f->between(0.0, 1.0);
  if (const auto f = map.find("max_echoes")) echoes.max_echoes = f->integer32(1, 1u << 24);
  if (const auto f = map.find("updates")) radar.updates = f->integer32(1, most_updates);
  if (const auto f = map.find("targets"))
    for (const Field& item : f->list("names of instances", 1)) radar.targets.push_back(item.text());
}

void parse_receiver(const Field& field, rf::RadarReceiver& receiver) {
  const FieldMap map(field, {"noise_figure_db", "phase_noise", "adc", "leakage"});
  if (const auto f = map.find("noise_figure_db")) receiver.noise_figure_db = f->non_negative();
  if (const auto f = map.find("phase_noise")) {
    const FieldMap noise(*f, {"level_dbc_hz", "pole_hz"});
    receiver.phase_noise.emplace();
    if (const auto g = noise.find("level_dbc_hz")) receiver.phase_noise->level_dbc_hz = g->number();
    if (const auto g = noise.find("pole_hz")) receiver.phase_noise->pole_hz = g->positive();
  }
  if (const auto f = map.find("adc")) receiver.adc = parse_adc(*f);
  if (const auto f = map.find("leakage")) {
    const FieldMap leakage(*f, {"level_db", "length_m"});
    receiver.leakage.emplace();
    receiver.leakage->level_db =
        leakage.require("level_db", "a level, dB of the transmitted power").between(-300.0, 0.0);
    if (const auto g = leakage.find("length_m")) receiver.leakage->length_m = g->between(0.0, 1e6);
  }
}

void parse_interference(const Field& field, RadarConfig& radar) {
  const FieldMap map(field, {"radars"});
  radar.interference = {field.where(), true};
  if (radar.signal.waveform.modulation != rf::RadarModulation::fmcw)
    field.refuse("interference is modelled for waveform.type fmcw alone");
  const auto f = map.find("radars");
  if (!f) return;
  radar.interference.all = false;
  for (const Field& item : f->list("radars as node/sensor", 1)) radar.interferers.push_back(item.text());
}

void parse_processing(const Field& field, rf::RadarProcessing& processing) {
  const FieldMap map(field, {"range_window", "doppler_window", "azimuths", "azimuth_limit_deg", "cfar"});
  if (const auto f = map.find("range_window")) processing.range_window = parse_window(*f);
  if (const auto f = map.find("doppler_window")) processing.doppler_window = parse_window(*f);
  if (const auto f = map.find("azimuths")) processing.azimuths = f->integer32(2, 4096);
  if (const auto f = map.find("azimuth_limit_deg"))
    processing.azimuth_limit = radians(f->between(0.1, 180.0));
  if (const auto f = map.find("cfar")) parse_cfar(*f, processing.cfar);
}

void parse_outputs(const Field& field, RadarConfig& radar) {
  radar.outputs = {.cube = false, .range_doppler = false, .range_azimuth = false, .detections = false};
  bool* const wanted[] = {&radar.outputs.cube, &radar.outputs.range_doppler, &radar.outputs.range_azimuth,
                          &radar.outputs.detections};
  for (const Field& item : field.list("outputs", 1))
    *wanted[item.choice({"cube", "range_doppler", "range_azimuth", "detections"})] = true;
  radar.signal.processing.range_doppler = radar.outputs.range_doppler;
  radar.signal.processing.range_azimuth = radar.outputs.range_azimuth;
  radar.signal.processing.detections = radar.outputs.detections;
}

/// Reports a fault at the place where the user wrote its field: "waveform.chirp_s" in the block "waveform" of
/// `map`.
[[noreturn]] void fail_at(const FieldMap& map, const rf::RadarFault& fault) {
  const size_t dot = std::min(fault.field.find('.'), fault.field.size());
  std::string block = fault.field.substr(0, dot), rest = fault.field.substr(dot);
  if (block == "arrays") block = rest == ".receive_m" ? "receive" : "transmit", rest.clear();
  if (block == "transmit_power_w") block = "power_dbm";
  const auto f = map.find(block);
  throw_user_error_at(f ? f->where() : map.field().where(), "{}.{}{}: {}", map.field().path(), block, rest,
                      fault.message);
}

/// Places the elements of the arrays at the carrier, and the slots for all transmitters.
void place_arrays(RadarConfig& radar, uint32_t chirps) {
  rf::RadarSignalConfig& signal = radar.signal;
  const auto positions = [&](const AntennaConfig& config) {
    const rf::AntennaArray array = array_of(config, signal.waveform.carrier_hz);
    std::vector<dvec3> result;
    for (uint32_t port = 0; port < array.port_count(); ++port) result.push_back(array.element_position(port));
    return result;
  };
  signal.arrays = {positions(radar.transmit), positions(radar.receive)};
  signal.waveform.transmitters = static_cast<uint32_t>(signal.arrays.transmit_m.size());
  signal.waveform.slots = chirps * signal.waveform.loop();
}

/// Returns the names, node/sensor, of all sensors of a kind.
template <typename Config>
std::vector<std::string> sensors_of(const std::vector<NodeConfig>& nodes) {
  std::vector<std::string> names;
  for (const NodeConfig& node : nodes)
    for (const SensorConfig& sensor : node.sensors)
      if (std::holds_alternative<Config>(sensor.config)) names.push_back(node.name + "/" + sensor.name);
  return names;
}

/// Returns the antenna that a bistatic radar names.
const AntennaConfig& illuminator_of(const std::vector<NodeConfig>& nodes, const RadarConfig& radar,
                                    const std::string& field) {
  const auto fail = [&](const std::string& found) {
    throw_user_error_at(radar.illuminator_where,
                        "{}: expected an antenna of one polarization as node/sensor, found {}", field, found);
  };
  const std::optional<SensorPlace> place = find_sensor(nodes, radar.illuminator);
  if (!place)
    fail(fmt::format("unknown '{}'{}", radar.illuminator,
                     suggestion(radar.illuminator, sensors_of<AntennaConfig>(nodes))));
  const auto* antenna = std::get_if<AntennaConfig>(&nodes[place->node].sensors[place->sensor].config);
  if (antenna == nullptr) fail(fmt::format("'{}', which is none", radar.illuminator));
  if (array_of(*antenna, radar.signal.waveform.carrier_hz).polarization_count() != 1)
    fail(fmt::format("'{}' with two", radar.illuminator));
  return *antenna;
}

}  // namespace

rf::RadarWindow parse_window(const Field& field) {
  constexpr rf::RadarWindow windows[] = {rf::RadarWindow::rectangular, rf::RadarWindow::hann,
                                         rf::RadarWindow::hamming, rf::RadarWindow::blackman,
                                         rf::RadarWindow::taylor};
  return windows[field.choice({"rectangular", "hann", "hamming", "blackman", "taylor"})];
}

rf::AnalogToDigital parse_adc(const Field& field) {
  const FieldMap map(field, {"bits", "full_scale_dbm"});
  rf::AnalogToDigital adc;
  if (const auto f = map.find("bits")) adc.bits = f->integer32(2, 24);
  if (const auto f = map.find("full_scale_dbm")) adc.full_scale_dbm = f->number();
  return adc;
}

void parse_cfar(const Field& field, rf::RadarCfar& c) {
  const FieldMap cfar(field, {"kind", "false_alarm", "guard", "train", "rank"});
  if (const auto g = cfar.find("kind"))
    c.kind = g->choice({"cell_averaging", "ordered_statistic"}) == 0 ? rf::RadarCfar::Kind::cell_averaging
                                                                     : rf::RadarCfar::Kind::ordered_statistic;
  if (const auto g = cfar.find("false_alarm")) c.false_alarm = g->positive();
  const auto cells = [&](const char* key, uint32_t& range, uint32_t& doppler) {
    const auto g = cfar.find(key);
    if (!g) return;
    const std::vector<Field> sides = g->list("cells in range and in Doppler", 2);
    if (sides.size() != 2) g->fail("two numbers: cells on each side in range and in Doppler");
    range = sides[0].integer32(0, 1024);
    doppler = sides[1].integer32(0, 1024);
  };
  cells("guard", c.guard_range, c.guard_doppler);
  cells("train", c.train_range, c.train_doppler);
  if (const auto g = cfar.find("rank")) c.rank = g->between(0.0, 1.0);
}

void resolve_illuminators(std::vector<NodeConfig>& nodes) {
  for (size_t n = 0; n < nodes.size(); ++n) {
    for (size_t s = 0; s < nodes[n].sensors.size(); ++s) {
      auto* radar = std::get_if<RadarConfig>(&nodes[n].sensors[s].config);
      if (radar == nullptr || radar->illuminator.empty()) continue;
      const std::string path = fmt::format("nodes[{}].sensors[{}]", n, s);
      radar->transmit = illuminator_of(nodes, *radar, path + ".illuminator");
      radar->signal.bistatic = true;
      place_arrays(*radar, radar->signal.waveform.chirps());
      if (const std::optional<rf::RadarFault> fault = rf::check(radar->signal))
        throw_user_error_at(radar->illuminator_where, "{}.{}: {}", path, fault->field, fault->message);
    }
  }
}

void resolve_interferers(std::vector<NodeConfig>& nodes) {
  for (size_t n = 0; n < nodes.size(); ++n) {
    for (size_t s = 0; s < nodes[n].sensors.size(); ++s) {
      auto* radar = std::get_if<RadarConfig>(&nodes[n].sensors[s].config);
      if (radar == nullptr) continue;
      const std::string own = nodes[n].name + "/" + nodes[n].sensors[s].name;
      std::vector<std::string> others = sensors_of<RadarConfig>(nodes);
      std::erase(others, own);
      if (radar->interference.all)
        radar->interferers.insert(radar->interferers.end(), others.begin(), others.end());
      for (const std::string& name : radar->interferers) {
        const auto fail = [&](const std::string& found) {
          throw_user_error_at(radar->interference.where,
                              "nodes[{}].sensors[{}].interference.radars: expected other radars with "
                              "waveform.type fmcw, as node/sensor; found {}",
                              n, s, found);
        };
        const std::optional<SensorPlace> place = find_sensor(nodes, name);
        if (!place) fail(fmt::format("unknown '{}'{}", name, suggestion(name, others)));
        const auto* other = std::get_if<RadarConfig>(&nodes[place->node].sensors[place->sensor].config);
        if (other == nullptr) fail(fmt::format("'{}', which is none", name));
        if (name == own) fail(fmt::format("'{}', which is the radar itself", name));
        if (other->signal.waveform.modulation != rf::RadarModulation::fmcw)
          fail(fmt::format("'{}' with another waveform", name));
        if (other->signal.bistatic)
          fail(fmt::format("'{}', which does not transmit: '{}' does", name, other->illuminator));
      }
    }
  }
}

RadarConfig parse_radar(const FieldMap& map, PatternFiles& patterns) {
  RadarConfig radar;
  rf::RadarSignalConfig& signal = radar.signal;
  uint32_t chirps = 128;
  radar.receive.columns = 4;
  radar.transmit.columns = 4;
  // With four receivers half a wavelength apart this makes a full row of sixteen.
  radar.transmit.column_spacing_wl = 2.0;
  map.exclude("illuminator", "transmit");
  if (const auto f = map.find("waveform")) signal.waveform = parse_waveform(*f, chirps);
  if (const auto f = map.find("transmit")) radar.transmit = parse_radar_array(*f, patterns);
  if (const auto f = map.find("receive")) radar.receive = parse_radar_array(*f, patterns);
  if (const auto f = map.find("illuminator")) {
    radar.illuminator = f->text();
    radar.illuminator_where = f->where();
    radar.transmit = {};  // until all antennas are known: resolve_illuminators()
  }
  if (const auto f = map.find("power_dbm"))
    signal.transmit_power_w = 1e-3 * std::pow(10.0, 0.1 * f->between(-200.0, 200.0));
  if (const auto f = map.find("field_of_view")) parse_field_of_view(*f, radar.echoes.field_of_view);
  if (const auto f = map.find("echoes")) parse_echoes(*f, radar);
  if (const auto f = map.find("receiver")) parse_receiver(*f, signal.receiver);
  if (const auto f = map.find("processing")) parse_processing(*f, signal.processing);
  if (const auto f = map.find("outputs")) parse_outputs(*f, radar);
  if (const auto f = map.find("interference")) parse_interference(*f, radar);
  if (const auto f = map.find("see_own_body")) radar.see_own_body = f->boolean();
  place_arrays(radar, chirps);
  if (const std::optional<rf::RadarFault> fault = rf::check(signal)) fail_at(map, *fault);
  if (radar.updates > chirps)
    FieldMap(map.require("echoes", "echoes"), echo_keys)
        .require("updates", "updates")
        .fail(fmt::format("at most one for each of the {} chirps", chirps));
  return radar;
}

}  // namespace greatx::sim
