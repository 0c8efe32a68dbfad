// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/clouds.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "core/units.h"

namespace greatx::render {

namespace {

constexpr uint32_t cloud_stream = 0xc10d5;
constexpr float base_m = 1300.0f, thickness_m = 500.0f;  ///< of cumulus, above the ground
constexpr float veil_m = 9000.0f, closed_m = 900.0f;
constexpr double base_period_m = 16000.0, detail_period_m = 2300.0;
constexpr int steps = 14;
/// Mean free path of light in a cumulus, m. Real ones have 20 m; longer ones have softer edges.
constexpr float free_path_m = 70.0f;
/// The distance over which clear air dims clouds by 1/e, m.
constexpr float air_m = 16000.0f;
constexpr float earth_m = 6371e3f;
/// Clouds are whole at this angle from the key light's disc and end at the smaller one.
constexpr double whole_from = 9.0, none_within = 2.5;  // degrees
/// The place of the plane over the scene, so that no seed begins at a corner of the field.
constexpr vec2 middle{8500.0f, 2500.0f};

/// Returns the way along a ray with the given sine of elevation to a height above the round Earth.
float way_to(float height, float sine) {
  const float down = earth_m * sine;
  // (the difference of two large numbers, multiplied out)
  return height * (2.0f * earth_m + height) /
         (std::sqrt(down * down + height * (2.0f * earth_m + height)) + down);
}

/// The way along a ray to the borders of the steps through cumulus.
using Ways = std::array<float, steps + 1>;
constexpr Ways rises = [] {  // the part of way_to() that knows the height alone
  Ways values{};
  for (int k = 0; k <= steps; ++k) {
    const float height = base_m + thickness_m * float(k) / steps;
    values[size_t(k)] = height * (2.0f * earth_m + height);
  }
  return values;
}();
Ways ways_through(float sine) {
  const float down = earth_m * sine;
  Ways ways;
  for (size_t k = 0; k < ways.size(); ++k) ways[k] = rises[k] / (std::sqrt(down * down + rises[k]) + down);
  return ways;
}

/// Henyey and Greenstein's phase function times 4 pi.
float lobe(float cosine, float g) {
  const float base = 1.0f + g * g - 2.0f * g * cosine;
  return (1.0f - g * g) / (base * std::sqrt(base));
}

/// The light of a cloud that goes to the eye, relative to that of an isotropic scatterer: a forward lobe (the
/// silver lining), the rest of single scattering, and the nearly even light that was scattered many times.
float phase(float cosine) {
  return 0.62f + 0.25f * lobe(cosine, 0.5f) + 0.05f * lobe(cosine, 0.85f) + 0.08f * lobe(cosine, -0.3f);
}

}  // namespace

PlaneField::PlaneField(uint32_t first, uint32_t size, double fall, double period_m, uint64_t seed,
                       uint32_t stream)
    : mask_(size - 1), scale_(float(size / period_m)) {
  RandomStream random(seed, stream);
  // The sum of a few uniform numbers is as good as a normal one here.
  const auto noise = [&] {
    const uint64_t bits = random.bits();
    return float(double(bits >> 32) * 0x1p-32 + double(bits & 0xffffffffu) * 0x1p-32 - 1.0);
  };
  values_.resize(size_t{first} * first);
  for (float& value : values_) value = noise();
  float amplitude = 1.0f;
  std::vector<float> wide, next;
  for (uint32_t edge = first; edge < size; edge *= 2) {
    // Each axis is doubled by a quadratic B-spline, which leaves no corners.
    wide.resize(size_t{2} * edge * edge);
    for (uint32_t row = 0; row < edge; ++row)
      for (uint32_t i = 0; i < edge; ++i) {
        const float* line = &values_[size_t{row} * edge];
        const float here = 0.75f * line[i];
        wide[size_t{row} * 2 * edge + 2 * i] = here + 0.25f * line[(i + edge - 1) % edge];
        wide[size_t{row} * 2 * edge + 2 * i + 1] = here + 0.25f * line[(i + 1) % edge];
      }
    next.resize(size_t{4} * edge * edge);
    amplitude *= float(fall);
    for (uint32_t row = 0; row < 2 * edge; ++row) {
      const uint32_t at = row / 2, other = (row % 2 == 0 ? at + edge - 1 : at + 1) % edge;
      for (uint32_t i = 0; i < 2 * edge; ++i)
        next[size_t{row} * 2 * edge + i] = 0.75f * wide[size_t{at} * 2 * edge + i] +
                                           0.25f * wide[size_t{other} * 2 * edge + i] + amplitude * noise();
    }
    values_.swap(next);
  }
  normalize();
}

void PlaneField::normalize() {
  double sum = 0.0, squares = 0.0;
  for (const float value : values_) sum += value, squares += double(value) * value;
  const double mean = sum / double(values_.size());
  const double deviation = std::sqrt(std::max(squares / double(values_.size()) - mean * mean, 1e-12));
  for (float& value : values_) value = float((value - mean) / deviation);
}

void PlaneField::billow() {
  for (float& value : values_) value = std::abs(value);
  normalize();
}

float PlaneField::exceeded_by(double share) const {
  std::vector<float> sorted = values_;
  const auto rank = static_cast<size_t>(std::clamp(1.0 - share, 0.0, 1.0) * double(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(rank), sorted.end());
  return sorted[rank];
}

Clouds::Clouds(double cover, uint64_t seed, const dvec3& key_direction)
    : base_(16, 512, 0.5, base_period_m, seed, cloud_stream),
      detail_(16, 256, 0.5, detail_period_m, seed, cloud_stream + 1),
      cumulus_(cover > 0.0),
      key_(key_direction) {
  detail_.billow();
  threshold_ = base_.exceeded_by(cover);
  veil_ = float(std::min(0.9 * cover, 0.3));
  // A low light comes nearly along the plane. The way is bounded, for clouds farther off count little.
  towards_key_ = vec2(key_) / std::max(key_.z, 0.25f);
}

/// Returns the density of cumulus at a height, 0 at the base and 1 at the top.
float Clouds::density(const vec2& place, float height) const {
  const float base = base_.at(place) - threshold_;
  const float least = 0.9f * height * std::sqrt(height);  // heaps are narrower above
  if (base < least - 0.2f) return 0.0f;
  // Two patterns that shear against each other give lumps, where one alone would give curtains.
  const float lumps = detail_.at(place + vec2(700.0f, 400.0f) * height) +
                      detail_.at(vec2(1.6f * place.y, 1.6f * place.x) - vec2(900.0f, 800.0f) * height);
  return std::clamp((base + 0.08f * lumps - 0.03f - least) * 2.2f, 0.0f, 1.0f);
}

/// Returns whether a steep ray surely meets no cumulus. Its places in the layer lie close together, so that
/// a few of them tell. `lengthen` is the way along the ray for a metre of height.
bool Clouds::passes_clear(const vec2& along, float lengthen) const {
  constexpr float steepest = 2.5f;  // at 24 degrees; the field changes little over the way between two looks
  if (lengthen > steepest) return false;
  for (const float height : {0.0f, 0.33f, 0.67f, 1.0f}) {
    const vec2 place = along * ((base_m + thickness_m * height) * lengthen) + middle;
    const float least = 0.9f * height * std::sqrt(height);
    if (base_.at(place) - threshold_ > least - 0.8f) return false;
  }
  return true;
}

CloudView Clouds::see(const vec3& direction, float shift) const {
  CloudView view;
  const float sine = std::max(direction.z, 0.005f), cosine = glm::dot(direction, key_);
  const vec2 along(direction);
  const float clear_of_key =
      float(glm::smoothstep(std::cos(radians(none_within)), std::cos(radians(whole_from)), double(cosine)));
  if (clear_of_key <= 0.0f || (!cumulus_ && veil_ <= 0.0f)) return view;
  const float towards_eye = phase(cosine);
  float weight = 0.0f, way = 0.0f;
  const bool empty = !cumulus_ || passes_clear(along, way_to(base_m, sine) / base_m);
  const Ways ways = empty ? Ways{} : ways_through(sine);
  for (int k = 0; !empty && k < steps && view.passed > 0.01f; ++k) {
    const float before = ways[size_t(k)], end = ways[size_t(k) + 1];
    const float at = before + (end - before) * shift, height = (float(k) + shift) / steps;
    const vec2 place = along * at + middle;
    const float dense = density(place, height) * clear_of_key;
    if (dense > 0.0f) {
      const float taken = 1.0f - std::exp(-dense * (end - before) / free_path_m);
      const float near = density(place + towards_key_ * 60.0f, height + 60.0f / thickness_m),
                  far = density(place + towards_key_ * 200.0f, height + 200.0f / thickness_m);
      const float depth = (near * 80.0f + far * 160.0f) / (free_path_m * std::max(key_.z, 0.25f));
      // Light that is scattered many times goes much deeper than the direct light.
      const float lit = 0.55f * std::exp(-depth) + 0.45f * std::exp(-0.2f * depth);
      const float share = view.passed * taken;
      view.direct += share * lit * towards_eye;
      view.ambient += share * (0.55f + 0.45f * height);
      way += share * at;
      weight += share;
      view.passed *= 1.0f - taken;
    }
  }
  const float high = way_to(veil_m, sine);
  const vec2 stretched(along.x * high * 0.18f + along.y * high * 0.06f, along.y * high * 0.5f);
  const float thin =
      std::clamp(0.5f * (base_.at(stretched) + 0.25f * detail_.at(stretched * 0.3f)), 0.0f, 1.0f);
  const float taken = view.passed * veil_ * thin * thin * clear_of_key;
  view.direct += 0.8f * taken * towards_eye;
  view.ambient += taken;
  way += taken * 0.5f * high;  // most of the air is below half of that height
  weight += taken;
  view.passed -= taken;
  if (weight > 0.0f) view.air = std::exp(-way / weight / air_m);
  return view;
}

float Clouds::closed(const vec3& direction) const {
  const float way = way_to(closed_m, std::max(direction.z, 0.005f));
  const vec2 place = vec2(direction) * way + middle;
  const float wave = 0.10f * base_.at(place * 0.7f) + 0.035f * base_.at(place * 3.1f);
  return 1.0f + std::clamp(wave, -0.3f, 0.3f) * std::exp(-way / 6000.0f);
}

}  // namespace greatx::render
