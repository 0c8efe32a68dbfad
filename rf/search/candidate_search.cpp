// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"

namespace greatx::rf {

namespace {

/// Returns the position along a Hilbert curve of 2^16 x 2^16 cells (J. Skilling, "Programming the Hilbert
/// curve", 2004, in two dimensions).
uint32_t hilbert_index(uint32_t x, uint32_t y) {
  uint32_t index = 0;
  for (uint32_t bit = 1u << 15; bit > 0; bit >>= 1) {
    const uint32_t right = (x & bit) != 0, up = (y & bit) != 0;
    index = (index << 2) | ((3 * right) ^ up);
    if (up == 0) {
      if (right != 0) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

/// Returns the order of a direction: its cell on the octahedron, unfolded to a square (Z. Cigolle et al.,
/// JCGT 3(2), 2014).
uint32_t sphere_order(const dvec3& d) {
  const double norm = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  double u = d.x / norm, v = d.y / norm;
  if (d.z < 0.0) {
    const double folded_u = (1.0 - std::abs(v)) * (u >= 0.0 ? 1.0 : -1.0);
    v = (1.0 - std::abs(u)) * (v >= 0.0 ? 1.0 : -1.0);
    u = folded_u;
  }
  const auto cell = [](double c) {
    return static_cast<uint32_t>(std::clamp((c + 1.0) * 32768.0, 0.0, 65535.0));
  };
  return hilbert_index(cell(u), cell(v));
}

/// Returns the length of the part of a key before rf_none.
uint32_t key_depth(const uint32_t* key, uint32_t max_depth) {
  uint32_t depth = 0;
  while (depth < max_depth && key[depth] != shared::rf_none) ++depth;
  return depth;
}

/// Returns the indices of the distinct keys in lexicographic order. Neighbouring rays mostly share their key,
/// so that the first pass removes most duplicates.
std::vector<uint32_t> distinct_keys(std::span<const uint32_t> keys, uint32_t max_depth) {
  const size_t rays = keys.size() / max_depth;
  const auto key = [&](size_t ray) { return keys.data() + ray * max_depth; };
  const auto same = [&](uint32_t a, uint32_t b) { return std::equal(key(a), key(a) + max_depth, key(b)); };
  const auto less = [&](uint32_t a, uint32_t b) {
    return std::lexicographical_compare(key(a), key(a) + max_depth, key(b), key(b) + max_depth);
  };
  if (rays > ~0u)
    throw_user_error("rays: they took {} ways, expected at most {}; fewer rays take fewer", rays, ~0u);
  std::vector<uint32_t> order;
  for (uint32_t ray = 0; ray < rays; ++ray)
    if (key(ray)[0] != shared::rf_none && (order.empty() || !same(order.back(), ray))) order.push_back(ray);
  std::sort(order.begin(), order.end(), less);
  order.erase(std::unique(order.begin(), order.end(), same), order.end());
  return order;
}

void check_source(const dvec3& source) {
  GREATX_CHECK(std::isfinite(source.x + source.y + source.z), "source at ({}, {}, {})", source.x, source.y,
               source.z);
}

}  // namespace

std::vector<vec3> fibonacci_lattice(uint32_t count) {
  constexpr double golden = std::numbers::phi - 1.0;
  std::vector<dvec3> points(count);
  std::vector<std::pair<uint32_t, uint32_t>> order(count);
  for (uint32_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    const double turns = i * golden;
    const double azimuth = 2.0 * std::numbers::pi * (turns - std::floor(turns));
    points[i] = {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
    order[i] = {sphere_order(points[i]), i};
  }
  std::sort(order.begin(), order.end());
  std::vector<vec3> lattice(count);
  for (uint32_t i = 0; i < count; ++i) lattice[i] = vec3(points[order[i].second]);
  return lattice;
}

CandidateSearchResult candidates_from_keys(std::span<const uint32_t> keys, uint32_t max_depth,
                                           uint64_t capacity) {
  GREATX_CHECK(max_depth > 0 && keys.size() % max_depth == 0, "{} words of keys of {}", keys.size(),
               max_depth);
  const std::vector<uint32_t> order = distinct_keys(keys, max_depth);
  // In lexicographic order the rays that share a prefix are adjacent. Hence a prefix is new if it differs
  // from that of the ray before, and the prefixes of one depth come out in order.
  CandidateSearchResult result;
  for (uint32_t depth = 1; depth <= max_depth; ++depth) {
    const uint32_t* before = nullptr;
    for (const uint32_t ray : order) {
      const uint32_t* key = keys.data() + size_t{ray} * max_depth;
      if (key_depth(key, max_depth) < depth) continue;
      if (before != nullptr && std::equal(key, key + depth, before)) continue;
      before = key;
      if (result.found++ < capacity) result.list.add(std::span(key, depth));
    }
  }
  return result;
}

uint32_t ways_per_ray(uint32_t max_depth, uint32_t max_transmissions) {
  constexpr uint64_t most = ~0u;
  uint64_t ways = 0, choices = 1;
  for (uint32_t t = 0; t < max_depth && t <= max_transmissions; ++t) {
    ways += choices;
    if (ways >= most) return static_cast<uint32_t>(most);
    choices = choices * (max_depth - 1 - t) / (t + 1);  // < 2^32 * max_depth
    if (choices == 0) break;
  }
  return static_cast<uint32_t>(ways);
}

CandidateSearch::CandidateSearch(scene::GpuScene& scene, const CandidateSearchOptions& options,
                                 const FacetKinds& kinds)
    : scene_(&scene), options_(options) {
  GREATX_CHECK(options.rays > 0 && options.max_depth > 0 && options.max_ways > 0,
               "{} rays to depth {}, {} ways", options.rays, options.max_depth, options.max_ways);
  gpu::Device& device = scene.device();
  const uint64_t limit = device.limits().maxStorageBufferRange / sizeof(uint32_t);
  if (options.rays > limit / 3)
    throw_user_error("rays: expected at most {} on this device, found {}", limit / 3, options.rays);

  const std::vector<uint32_t> kind_words = kinds_of(kinds);
  const uint32_t ways = walls_ ? ways_per_ray(options.max_depth, options.max_transmissions) : 1;
  slots_ = std::min(ways, options.max_ways);
  counts_left_out_ = slots_ < ways;
  const uint64_t part_words = std::min<uint64_t>(limit, options.part_bytes / sizeof(uint32_t));
  part_rays_ = static_cast<uint32_t>(std::clamp<uint64_t>(part_words / words(1), 1, options.rays));

  const std::vector<vec3> lattice = fibonacci_lattice(options.rays);
  directions_ = gpu::upload_buffer(device, std::as_bytes(std::span(lattice)), "candidate directions");
  kinds_ = gpu::upload_buffer(device, std::as_bytes(std::span(kind_words)), "candidate facet kinds");
  keys_ = gpu::Buffer(device, sizeof(uint32_t) * words(part_rays_), gpu::Memory::device, "candidate keys");
  gpu::ComputeDesc compute;
  const uint32_t mask =
      options.moving_bodies ? shared::static_mask | shared::moving_mask : shared::static_mask;
  compute.specialization = {mask, foliage_ ? 1u : 0u, walls_ ? options.max_transmissions : 0u,
                            walls_ ? options.max_depth : 1u, counts_left_out_ ? 1u : 0u};
  scene.prepare_tracing(compute, "rf/candidates.comp");
  for (const uint32_t slot : {shared::candidates_directions_binding, shared::candidates_kinds_binding,
                              shared::candidates_keys_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::CandidateConstants);
  pipeline_ = gpu::ComputePipeline(device, compute, "candidate search");
}

std::vector<uint32_t> CandidateSearch::kinds_of(const FacetKinds& kinds) {
  const size_t facets = scene_->scene().facets.size();
  GREATX_CHECK(kinds.empty() || kinds.size() == facets, "kinds of {} facets, the scene has {}", kinds.size(),
               facets);
  const auto any = [&](FacetKind kind) { return std::find(kinds.begin(), kinds.end(), kind) != kinds.end(); };
  foliage_ = any(FacetKind::foliage) || any(FacetKind::absent);
  // At depth 1 no reflection can follow behind a wall.
  walls_ = any(FacetKind::wall) && options_.max_transmissions > 0 && options_.max_depth > 1;
  std::vector<uint32_t> words(facets, static_cast<uint32_t>(FacetKind::opaque));
  for (size_t i = 0; i < kinds.size(); ++i) words[i] = static_cast<uint32_t>(kinds[i]);
  return words;
}

size_t CandidateSearch::key_words(uint32_t rays) const { return size_t{rays} * slots_ * options_.max_depth; }
size_t CandidateSearch::words(uint32_t rays) const { return key_words(rays) + (counts_left_out_ ? rays : 0); }

std::vector<CandidateSearch::Part> CandidateSearch::parts() const {
  std::vector<Part> parts;
  for (uint32_t first = 0; first < options_.rays; first += parts.back().rays)
    parts.push_back({first, std::min(part_rays_, options_.rays - first)});
  return parts;
}

void CandidateSearch::record_part(gpu::Cmd& cmd, const dvec3& source, const Part& part,
                                  const gpu::Slice& target) {
  shared::CandidateConstants constants{};
  constants.source = vec3(source);
  constants.first_ray = part.first;
  constants.rays = part.rays;
  constants.max_depth = options_.max_depth;
  constants.slots = slots_;
  cmd.barrier(gpu::sync::transfer_read, gpu::sync::compute_write);  // waits for the copy of the part before
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::candidates_directions_binding, directions_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::candidates_kinds_binding, kinds_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::candidates_keys_binding, keys_));
  cmd.push(descriptors);
  cmd.constants(constants);
  cmd.dispatch_linear(part.rays, shared::candidates_group);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::transfer_read);
  const size_t bytes = sizeof(uint32_t) * words(part.rays);
  cmd.copy(keys_.slice().part(0, bytes), target.part(0, bytes));
}

CandidateSearch::Pending CandidateSearch::record(gpu::TickSlot& slot, const dvec3& source) {
  check_source(source);
  const auto scope = slot.cmd->scope("candidate search");
  Pending pending;
  for (const Part& part : parts()) {
    pending.keys.push_back(slot.readback.allocate_for<uint32_t>(words(part.rays)));
    record_part(*slot.cmd, source, part, pending.keys.back());
  }
  return pending;
}

void CandidateSearch::add_part(const Part& part, const gpu::Slice& slice, Gathered& gathered) const {
  const std::span<const uint32_t> all = slice.as<const uint32_t>().first(words(part.rays));
  const std::span<const uint32_t> keys = all.first(key_words(part.rays));
  for (const uint32_t count : all.subspan(keys.size())) gathered.left_out += count;
  for (const uint32_t row : distinct_keys(keys, options_.max_depth)) {
    const auto key = keys.subspan(size_t{row} * options_.max_depth, options_.max_depth);
    gathered.keys.insert(gathered.keys.end(), key.begin(), key.end());
  }
}

CandidateSearchResult CandidateSearch::result_of(const Gathered& gathered) const {
  CandidateSearchResult result = candidates_from_keys(gathered.keys, options_.max_depth, options_.capacity);
  result.left_out = gathered.left_out;
  return result;
}

CandidateSearchResult CandidateSearch::collect(const Pending& pending) const {
  const std::vector<Part> all = parts();
  GREATX_CHECK(pending.keys.size() == all.size(), "keys of {} parts, expected {}", pending.keys.size(),
               all.size());
  Gathered gathered;
  for (size_t i = 0; i < all.size(); ++i) add_part(all[i], pending.keys[i], gathered);
  return result_of(gathered);
}

CandidateSearchResult CandidateSearch::search(std::span<const Pose> body_poses, const dvec3& source) {
  check_source(source);
  gpu::Device& device = scene_->device();
  gpu::TickSlot slot;
  slot.upload = gpu::Arena(device, gpu::Memory::upload, 1u << 16, "search upload");
  const gpu::Buffer readback(device, keys_.size(), gpu::Memory::readback, "search readback");
  Gathered gathered;
  for (const Part& part : parts()) {
    gpu::submit_setup(device, [&](gpu::Cmd& cmd) {
      slot.cmd = &cmd;
      const auto scope = cmd.scope("candidate search");
      if (part.first == 0) scene_->record_update(slot, body_poses);
      record_part(cmd, source, part, readback.slice());
      cmd.barrier(gpu::sync::transfer_write, gpu::sync::host_read);
    });
    add_part(part, readback.slice(), gathered);
  }
  return result_of(gathered);
}

}  // namespace greatx::rf
