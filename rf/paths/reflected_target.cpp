// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/reflected_target.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/watch.h"

namespace greatx::rf {

namespace {

/// Separates the draws over reflections from every other use of a clock.
constexpr uint64_t view_keys = 0x766965772d6b6579ull;

}  // namespace

ReflectedShares::ReflectedShares(const RadioModel& model) {
  table_.assign(model.scene->materials.size() * 2 * (steps + 1), 0.0f);
  std::vector<bool> known(model.scene->materials.size(), false);
  for (uint32_t i = 0; i < model.kinds.size(); ++i) {
    const uint32_t material = model.facets.facet(i).material;
    const bool reflects = model.kinds[i] == FacetKind::opaque || model.kinds[i] == FacetKind::wall;
    if (!reflects || known[material]) continue;
    known[material] = true;
    for (const bool front : {true, false})
      for (uint32_t step = 0; step <= steps; ++step) {
        const double cosine = std::max(1e-6, static_cast<double>(step) / steps);
        const ReflectionCoefficients r = model.surfaces.reflect(material, front, cosine);
        const double share = std::max(1e-4, 0.5 * (std::norm(r.r_te) + std::norm(r.r_tm)));
        table_[(material * 2 + (front ? 0 : 1)) * (steps + 1) + step] = static_cast<float>(share);
      }
  }
}

double ReflectedShares::of(const PosedFacet& facet, const dvec3& in) const {
  const double towards = glm::dot(in, facet.normal), at = std::min(1.0, std::abs(towards)) * steps;
  const uint32_t step = std::min(steps - 1, static_cast<uint32_t>(at));
  const float* row = table_.data() + (facet.material * 2 + (towards < 0.0 ? 0 : 1)) * (steps + 1) + step;
  return std::max(1e-4, row[0] + (at - step) * (row[1] - row[0]));
}

ReflectedTarget::ReflectedTarget(const RadioModel& model, const ReflectedShares& shares,
                                 const CandidateList& ways, const dvec3& target, Source end,
                                 uint32_t max_depth)
    : model_(&model), shares_(&shares), images_(model.facets, target, ways, end) {
  for (uint32_t i = 0; i < ways.size(); ++i) {
    const auto facets = ways.sequence(i);
    if (facets.empty() || facets.size() >= max_depth) continue;
    View view{.image = images_.image(i),
              .key = view_keys,
              .sequence = i,
              .first = static_cast<uint32_t>(facets_.size()),
              .depth = static_cast<uint32_t>(facets.size())};
    view.most_before = max_depth - 1 - view.depth;
    for (uint32_t k = 0; k < facets.size(); ++k) view.key = RandomStream(view.key, facets[k], k).bits();
    facets_.insert(facets_.end(), facets.begin(), facets.end());
    set_beam(view, model.facets.facet(facets.back()), ways.windows[i]);
    if (view.usable) views_.push_back(view);
  }
}

/// Sets the half-spaces in which everything lies that sees the image through the window.
void ReflectedTarget::set_beam(View& view, const PosedFacet& facet, const PlaneWindow& window) const {
  const double behind = facet.distance(view.image), height = std::abs(behind);
  if (height <= facet.tolerance_m) return;
  view.usable = true;
  view.behind_m = height;
  const dvec3 out = behind > 0.0 ? -facet.normal : facet.normal;  // towards the patches
  const dvec2 at = facet.plane_coordinates(view.image);
  const auto side = [&](const dvec3& axis, double from_m) {
    // The plane through the image and a side of the window, `from_m` along the axis (inwards) from it.
    const dvec3 normal = glm::normalize(height * axis - from_m * out);
    return HalfSpace{normal, glm::dot(normal, view.image)};
  };
  view.beam = {HalfSpace{out, glm::dot(out, view.image) + height}, side(facet.axis_u, window.min_u - at.x),
               side(-facet.axis_u, at.x - window.max_u), side(facet.axis_v, window.min_v - at.y),
               side(-facet.axis_v, at.y - window.max_v)};
}

bool ReflectedTarget::misses(uint32_t index, const ScatterTree::Node& node) const {
  const View& view = views_[index];
  if (node.least_depth > view.most_before) return true;
  // Windows are wide by the facet's tolerance. This is room for the roundings of planes far away.
  constexpr double room_m = 1e-6;
  return std::ranges::any_of(view.beam, [&](const HalfSpace& side) {
    return glm::dot(side.normal, node.middle) + node.radius_m + room_m < side.offset;
  });
}

double ReflectedTarget::share(uint32_t index, const dvec3& from) const {
  const View& view = views_[index];
  dvec3 along = view.image - from;
  const double length = glm::length(along);
  if (length == 0.0) return 1.0;
  along /= length;
  double share = 1.0;
  for (uint32_t k = view.first + view.depth; k-- > view.first;) {
    const PosedFacet& facet = model_->facets.facet(facets_[k]);
    share *= shares_->of(facet, along);
    along -= 2.0 * glm::dot(along, facet.normal) * facet.normal;
  }
  return share;
}

bool ReflectedTarget::reach(uint32_t index, const LitPatch& patch, GeometricPath& way) const {
  const View& view = views_[index];
  way.interactions.clear();
  way.vertices.clear();
  return patch.depth <= view.most_before && images_.reach(view.sequence, patch.position, way);
}

bool ReflectedTarget::sees_more(const ScatterTree& tree, size_t count) const {
  if (tree.empty()) return false;
  GeometricPath way;
  std::vector<uint32_t> open;
  size_t seen = 0;
  for (uint32_t view = 0; view < size(); ++view) {
    checkpoint();
    open.assign(1, 0u);
    while (!open.empty()) {
      const uint32_t index = open.back();
      const ScatterTree::Node& node = tree.nodes()[index];
      open.pop_back();
      if (misses(view, node) || !(tree.to(node, image(view)) > 0.0)) continue;
      if (node.second != ScatterTree::none) {
        open.push_back(node.second);
        open.push_back(index + 1);
      } else if (reach(view, tree.patches()[node.first], way) && ++seen > count) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace greatx::rf
