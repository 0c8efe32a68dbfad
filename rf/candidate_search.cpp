// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"

namespace greatx::rf {

namespace {

/// Position along a Hilbert curve of 2^16 x 2^16 cells (J. Skilling, "Programming the Hilbert curve", 2004,
/// in two dimensions).
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

/// Cell of a direction on the octahedron unfolded to a square (Z. Cigolle et al., JCGT 3(2), 2014).
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

/// Length of the part of a key before rf_none.
uint32_t key_depth(const uint32_t* key, uint32_t max_depth) {
  uint32_t depth = 0;
  while (depth < max_depth && key[depth] != shared::rf_none) ++depth;
  return depth;
}

/// Indices of the keys, one of each, in lexicographic order. Neighbouring rays mostly share their key, which
/// is what makes the first pass worth it.
std::vector<uint32_t> distinct_keys(std::span<const uint32_t> keys, uint32_t max_depth) {
  const size_t rays = keys.size() / max_depth;
  const auto key = [&](size_t ray) { return keys.data() + ray * max_depth; };
  const auto same = [&](uint32_t a, uint32_t b) { return std::equal(key(a), key(a) + max_depth, key(b)); };
  const auto less = [&](uint32_t a, uint32_t b) {
    return std::lexicographical_compare(key(a), key(a) + max_depth, key(b), key(b) + max_depth);
  };
  std::vector<uint32_t> order;
  for (uint32_t ray = 0; ray < rays; ++ray)
    if (key(ray)[0] != shared::rf_none && (order.empty() || !same(order.back(), ray))) order.push_back(ray);
  std::sort(order.begin(), order.end(), less);
  order.erase(std::unique(order.begin(), order.end(), same), order.end());
  return order;
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
  // In lexicographic order the rays that share a prefix follow one another, so a prefix is new where it
  // differs from the ray before; and the prefixes of one depth come out in order.
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

CandidateSearch::CandidateSearch(scene::GpuScene& scene, const CandidateSearchOptions& options)
    : scene_(&scene), options_(options) {
  GREATX_CHECK(options.rays > 0 && options.max_depth > 0, "{} rays to depth {}", options.rays,
               options.max_depth);
  gpu::Device& device = scene.device();
  const uint64_t words = uint64_t{options.rays} * std::max<uint64_t>(3, options.max_depth);
  const uint64_t limit = device.limits().maxStorageBufferRange / sizeof(uint32_t);
  if (words > limit)
    throw_user_error("rays: expected at most {} for depth {} on this device, found {}",
                     limit / std::max<uint64_t>(3, options.max_depth), options.max_depth, options.rays);

  const std::vector<vec3> lattice = fibonacci_lattice(options.rays);
  directions_ = gpu::upload_buffer(device, std::as_bytes(std::span(lattice)), "candidate directions");
  keys_ = gpu::Buffer(device, sizeof(uint32_t) * uint64_t{options.rays} * options.max_depth,
                      gpu::Memory::device, "candidate keys");
  gpu::ComputeDesc compute;
  compute.shader = "rf/candidates.comp";
  compute.bindings = scene::GpuScene::bindings(true);
  for (const uint32_t slot : {shared::candidates_directions_binding, shared::candidates_keys_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::CandidateConstants);
  compute.specialization = {options.moving_bodies ? shared::static_mask | shared::moving_mask
                                                  : shared::static_mask};
  pipeline_ = gpu::ComputePipeline(device, compute, "candidate search");
}

CandidateSearch::Pending CandidateSearch::record(gpu::TickSlot& slot, const dvec3& source) {
  GREATX_CHECK(std::isfinite(source.x + source.y + source.z), "source at ({}, {}, {})", source.x, source.y,
               source.z);
  shared::CandidateConstants constants{};
  constants.source = vec3(source);
  constants.rays = options_.rays;
  constants.max_depth = options_.max_depth;

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("candidate search");
  cmd.barrier(gpu::sync::transfer_read, gpu::sync::compute_write);  // the copy of the search before
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::candidates_directions_binding, directions_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::candidates_keys_binding, keys_));
  cmd.push(descriptors);
  cmd.constants(constants);
  cmd.dispatch((options_.rays + shared::candidates_group - 1) / shared::candidates_group);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::transfer_read);
  const gpu::Slice target = slot.readback.allocate(keys_.size());
  cmd.copy(keys_.slice(), target);
  return {target};
}

CandidateSearchResult CandidateSearch::collect(const Pending& pending) const {
  const size_t words = size_t{options_.rays} * options_.max_depth;
  return candidates_from_keys(pending.keys.as<const uint32_t>().first(words), options_.max_depth,
                              options_.capacity);
}

CandidateSearchResult CandidateSearch::search(std::span<const Pose> body_poses, const dvec3& source) {
  gpu::Device& device = scene_->device();
  gpu::TickSlot slot;
  slot.upload = gpu::Arena(device, gpu::Memory::upload, 1u << 16, "search upload");
  slot.readback = gpu::Arena(device, gpu::Memory::readback, keys_.size(), "search readback");
  Pending pending;
  gpu::submit_setup(device, [&](gpu::Cmd& cmd) {
    slot.cmd = &cmd;
    scene_->record_update(slot, body_poses);
    pending = record(slot, source);
    cmd.barrier(gpu::sync::transfer_write, gpu::sync::host_read);
  });
  return collect(pending);
}

}  // namespace greatx::rf
