// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes fair-weather clouds as functions of direction: a layer of cumulus with flat bases, and a veil of
// cirrus above it. The clouds are random fields with a share of the sky that is exact; they are not a
// simulation of air (docs/light.md).
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace greatx::render {

/// Holds a random field over a plane that repeats itself along both axes, with mean 0 and variance 1.
class PlaneField {
 public:
  PlaneField() = default;
  /// Begins with `first` values along a side, doubles their number up to `size` (both powers of two), and
  /// adds noise at each step, whose amplitude falls by `fall`.
  PlaneField(uint32_t first, uint32_t size, double fall, double period_m, uint64_t seed, uint32_t stream);

  /// Returns the value at a place, interpolated bilinearly. Places are within 2^20 periods of 0.
  float at(const vec2& place) const {
    const float u = place.x * scale_, v = place.y * scale_;
    const int32_t column = floor_of(u), line = floor_of(v);
    const uint32_t i = static_cast<uint32_t>(column) & mask_, j = static_cast<uint32_t>(line) & mask_;
    const uint32_t right = (i + 1) & mask_, row = j * (mask_ + 1), below = ((j + 1) & mask_) * (mask_ + 1);
    const float x = u - static_cast<float>(column), y = v - static_cast<float>(line);
    return (values_[row + i] * (1.0f - x) + values_[row + right] * x) * (1.0f - y) +
           (values_[below + i] * (1.0f - x) + values_[below + right] * x) * y;
  }
  /// Replaces every value by its distance from 0, with mean 0 and variance 1 again: round heaps.
  void billow();
  /// Returns the value that a share of the plane exceeds.
  float exceeded_by(double share) const;
  const std::vector<float>& values() const { return values_; }

 private:
  /// Returns std::floor of a number below 2^31, which calls a function of the library on plain x86-64.
  static int32_t floor_of(float x) {
    const auto whole = static_cast<int32_t>(x);
    return whole - static_cast<int32_t>(static_cast<float>(whole) > x);
  }
  void normalize();
  std::vector<float> values_;
  uint32_t mask_ = 0;
  float scale_ = 1.0f;  ///< values a metre
};

/// Describes what an observer on the ground sees of the clouds along one direction.
struct CloudView {
  float passed = 1.0f;   ///< share of the light from behind that passes them
  float direct = 0.0f;   ///< radiance over illuminance of a surface facing the key light, times pi
  float ambient = 0.0f;  ///< radiance over the mean radiance that comes to the clouds
  float air = 1.0f;      ///< share of the clouds' own light that passes the air on its way
};

class Clouds {
 public:
  /// `cover` is the share of the plane over the scene that has clouds above it, 0 to 1. Clouds keep away from
  /// the key light's disc, because its illuminance is given.
  Clouds(double cover, uint64_t seed, const dvec3& key_direction);

  /// Returns the view along a unit direction above the horizon. `shift`, 0 to 1, moves the samples along the
  /// ray; neighbours that differ in it have no steps in common.
  CloudView see(const vec3& direction, float shift = 0.5f) const;
  /// Returns the relative brightness of a closed cover: 1 on average, with low contrast.
  float closed(const vec3& direction) const;
  /// Returns whether a place of the plane has cumulus above it.
  bool covers(const vec2& place) const { return base_.at(place) > threshold_; }

 private:
  float density(const vec2& place, float height) const;
  bool passes_clear(const vec2& along, float lengthen) const;

  PlaneField base_, detail_;
  float threshold_ = 0.0f, veil_ = 0.0f;
  bool cumulus_ = false;
  vec3 key_{0.0f, 0.0f, 1.0f};
  vec2 towards_key_{0.0f};  ///< way over the plane a metre of height towards the key light
};

}  // namespace greatx::render
