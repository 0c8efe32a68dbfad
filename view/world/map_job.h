// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A radio map that is computed while one watches: on a thread and a device of its own, by the same steps as
// `greatx map`, so that its values are the same.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/watch.h"
#include "draw/map/draw.h"
#include "gpu/device.h"
#include "sim/channel/radio_map_run.h"
#include "sim/experiment/experiment.h"

namespace greatx::view {

/// What is asked for.
struct MapWish {
  uint32_t channel = 0, sequence = 0;
  int64_t tick = 0;
  sim::MapRequest request;
};

/// A map, or the part of it that is done. Nobody changes it once it is published.
struct ShownMap {
  MapWish wish;
  sim::MapCells cells;
  sim::MapPower power;
  std::vector<sim::MapLink> links;  ///< [cells, tx]; of cells that are not done yet: without paths
  size_t done = 0;                  ///< cells
  std::vector<apps::MapMarker> transmitters;

  bool complete() const { return done == cells.grid.cells(); }
  sim::RadioMap map() const { return {&cells, links, power}; }
};

class MapJob : private Watch {
 public:
  /// Starts the thread.
  MapJob(std::shared_ptr<const sim::Experiment> experiment, MapWish wish, gpu::DeviceOptions device);
  /// Stops the work, as soon as the cells that are underway are done, and waits for the thread.
  ~MapJob() override;
  MapJob(const MapJob&) = delete;
  MapJob& operator=(const MapJob&) = delete;

  /// The newest part of the map; null before the first one.
  std::shared_ptr<const ShownMap> map() const;
  bool finished() const { return finished_.load(); }
  /// Of the whole work, 0 to 1; negative: not known yet.
  double progress() const { return progress_.load(); }
  double seconds() const { return seconds_.load(); }
  /// What went wrong; empty if nothing did. A map that was cancelled is no error.
  std::string error() const;
  void cancel() { cancelled_ = true; }
  bool cancelled() const { return cancelled_.load(); }

 private:
  bool look(const WorkState&) noexcept override { return !cancelled_; }
  void work(const std::shared_ptr<const sim::Experiment>& experiment, const MapWish& wish,
            const gpu::DeviceOptions& device);
  void compute(const std::shared_ptr<const sim::Experiment>& experiment, const MapWish& wish,
               const gpu::DeviceOptions& device);
  void publish(std::shared_ptr<const ShownMap> map);

  std::atomic<bool> cancelled_{false}, finished_{false};
  std::atomic<double> progress_{-1.0}, seconds_{0.0};
  mutable std::mutex mutex_;
  std::shared_ptr<const ShownMap> map_;
  std::string error_;
  std::thread thread_;  ///< the last member: it uses the others
};

}  // namespace greatx::view
