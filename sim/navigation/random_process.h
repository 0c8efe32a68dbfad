// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the random parts of navigation sensors: white noise, first-order Gauss-Markov processes and random
// walks. Each is a pure function of (seed, name, sequence, sample). A process with memory is computed by its
// exact recursion from sample 0, so that a run that begins in the middle of a sequence gets the same values.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/vec.h"

namespace greatx::navigation {

/// Names the stream of a process: the seed of the scenario, "node/sensor/process", and the sequence.
struct StreamKey {
  uint64_t seed = 0;
  uint32_t stream = 0;  ///< fnv1a32 of the name
  uint32_t sequence = 0;

  StreamKey(uint64_t seed, std::string_view name, uint32_t sequence);
};

/// Independent normal numbers of variance 1, by Box and Muller's transform (Ann. Math. Stat. 29, 1958) of
/// Philox's words.
class NormalStream {
 public:
  explicit NormalStream(const StreamKey& key) : key_(key) {}
  /// Returns number `index`, which depends on the key and `index` alone.
  double at(uint64_t index) const;

 private:
  StreamKey key_;
};

/// A stationary first-order Gauss-Markov process, sampled every `step_s`: x_0 = sigma n_0 and
/// x_k = f x_(k-1) + sigma sqrt(1 - f^2) n_k with f = exp(-step_s / time_s). Its standard deviation is sigma,
/// and its correlation over a time t is exp(-|t| / time_s) (A. Gelb (ed.), Applied Optimal Estimation, MIT
/// Press 1974, section 3.8).
class GaussMarkov {
 public:
  GaussMarkov(const StreamKey& key, double sigma, double time_s, double step_s);
  /// Returns sample `sample`, 0 or more. Samples that come in ascending order cost one step each.
  double at(int64_t sample);

 private:
  NormalStream normal_;
  double sigma_, keep_, drive_;
  int64_t sample_ = -1;
  double value_ = 0.0;
};

/// A random walk from 0 whose steps have the standard deviation density * sqrt(step_s).
class RandomWalk {
 public:
  RandomWalk(const StreamKey& key, double density, double step_s);
  double at(int64_t sample);

 private:
  NormalStream normal_;
  double step_;
  int64_t sample_ = 0;
  double value_ = 0.0;
};

}  // namespace greatx::navigation
