// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/moving_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/watch.h"
#include "rf/search/target_images.h"

namespace greatx::rf {
namespace {

constexpr size_t facets_a_lot = 16, beams_a_lot = 64;

/// Returns kinds in which only the facets that move are present.
FacetKinds moving_kinds(const FacetWorld& world, const FacetKinds& kinds) {
  FacetKinds chosen = kinds;
  for (uint32_t i = 0; i < world.facet_count(); ++i)
    if (world.facet(i).body == 0) chosen[i] = FacetKind::absent;
  return chosen;
}

}  // namespace

/// Holds one search: the moving facets at their present poses, and the images of the targets.
struct MovingSearch::Walk {
  Walk(const MovingSearch& of, std::span<const dvec3> targets, bool with_fixed)
      : search(of),
        options(of.options_),
        fixed_too(with_fixed),
        fixed(*of.fixed_->scene()),
        moving(*of.world_, moving_kinds(*of.world_, *of.kinds_), {}, true),
        extent_m(std::max(fixed.largest_coordinate(), moving.largest_coordinate())) {
    for (const dvec3& target : targets) {
      extent_m = std::max({extent_m, std::abs(target.x), std::abs(target.y), std::abs(target.z)});
      if (fixed_too)
        fixed_images.emplace_back(fixed, target, *of.fixed_->seen_from(target, of.walls(), options.threads));
      else
        fixed_images.emplace_back(fixed, target);
      if (options.moving_bodies) moving_images.emplace_back(moving, target);
    }
  }

  /// Holds the sequences found, one after the other. Its length precedes each sequence.
  struct Found {
    std::vector<uint32_t> sequences;
    std::vector<uint32_t> current;                ///< the sequence in progress, facets of the world
    std::vector<std::vector<uint32_t>> gathered;  ///< [depth], buffers for facets of both scenes
    void add(uint32_t last) {
      sequences.push_back(static_cast<uint32_t>(current.size()) + 1);
      sequences.insert(sequences.end(), current.begin(), current.end());
      sequences.push_back(last);
    }
  };

  void end_at(const Pyramid& pyramid, const BeamScene& scene, const std::vector<TargetImages>& images,
              Found& found) const {
    for (const TargetImages& target : images)
      target.reached_from(pyramid, [&](uint32_t facet) {
        const uint32_t index = scene.facet(facet).index;
        if (found.current.empty() || found.current.back() != index) found.add(index);
      });
  }

  /// Continues the current sequence from its last facet to the facets of `scene`, and beyond.
  void enter(const Pyramid& pyramid, const BeamScene& scene, Found& found) const {
    const size_t depth = found.current.size();
    if (found.gathered.size() <= depth) found.gathered.resize(depth + 1);
    std::vector<uint32_t> facets = std::move(found.gathered[depth]);
    facets.clear();
    scene.gather(pyramid.region(), facets);
    for (const uint32_t facet : facets) enter(pyramid, scene.facet(facet), found);
    found.gathered[depth] = std::move(facets);
  }
  void enter(const Pyramid& pyramid, const BeamFacet& facet, Found& found) const {
    checkpoint();
    if (!found.current.empty() && found.current.back() == facet.index) return;
    const std::optional<SequenceBeam> beam = cut_to(pyramid, facet);
    if (!beam) return;
    const std::optional<Pyramid> next = make_pyramid(*beam, facet, extent_m);
    if (!next) return;
    found.current.push_back(facet.index);
    go_on(*next, found);
    found.current.pop_back();
  }
  /// Continues a sequence that has a moving facet.
  void go_on(const Pyramid& pyramid, Found& found) const {
    end_at(pyramid, fixed, fixed_images, found);
    end_at(pyramid, moving, moving_images, found);
    if (found.current.size() + 2 > options.max_depth) return;
    enter(pyramid, fixed, found);
    enter(pyramid, moving, found);
  }

