// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A scenario from the interpreter's side: it may be added to; its world, plan and device are made when they
// are needed. Nothing here knows Python; every call may come from any thread.
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

namespace greatx::python {

class PathSet;
class Stream;

/// One thread at a time, and no thread twice: a progress function that asks its own Simulation for something
/// would wait for itself for ever.
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

/// The device of a session. One call at a time has it.
struct Gpu {
  explicit Gpu(const gpu::DeviceOptions& options) : device(options) {}
  gpu::Device device;
  std::recursive_mutex mutex;  ///< a stream may end while its own thread reports progress
  /// Throws std::runtime_error if the validation layer had anything to say.
  void check_validation();
};

/// Called now and then with how many are done; false: enough.
using GoOn = std::function<bool(size_t done)>;

struct NamedArray {
  std::string name, unit, description;
  Array array;
};
using NamedArrays = std::vector<NamedArray>;

/// Bare points in place of a channel's receivers.
struct PointReceivers {
  std::vector<dvec3> points;  ///< world, m
  std::string antenna;        ///< a scenario whose first sensor is the antenna at each of them
};

struct MapResult {
  NamedArrays arrays;
  std::string facts;  ///< JSON
};

class Session {
 public:
  Session(sim::Scenario scenario, std::string assets, gpu::DeviceOptions device);
  ~Session();

  /// Changes are texts of scenarios: the parser of sim/ checks all that is in them. `where` names the text in
  /// messages.
  void add_nodes(const std::string& text, const std::string& where);
  /// Its channels; their antennas are by name those of this scenario. `no_receivers`: points only.
  void add_channels(const std::string& text, const std::string& where, bool no_receivers);
  /// What `keys` names of it: seed, ticks, sequences, tolerance_db, effects, environment (field by field).
  void change(const std::string& text, const std::string& where, const std::vector<std::string>& keys);

  /// Descriptions as JSON.
  std::string facts() const;
  std::string scene_facts();
  std::string explain();
  std::string device_facts();

  /// All paths of a channel. Null: `go_on` said that it is enough.
  std::shared_ptr<PathSet> solve(const std::string& channel, uint32_t sequence, int64_t tick,
                                 const std::optional<PointReceivers>& points, const GoOn& go_on);
  /// `antenna`: as PointReceivers'. None: stopped.
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
  void check_instant(uint32_t sequence, int64_t tick) const;
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
  std::shared_ptr<const sim::Experiment>
      experiment_;  ///< null: to be made of scenario_; results may outlive a change
  std::shared_ptr<Gpu> gpu_;
  std::unique_ptr<Kept> kept_;  ///< the last snapshot: other points of it need no search
};

}  // namespace greatx::python
