// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/convex.h"

namespace greatx::rf {

bool split(const Convex& shape, const HalfPlane& half, Convex& inside, Convex& outside) {
  std::array<double, Convex::capacity> values;
  uint32_t in = 0;
  for (uint32_t i = 0; i < shape.count; ++i) in += (values[i] = half.at(shape.at[i])) >= 0.0;
  inside.count = outside.count = 0;
  if (in == shape.count) {
    inside = shape;
    return true;
  }
  if (in == 0) {
    outside = shape;
    return true;
  }
  if (shape.count + 2 > Convex::capacity) return false;
  for (uint32_t i = 0; i < shape.count; ++i) {
    const uint32_t next = i + 1 == shape.count ? 0 : i + 1;
    (values[i] >= 0.0 ? inside : outside).add(shape.at[i]);
    if ((values[i] >= 0.0) == (values[next] >= 0.0)) continue;
    const double share = values[i] / (values[i] - values[next]);
    const dvec2 between = shape.at[i] + share * (shape.at[next] - shape.at[i]);
    inside.add(between);
    outside.add(between);
  }
  return true;
}

bool clip(Convex& shape, const HalfPlane& half) {
  Convex inside, outside;
  if (split(shape, half, inside, outside)) shape = inside;
  return shape.count > 0;
}

}  // namespace greatx::rf