  /// Finds the sequences that continue sequence `index` of the tree, whose facets are at rest.
  void after(size_t index, Found& found) const {
    const SequenceBeam& beam = search.beams_[index];
    if (beam.walls == SequenceBeam::none) return;
    const auto sequence = search.sequences_.sequence(index);
    found.current.assign(sequence.begin(), sequence.end());
    Pyramid pyramid;
    pyramid.apex = beam.image;
    if (!sequence.empty()) {
      const std::optional<Pyramid> made =
          make_pyramid(beam, fixed.facet(fixed.index_of(sequence.back())), extent_m);
      if (!made) return;
      pyramid = *made;
    }
    const bool goes_on = sequence.size() + 2 <= options.max_depth;
    if (fixed_too) end_at(pyramid, fixed, fixed_images, found);
    if (fixed_too && goes_on && sequence.size() == search.tree_depth_) enter(pyramid, fixed, found);
    if (!options.moving_bodies) return;
    end_at(pyramid, moving, moving_images, found);
    if (goes_on && !sequence.empty()) enter(pyramid, moving, found);
  }
  /// Finds the sequences whose first facet is the moving facet `facet`.
  void first_at(uint32_t facet, Found& found) const {
    Pyramid everything;
    everything.apex = search.source_;
    found.current.clear();
    if (options.max_depth >= 2) enter(everything, moving.facet(facet), found);
  }

  const MovingSearch& search;
  const MovingSearchOptions& options;
  bool fixed_too;
  const BeamScene& fixed;
  BeamScene moving;
  double extent_m;
  std::vector<TargetImages> fixed_images, moving_images;  ///< [targets]
};

MovingSearch::MovingSearch(const FacetWorld& world, const FacetKinds& kinds,
                           const MovingSearchOptions& options, std::shared_ptr<FixedFacets> fixed)
    : world_(&world), kinds_(&kinds), options_(options), fixed_(std::move(fixed)) {
  if (!fixed_) fixed_ = std::make_shared<FixedFacets>(world, kinds);
}

uint32_t MovingSearch::walls() const {
  return std::min(options_.max_transmissions, std::max(options_.max_depth, 1u) - 1);
}

void MovingSearch::set_tree(const BeamSearchResult& tree, const dvec3& source) {
  GREATX_CHECK(tree.beams.size() <= tree.list.size(), "{} beams of {} sequences", tree.beams.size(),
               tree.list.size());
  source_ = source;
  beams_ = tree.beams;
  sequences_ = {};
  tree_depth_ = 0;
  for (size_t i = 0; i < beams_.size(); ++i) {
    const auto sequence = tree.list.sequence(i);
    sequences_.add(sequence);
    tree_depth_ = std::max(tree_depth_, static_cast<uint32_t>(sequence.size()));
  }
}

CandidateList MovingSearch::search(std::span<const dvec3> targets, bool fixed_too) const {
  CandidateList list;
  if (fixed_too) list.add({});
  if (options_.max_depth == 0) return list;
  GREATX_CHECK(has_tree(), "{} targets, but no tree of the world at rest", targets.size());
  WorkStage stage("search");
  const Walk walk(*this, targets, fixed_too);
  // The lots are small, so that threads share the work and the memory of a lot serves many facets or beams.
  const size_t moving = options_.moving_bodies ? walk.moving.facet_count() : 0;
  const size_t moving_lots = (moving + facets_a_lot - 1) / facets_a_lot;
  std::vector<Walk::Found> found(moving_lots + (beams_.size() + beams_a_lot - 1) / beams_a_lot);
  stage.expect(static_cast<double>(found.size()));
  parallel_for(found.size(), options_.threads, [&](size_t lot) {
    if (lot < moving_lots)
      for (size_t i = lot * facets_a_lot; i < std::min(moving, (lot + 1) * facets_a_lot); ++i)
        walk.first_at(static_cast<uint32_t>(i), found[lot]);
    else
      for (size_t i = (lot - moving_lots) * beams_a_lot;
           i < std::min(beams_.size(), (lot - moving_lots + 1) * beams_a_lot); ++i)
        walk.after(i, found[lot]);
    found[lot].gathered = {};
    stage.add(1);
  });
  for (const Walk::Found& part : found)
    for (size_t at = 0; at < part.sequences.size(); at += part.sequences[at] + 1)
      list.add(std::span(part.sequences).subspan(at + 1, part.sequences[at]));
  list.make_canonical();
  return list;
}

Seams MovingSearch::seams() const {
  return Seams(fixed_->scene(), BeamScene(*world_, moving_kinds(*world_, *kinds_), {}, true),
               options_.max_depth, options_.max_transmissions);
}

std::string MovingSearch::guarantee(bool fixed_too) const {
  return fmt::format(
      "between the ends where they are: by bounds alone, no sequence of up to {} reflections{} is left out "
      "whose "
      "beginning at rest is among the beams' ({:.2g} mm clear of edges)",
      options_.max_depth, fixed_too ? "" : " with a moving facet", 1e3 * BeamSearchOptions{}.clearance_m);
}

}  // namespace greatx::rf
