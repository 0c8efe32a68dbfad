// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds a scenario for the Python module and for libgreatx. Callers may add to the scenario; its world, its
// plan and the device are made when they are needed. This code depends on neither of the two, and every
// function may be called from any thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/record.h"
#include "gpu/device.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/channel/radio_map_run.h"
#include "sim/experiment/experiment.h"
#include "sim/scenario/scenario.h"

namespace greatx::engine {

class PathSet;
class Stream;

/// Admits one thread at a time. Throws UserError if a thread locks it twice: a progress function that calls
/// its own Simulation would otherwise wait for itself for ever.
class SessionMutex {
 public:
  void lock() {
    if (owner_.load() == std::this_thread::get_id())
      throw_user_error("a Simulation cannot be used from its own progress function");
    mutex_.lock();
    owner_ = std::this_thread::get_id();
  }
  void unlock() {
    owner_ = std::thread::id();
    mutex_.unlock();
  }

 private:
  std::mutex mutex_;
  std::atomic<std::thread::id> owner_;
};

/// Holds the device of a session. One call at a time uses the device.
struct Gpu {
  explicit Gpu(const gpu::DeviceOptions& options) : device(options) {}
  gpu::Device device;
  std::recursive_mutex mutex;  ///< recursive, because a stream may end while its own thread reports progress
  /// Throws std::runtime_error if the validation layer has reported messages.
  void check_validation();
};

/// Is called from time to time with the number of finished items. Returns false to stop the work.
using GoOn = std::function<bool(size_t done)>;

struct NamedArray {
  std::string name, unit, description;
  Array array;
};
using NamedArrays = std::vector<NamedArray>;

/// Describes points that take the place of a channel's receivers.
struct PointReceivers {
  std::vector<dvec3> points;  ///< world, m
  std::string antenna;        ///< text of a scenario whose first antenna stands at each of the points
};

struct MapResult {
  NamedArrays arrays;
  std::string facts;  ///< JSON
};

class Session {
 public:
  Session(sim::Scenario scenario, std::string assets, gpu::DeviceOptions device);
  ~Session();

  // The next three functions take the text of a scenario, so that the parser of sim/ checks all of it.
  // `where` names the text in messages. They throw UserError.

  /// Adds the nodes of the text.
  void add_nodes(const std::string& text, const std::string& where);
  /// Adds the channels of the text. The names of their antennas refer to this scenario. If `no_receivers` is
  /// set, the channels get no receivers and can be solved for points only.
  void add_channels(const std::string& text, const std::string& where, bool no_receivers);
  /// Copies the values that `keys` names from the text: seed, ticks, sequences, tolerance_db, effects and
  /// environment.FIELD.
  void change(const std::string& text, const std::string& where, const std::vector<std::string>& keys);

  // The next four functions return descriptions as JSON.
  std::string facts() const;
  std::string scene_facts();
  std::string explain();
  std::string device_facts();

  /// Solves all paths of a channel, to `points` if given, else to the channel's receivers. Returns null if
  /// `go_on` stopped the work.
  std::shared_ptr<PathSet> solve(const std::string& channel, uint32_t sequence, int64_t tick,
                                 const std::optional<PointReceivers>& points, const GoOn& go_on);
  /// Computes a radio map. `antenna` is as in PointReceivers. Returns nullopt if `go_on` stopped the work.
  std::optional<MapResult> radio_map(const std::string& channel, uint32_t sequence, int64_t tick,
                                     const sim::MapRequest& request, const std::string& antenna,
                                     const GoOn& go_on);
  std::unique_ptr<Stream> stream(uint32_t sequence, int64_t first_tick);

 private:
  struct Kept;
  std::shared_ptr<const sim::Experiment> experiment();
  std::shared_ptr<Gpu> gpu();
  void drop_snapshot();
  void changed();
  uint32_t find_channel(const std::string& name) const;
  sim::Scenario parse(const std::string& text, const std::string& where) const;
  sim::MapReceiver antenna_at_points(const std::string& text, double carrier_hz) const;
  sim::ChannelSnapshot& snapshot(const std::shared_ptr<const sim::Experiment>& experiment,
                                 const std::shared_ptr<Gpu>& gpu, uint32_t channel,
                                 const sim::ChannelSnapshot::Instant& instant,
                                 const std::optional<scene::Bounds>& points);

  mutable SessionMutex mutex_;
  sim::Scenario scenario_;
  std::string assets_;
  gpu::DeviceOptions device_options_;
  /// Null until it is made from scenario_, and after each change. Shared, because results may outlive a
  /// change.
  std::shared_ptr<const sim::Experiment> experiment_;
  std::shared_ptr<Gpu> gpu_;
  std::unique_ptr<Kept>
      kept_;  ///< last snapshot, kept because solving it for other points needs no new search
};

}  // namespace greatx::engine
