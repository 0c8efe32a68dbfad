// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the parts of the scenario's parser that its files share. No other code needs them.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/scenario/parse/earth_positions.h"
#include "sim/scenario/parse/pattern_file.h"
#include "sim/scenario/parse/scenario_values.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Holds the `distance.node` of a Bezier trajectory. It is looked up when every node is known.
struct NodeReference {
  size_t node = 0;
  Field field;
};

/// Holds the antenna patterns that a scenario names. Each is read once with each choice of options.
using PatternFiles =
    std::map<std::pair<std::filesystem::path, PatternOptions>, std::shared_ptr<const rf::PatternTable>>;

/// Holds the tables of scattering that a scenario names. Each is read once.
using RcsFiles = std::map<std::filesystem::path, std::shared_ptr<const rf::RcsTable>>;

/// Returns the index of the text of `key` in `choices`. It is called before the other keys of the map are
/// known.
size_t kind_of(const Field& field, std::string_view key, std::span<const std::string_view> choices);
inline size_t kind_of(const Field& field, std::string_view key,
                      std::initializer_list<std::string_view> choices) {
  return kind_of(field, key, std::span(choices.begin(), choices.size()));
}
/// Parses a positive rational rate not above the tick rate.
Rational rate_of(const Field& field, const Rational& tick_rate_hz);
/// Parses `file` or `generate` of `map`, exactly one of them.
ModelSource parse_model_source(const FieldMap& map);
/// Parses one factor or three, none of them 0.
dvec3 parse_scale(const Field& field);
/// Parses the name of a semantic class (scene::semantic_class_names).
std::string parse_semantic_class(const Field& field);

SceneConfig parse_scene(const Field& field);
/// Parses the environment of a scene. Place and time without a place take that of the georeference.
Environment parse_environment(const Field& field, const std::optional<Georeference>& scene,
                              std::vector<std::string>& warnings);
Trajectory parse_trajectory(const Field& field, size_t node, const EarthPositions& earth,
                            std::vector<NodeReference>& references);
SensorConfig parse_sensor(const Field& field, const Rational& tick_rate_hz, PatternFiles& patterns);
/// Parses width, height, intrinsics, near_m, msaa, distortion or lens.
void parse_pinhole(const FieldMap& map, PinholeConfig& camera);
/// Parses `lens`, after width and height. An equirectangular one sets the intrinsics, too.
void parse_lens(const FieldMap& of_camera, const Field& field, PinholeConfig& camera);
/// Returns the focal length, pixels, with which the width shows this angle through the camera's fisheye lens.
double fisheye_focal_length(const Field& fov_deg, const PinholeConfig& camera);
RollingShutter parse_rolling_shutter(const Field& field, uint32_t height);
ChromaticAberration parse_chromatic_aberration(const Field& field);
LensDrops parse_lens_drops(const Field& field);
CameraConfig parse_camera(const FieldMap& map);
EventCameraConfig parse_event_camera(const FieldMap& map, const Rational& rate_hz);
ImuConfig parse_imu(const FieldMap& map);
GnssConfig parse_gnss(const FieldMap& map);
BarometerConfig parse_barometer(const FieldMap& map);
MagnetometerConfig parse_magnetometer(const FieldMap& map);
LidarConfig parse_lidar(const FieldMap& map, const Rational& rate_hz);
/// The keys of an antenna, without those that every sensor has.
extern const Keys antenna_keys;
AntennaConfig parse_antenna(const FieldMap& map, PatternFiles& loaded);
RadarConfig parse_radar(const FieldMap& map, PatternFiles& patterns);
/// Parses the waveform of a radar but for its transmitters. `chirps` is set if the number of its chirps,
/// sweeps, symbols or blocks is given.
rf::RadarWaveform parse_waveform(const Field& field, uint32_t& chirps);
/// Gives bistatic radars the antennas that transmit for them.
void resolve_illuminators(std::vector<NodeConfig>& nodes);
/// Names the radars that disturb others, and checks that they can. Every radar is complete.
void resolve_interferers(std::vector<NodeConfig>& nodes);
/// Gives event cameras that share a camera's pixels its optics and mount.
void resolve_event_cameras(std::vector<NodeConfig>& nodes);
/// Parses the nodes. Those of the traffic follow them.
std::vector<NodeConfig> parse_nodes(const Field& field, const Rational& tick_rate_hz,
                                    const EarthPositions& earth, const std::vector<NodeConfig>& traffic);
/// Parses `traffic`. Returns its nodes. `seed` is the scenario's. With `wide_streets`, a scenario without a
/// mix of its own has vehicles of more than 6 m, too.
std::vector<NodeConfig> parse_traffic(const Field& field, uint64_t seed, bool wide_streets,
                                      TrafficConfig& traffic);
/// Parse parts of a receiver and of its processing, which radars and sensing channels share.
rf::RadarWindow parse_window(const Field& field);
void parse_cfar(const Field& field, rf::RadarCfar& cfar);
rf::AnalogToDigital parse_adc(const Field& field);
/// Parses `sensing` of a channel whose other fields are known.
void parse_sensing(const FieldMap& map, ChannelConfig& channel);
/// Parses `targets` and `legs` of a channel whose ends are known.
void parse_targets(const FieldMap& map, const std::vector<NodeConfig>& nodes, RcsFiles& loaded,
                   ChannelConfig& channel);
std::vector<ChannelConfig> parse_channels(const Field& field, const Rational& tick_rate_hz,
                                          const std::vector<NodeConfig>& nodes);

}  // namespace greatx::sim
