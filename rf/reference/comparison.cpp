// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/comparison.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::rf::reference {

double Comparison::Counts::recall() const {
  return reference == 0 ? 1.0 : static_cast<double>(found) / static_cast<double>(reference);
}

Comparison::Comparison(uint32_t max_depth, const ComparisonTolerance& tolerance)
    : tolerance_(tolerance), by_depth_(max_depth + 1) {}

Comparison::Counts& Comparison::at_depth(const Polyline& path) {
  GREATX_CHECK(path.vertices.size() >= 2, "a path of {} vertices", path.vertices.size());
  return by_depth_[std::min(path.vertices.size() - 2, by_depth_.size() - 1)];
}

bool Comparison::same(const Polyline& a, const Polyline& b) const {
  if (std::abs(a.length_m - b.length_m) > tolerance_.length_m) return false;
  return std::equal(
      a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
      [&](const dvec3& p, const dvec3& q) { return glm::distance(p, q) <= tolerance_.vertex_m; });
}

void Comparison::add(uint32_t receiver, std::span<const Polyline> reference,
                     std::span<const Polyline> paths) {
  std::vector<bool> taken(paths.size(), false);
  for (uint32_t r = 0; r < reference.size(); ++r) {
    Counts& counts = at_depth(reference[r]);
    ++counts.reference;
    size_t p = 0;
    while (p < paths.size() && (taken[p] || !same(reference[r], paths[p]))) ++p;
    if (p < paths.size()) {
      taken[p] = true;
      ++counts.found;
    } else {
      ++counts.missing;
      mismatches_.push_back({Fault::missing, receiver, r});
    }
  }
  for (uint32_t p = 0; p < paths.size(); ++p) {
    if (taken[p]) continue;
    const bool known = std::any_of(reference.begin(), reference.end(),
                                   [&](const Polyline& path) { return same(path, paths[p]); });
    ++(known ? at_depth(paths[p]).doubled : at_depth(paths[p]).extra);
    mismatches_.push_back({known ? Fault::doubled : Fault::extra, receiver, p});
  }
}

Comparison::Counts Comparison::all() const {
  Counts sum;
  for (const Counts& counts : by_depth_) {
    sum.reference += counts.reference;
    sum.found += counts.found;
    sum.missing += counts.missing;
    sum.doubled += counts.doubled;
    sum.extra += counts.extra;
  }
  return sum;
}

}  // namespace greatx::rf::reference
