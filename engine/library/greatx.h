// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The engine of greatx for programs in C++17 or later (docs/install.md#in-a-program-of-your-own). It needs
// the library libgreatx and nothing but the standard library's headers:
//
//   scenario (a name, a file, a text) ─► Simulation ─► paths()  ─► Paths ─► frequency_response() ─► Array
//                                                   └► run()    ─► Run   ─► next() ─► Packet of all sensors
//
// A Simulation holds a scenario, to which antennas and channels can be added. The scene is loaded and the
// Vulkan device is opened when they are first needed. Objects may be used from any thread; one call at a time
// uses the device. Copies of an object share it. Positions are in metres in the world: x east, y north, z up.
// Arrays are in C order and little-endian.
//
// Errors: faulty input throws greatx::embed::Error, whose message says what was expected and found. A failure
// of the device throws std::runtime_error.
#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#define GREATX_EXPORT __attribute__((visibility("default")))

namespace greatx::embed {

/// Reports faulty input.
class GREATX_EXPORT Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

/// Returns the version of the library, e.g. "0.1.0".
GREATX_EXPORT std::string version();
/// Returns the names of the embedded scenarios.
GREATX_EXPORT std::vector<std::string> embedded_scenarios();

/// Gives the engine's messages to a function from now on, which any thread may call: their level ("info",
/// "warning", "error"), and their text. Without it they go to the default logger of spdlog, which prints
/// them.
GREATX_EXPORT void set_log(std::function<void(const std::string& level, const std::string& text)> log);

enum class Type { u8, u16, u32, u64, i8, i32, i64, f32, f64, complex64 };

template <typename T>
constexpr Type type_of();

/// Holds a dense array in C order, which owns its bytes.
struct GREATX_EXPORT Array {
  std::string name;         ///< e.g. "delay", "rgb"
  std::string unit;         ///< e.g. "s", "1"
  std::string description;  ///< axes and meaning, in one line
  Type type = Type::u8;
  std::vector<int64_t> shape;
  std::vector<std::byte> bytes;

  /// Returns the number of elements.
  size_t size() const;
  /// Returns the elements. Throws Error if they are of another type.
  template <typename T>
  const T* data() const {
    check_type(type_of<T>());
    return reinterpret_cast<const T*>(bytes.data());
  }

 private:
  void check_type(Type asked) const;
};

/// A position in the world, m.
struct Position {
  double x = 0.0, y = 0.0, z = 0.0;
};

/// Says how a frequency response is sampled. What is not given is taken from the channel.
struct Grid {
  std::optional<double> subcarrier_spacing_hz;
  std::optional<uint32_t> subcarriers, time_samples;
  std::optional<double> time_spacing_s;
};

/// Holds the paths of all links of a channel at one tick. Links are sorted by receiver, then by transmitter.
class GREATX_EXPORT Paths {
 public:
  struct State;
  explicit Paths(std::shared_ptr<State> state);

  size_t receivers() const;
  size_t transmitters() const;
  /// Returns the number of paths of all links.
  size_t size() const;
  /// Returns the arrays of the paths, [path, ...], as in a data set (docs/channel.md): rx, tx, amplitude,
  /// delay, doppler, departure, arrival, interaction, vertex, ...; and `offsets` [links + 1], where the paths
  /// of each link begin.
  const std::vector<Array>& arrays() const;
  /// Returns one of them. Throws Error if there is none of that name.
  const Array& array(const std::string& name) const;
  /// Returns what is known of the channel, of the search, and of its guarantees, as JSON.
  std::string facts() const;
  /// Returns H(f), complex64 [rx, rx_ant, tx, tx_ant, time, subcarrier], at the frequencies carrier +
  /// (k - floor(N/2)) * spacing, with absolute delays.
  Array frequency_response(const Grid& grid = {}) const;

