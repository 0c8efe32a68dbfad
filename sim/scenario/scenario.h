// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a scenario as the user wrote it: the things in the world, their motion, and the sensors with their
// rates. It is plain data without behaviour. docs/scenario.md documents every field, and
// docs/scenario.schema.json checks it in an editor.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/geodesy.h"
#include "core/record.h"
#include "core/units.h"
#include "core/vec.h"
#include "renderer/lidar/scan/returns.h"
#include "renderer/lidar/scan/scan_pattern.h"
#include "rf/config/path_limits.h"
#include "rf/config/sensing_config.h"
#include "sim/scenario/accuracy.h"
#include "sim/scenario/antenna.h"
#include "sim/scenario/gait.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/navigation.h"
#include "sim/scenario/optics.h"
#include "sim/scenario/radar.h"
#include "sim/scenario/rational.h"
#include "sim/scenario/rotation.h"
#include "sim/scenario/targets.h"
#include "sim/scenario/traffic.h"

namespace greatx::sim {

// --------------------------------------------------------------------------------------- things in the world

/// Describes a scene or model that the generator (scene/generator) makes, instead of one read from a file.
struct Generated {
  std::string kind;  ///< city, country, canyon, room, mast, car, vehicle, person, quadrotor
  uint64_t seed = 1;
  double size_m = 300.0;  ///< city, country: edge of the square; canyon: length
  std::string variant;    ///< of scene::generator_variants(kind)
  friend bool operator==(const Generated&, const Generated&) = default;
};

/// Names the source of a mesh.
struct ModelSource {
  std::variant<std::filesystem::path, Generated> source;  ///< path: absolute after parsing
  SourceLocation where;
};

/// Describes a model that never moves.
struct StaticObject {
  std::string name;
  ModelSource model;
  dvec3 position_m{0.0};
  dvec3 rotation{0.0};  ///< yaw, pitch, roll, rad
  dvec3 scale{1.0};
  std::optional<std::string> semantic_class;
};

struct SceneConfig {
  std::vector<StaticObject> objects;  ///< `scene.file` or `scene.generate` is the first one
  std::optional<dvec3> origin_m;
  std::filesystem::path radio_materials;  ///< sidecar YAML; empty: none
  bool optical_only = false;
  /// The place of the world's origin on the Earth, from the scenario or from the scene's glTF file.
  std::optional<Georeference> georeference;
  HeightOf heights = HeightOf::datum;  ///< of positions in latitude and longitude, unless they say otherwise
};

// ---------------------------------------------------------------------------------------------------- motion

struct StaticTrajectory {
  dvec3 position_m{0.0};
  dvec3 rotation{0.0};  ///< yaw, pitch, roll, rad
};

struct WayPoint {
  double time_s = 0.0;
  dvec3 position_m{0.0};
  std::optional<dquat> orientation;
};

/// Holds way-points with times, in the scenario or in a CSV (t, x, y, z[, yaw_deg, pitch_deg, roll_deg]).
/// Positions follow a C1 cubic Hermite curve (Catmull-Rom tangents for uneven times) or straight lines. The
/// attitude is interpolated by slerp, or follows the velocity if none is given.
struct WayPointTrajectory {
  std::vector<WayPoint> points;  ///< at least one, times ascending
  bool smooth = true;
};

/// Describes a cubic Bezier curve in a box. Start and end are drawn from the seed within `min`..`max` and at
/// d_min..d_max from a node. P1 and P2 are the thirds of the chord plus offsets drawn within +-offset. B(u)
/// is sampled uniformly over the duration.
struct BezierTrajectory {
  dvec3 min_m{0.0}, max_m{0.0};
  std::string reference_node;  ///< empty: no distance limit
  double min_distance_m = 0.0, max_distance_m = 1e9;
  dvec3 offset_m{0.0};
  double clearance_m = 0.0;  ///< as of CorridorTrajectory
  /// The four control points, if they are given and not drawn.
  std::optional<std::array<dvec3, 4>> control_points;
};

/// Describes spatially constrained random linear interpolation: straight legs at a constant speed, between
/// points drawn within `width_m`, `height_m` of a centre line.
struct CorridorTrajectory {
  std::vector<dvec3> center_line_m;  ///< at least two points
  double width_m = 0.0, height_m = 0.0;
  int legs = 4;
  /// The free space about the node's model, from the static world and other nodes; 0: none is asked for.
  double clearance_m = 0.0;
};

using Trajectory = std::variant<StaticTrajectory, WayPointTrajectory, BezierTrajectory, CorridorTrajectory,
                                TrafficTrajectory, TrackTrajectory, FollowTrajectory>;

// --------------------------------------------------------------------------------------------------- sensors

/// Holds the 6-DoF offset of a sensor from its node's frame (x forward, y left, z up).
struct Mount {
  dvec3 position_m{0.0};
  dvec3 rotation{0.0};  ///< yaw, pitch, roll, rad
};

struct LidarConfig {
  render::Scan scan;  ///< elevations in the order given, from the first ring up or down
  double min_range_m = 0.5, max_range_m = 120.0;
  double wavelength_nm = 905.0;  ///< 905 or 1550
  bool see_own_body = false;
  double divergence = 0.0;  ///< rad, full angle at 1/e^2
  uint32_t rings = 0;       ///< rings of sub-rays; 0: one ray per shot
  render::ReturnChoice returns;
  render::Receiver receiver;  ///< without the air
  /// Coordinates of points are rounded to multiples of it, m; 0: they stay as they are.
  double point_step_m = 0.0;
  struct Outputs {
    bool listed = false;  ///< whether the scenario lists the outputs; otherwise they are the default ones
    bool points = true, ply = true, pcd = false, kitti = false;
    bool arrays = false;  ///< every array once, without a file for viewers of clouds
    bool clouds() const { return ply || pcd || arrays; }  ///< files that hold every array, not bare points
  } outputs;
};

struct SensorConfig {
  std::string name;
  Mount mount;
  std::variant<CameraConfig, EventCameraConfig, LidarConfig, RadarConfig, AntennaConfig, ImuConfig,
               GnssConfig, BarometerConfig, MagnetometerConfig>
      config;
  Rational rate_hz;  ///< not used by antennas, which fire with their channel
  SourceLocation where;
};

/// A wheel: it turns about the part's axis by the distance that its node has travelled, divided by the
/// radius.
struct RollConfig {
  double radius_m = 0.3;
  friend bool operator==(const RollConfig&, const RollConfig&) = default;
};

/// A limb of a person, which swings as the node walks. The axis points to the left.
struct LimbConfig {
  Limb limb = Limb::thigh;
  bool left = true;
  Walker walker;
  friend bool operator==(const LimbConfig&, const LimbConfig&) = default;
};

/// The cranks of a bicycle, or a limb of the one who pedals. The axis points to the left. Only traffic has
/// them.
struct PedalConfig {
  std::optional<Limb> limb;  ///< thigh or shank; none: the cranks
  bool left = true;
  Cyclist cyclist;
  friend bool operator==(const PedalConfig&, const PedalConfig&) = default;
};

using PartMotion = std::variant<TurnRate, RollConfig, LimbConfig, PedalConfig>;

/// Describes parts of a node's model that turn on it: rotors, wheels, limbs.
struct PartConfig {
  std::vector<std::string> nodes;  ///< the model's glTF nodes by name, '*', '?' and [] as in file names
  dvec3 axis{0.0, 0.0, 1.0};  ///< through the glTF node's origin, in its own frame, z up; any length but 0
  PartMotion motion;          ///< right-handed about the axis
  /// rad, at tick 0, or of a limb's cycle at distance 0; none: drawn for each glTF node and sequence, and for
  /// limbs for each node.
  std::optional<double> phase;
  SourceLocation where;
};

struct NodeConfig {
  std::string name;
  Trajectory trajectory;
  std::optional<ModelSource> model;  ///< a mesh that follows the node
  Mount model_mount;                 ///< body_from_model
  dvec3 model_scale{1.0};
  std::vector<PartConfig> parts;  ///< parts that turn
  std::optional<std::string> semantic_class;
  std::vector<SensorConfig> sensors;
  SourceLocation where;
};

/// Describes channel state information from transmit antennas to receive antennas.
struct ChannelConfig {
  std::string name;
  std::vector<std::string> transmitters;  ///< "node/sensor"
  std::vector<std::string> receivers;     ///< "node/sensor"
  Rational rate_hz;
  double carrier_hz = 3.5e9;
  double subcarrier_spacing_hz = 30e3;
  uint32_t subcarriers = 256;  ///< f_k = (k - floor(N/2)) * spacing around the carrier
  uint32_t time_samples = 1;   ///< samples per record, which differ by Doppler shifts
  double time_spacing_s = 1e-3;
  static constexpr uint32_t most_walls = 8;  ///< the most walls on a path; shared::crossings_max
  rf::PathLimits limits{.max_transmissions = most_walls,
                        .max_reflections_before_scattering = 1,
                        .scattering_budget = 4000,
                        .max_paths = 100'000};
  /// A search with beams misses no path. A search with rays launches `rays` rays, and may miss paths.
  enum class Candidates { beams, rays };
  Candidates candidates = Candidates::beams;
  uint32_t rays = 1u << 19;  ///< launched per search, if candidates come from rays
  /// `once` searches from an end that stands still.
  enum class Search { automatic, once, every_tick };
  Search search = Search::automatic;
  /// Selects the arrays to write besides those of every link.
  struct Outputs {
    bool cfr = true, paths = true;
    bool cfr_parts = false;  ///< the line of sight, and all other paths, separately
    bool coherence = false;  ///< bandwidth and time
  } outputs;
  struct Taps {
    double bandwidth_hz = 20e6;
    int32_t first = 0;
    uint32_t count = 64;
  };
  std::optional<Taps> taps;
  /// Power into each transmit port; none: there are no received powers, fields and voltages.
  std::optional<double> power_dbm;
  double resistance_ohm = 50.0;       ///< resistance of each receive port
  std::vector<TargetConfig> targets;  ///< each node once
  TargetLegs legs;                    ///< of echoes over targets
  std::optional<rf::SensingConfig> sensing;
  /// Returns the number of walls that a path may pass.
  uint32_t walls() const { return std::min(limits.max_transmissions, limits.max_depth); }
  SourceLocation where;
};

// ------------------------------------------------------------------------------------------------- the whole

enum class Switch { automatic, on, off };

/// Says how the data set of a run is stored. It changes no measurement.
struct StorageConfig {
  Compression compression = Compression::none;
};

struct Scenario {
  std::string name;
  std::filesystem::path file;  ///< empty: embedded
  std::string text;            ///< the YAML as read; its SHA-256 is the scenario's hash
  uint64_t seed = 1;
  uint32_t sequences = 1;  ///< runs of the same scenario, each with its own draws
  Rational tick_rate_hz{1000, 1};
  int64_t ticks = 0;  ///< per sequence
  /// The ticks that Bezier curves and corridors last. If they are not given, it is `ticks`. A run may be
  /// shorter or longer.
  std::optional<int64_t> trajectory_ticks;
  int64_t curve_ticks() const { return trajectory_ticks.value_or(ticks); }
  SceneConfig scene;
  Environment environment;
  std::vector<NodeConfig> nodes;  ///< those that the scenario lists, then those of its traffic
  std::optional<TrafficConfig> traffic;
  std::vector<ChannelConfig> channels;
  std::map<std::string, Switch> effects;  ///< by the names in sim/plan/effect_list.h
  double tolerance_db = 0.01;             ///< an effect that cannot change more stays off
  StorageConfig storage;
  AccuracyWish accuracy;              ///< asks `greatx generate` to choose settings (sim/tradeoff)
  std::vector<std::string> warnings;  ///< contradictions that are no faults; every run shows them
};

/// Holds the indices of a sensor called "node/sensor".
struct SensorPlace {
  uint32_t node = 0, sensor = 0;  ///< indices into Scenario::nodes, NodeConfig::sensors
};
std::optional<SensorPlace> find_sensor(const std::vector<NodeConfig>& nodes, const std::string& name);
/// Returns the place of a name that the parser has checked, such as an end of a channel.
SensorPlace sensor_place(const Scenario& scenario, const std::string& name);

}  // namespace greatx::sim