 private:
  std::shared_ptr<State> state_;
};

/// Holds the measurement of one sensor at one tick.
struct Record {
  std::string sensor;  ///< "node/sensor", or the name of a channel
  int64_t sample = 0;  ///< number of this record of the sensor, from 0
  std::vector<Array> arrays;
};

/// Holds the records of all sensors that were due at one tick.
struct Packet {
  int64_t tick = 0, time_ns = 0;
  std::vector<Record> records;
};

/// Computes a sequence tick by tick. The records are those of `greatx generate`, bit by bit.
class GREATX_EXPORT Run {
 public:
  struct State;
  explicit Run(std::shared_ptr<State> state);

  /// Returns name, kind, rate, arrays and metadata of each sensor, as JSON.
  std::string sensors() const;
  /// Returns the next packet, or nothing at the end of the sequence.
  std::optional<Packet> next();

 private:
  std::shared_ptr<State> state_;
};

struct Options {
  std::string assets;  ///< folder to look in for files that are not beside the scenario
  std::string device;  ///< index or part of the name of a Vulkan device; empty: $GREATX_DEVICE, or the best
  std::string tracer = "auto";  ///< how rays meet triangles: "auto", "driver" or "tree"
  bool validation = false;      ///< run under the Vulkan validation layer
};

class GREATX_EXPORT Simulation {
 public:
  /// Loads a scenario: an embedded one by its name, or a YAML file. Throws Error if it is faulty.
  explicit Simulation(const std::string& scenario, const Options& options = {});
  /// Reads the text of a scenario, YAML or JSON (docs/scenario.md). Files are looked up in the current folder
  /// and in Options::assets.
  static Simulation from_text(const std::string& text, const Options& options = {});

  /// Places an antenna that does not move, and returns its name, "NAME/antenna". `fields` is a JSON object
  /// with the fields of a scenario's antenna, for example {"rows": 8, "columns": 8}; by default it is one
  /// isotropic element of vertical polarization.
  std::string place_antenna(const std::string& name, const Position& position,
                            const std::string& fields = "{}");
  /// Adds a channel between antennas, "node/sensor". `fields` is a JSON object with the other fields of a
  /// scenario's channel: carrier_hz, bandwidth_hz, subcarriers, max_depth, ...
  void add_channel(const std::string& name, const std::vector<std::string>& transmitters,
                   const std::vector<std::string>& receivers, const std::string& fields = "{}");

  /// Returns name, ticks, nodes, antennas, channels, ... of the scenario, as JSON.
  std::string facts() const;
  /// Returns which effects are on, and why, as JSON.
  std::string explain();
  /// Returns name, type and driver of the Vulkan device, as JSON.
  std::string device();

  /// Computes all paths of a channel at a tick.
  Paths paths(const std::string& channel, int64_t tick = 0, uint32_t sequence = 0);
  /// Computes all paths of a channel to points at rest, which replace its receivers. At each of them stands
  /// the antenna that `fields` describes, as in place_antenna().
  Paths paths_to(const std::string& channel, const std::vector<Position>& points, int64_t tick = 0,
                 uint32_t sequence = 0, const std::string& fields = "{}");
  /// Begins to compute a sequence with all sensors and channels.
  Run run(uint32_t sequence = 0, int64_t first_tick = 0);

 private:
  struct State;
  explicit Simulation(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

template <>
constexpr Type type_of<uint8_t>() {
  return Type::u8;
}
template <>
constexpr Type type_of<uint16_t>() {
  return Type::u16;
}
template <>
constexpr Type type_of<uint32_t>() {
  return Type::u32;
}
template <>
constexpr Type type_of<uint64_t>() {
  return Type::u64;
}
template <>
constexpr Type type_of<int8_t>() {
  return Type::i8;
}
template <>
constexpr Type type_of<int32_t>() {
  return Type::i32;
}
template <>
constexpr Type type_of<int64_t>() {
  return Type::i64;
}
template <>
constexpr Type type_of<float>() {
  return Type::f32;
}
template <>
constexpr Type type_of<double>() {
  return Type::f64;
}
template <>
constexpr Type type_of<std::complex<float>>() {
  return Type::complex64;
}

}  // namespace greatx::embed
