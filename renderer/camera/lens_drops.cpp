// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/lens_drops.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/units.h"
#include "shaders/shared/camera.h"
#include "shaders/shared/random.h"

namespace greatx::render {

namespace {

constexpr double least_fallen_m = 0.5e-3, most_fallen_m = 5e-3;
constexpr size_t fallen_bins = 512;
/// A drop rests for this share of its time. Then it runs down by up to run_m, and its area falls to 0.
constexpr double rest_share = 0.7, run_m = 0.012;
constexpr double mean_area = rest_share + 0.5 * (1.0 - rest_share);

struct Site {
  int32_t column, row;
};

/// Returns the drop of a site. `cell` is the side of its cell, m.
GlassDrop drop_at(const Site& site, const LensDrops& drops, const FallenDrops& fallen,
                  const shared::uvec2& key, double time_s, double cell) {
  const auto draws = [&](uint32_t epoch, uint32_t use) {
    const shared::uvec4 bits = shared::philox4x32(
        shared::uvec4(static_cast<uint32_t>(site.column), static_cast<uint32_t>(site.row), epoch, use), key);
    return dvec4(bits) * 0x1p-32;
  };
  const double lives = time_s / drops.stay_s + draws(0, 0).x, epoch = std::floor(lives);
  const dvec4 draw = draws(static_cast<uint32_t>(static_cast<int64_t>(epoch)), 1);
  const double spent = std::max(lives - epoch - rest_share, 0.0) / (1.0 - rest_share);
  GlassDrop drop;
  drop.middle = cell * dvec2(site.column + draw.x, site.row + draw.y);
  drop.middle.y += run_m * spent * spent;
  drop.radius = std::sqrt(1.0 - spent) * cap_radius(fallen.diameter(draw.z), radians(drops.contact_deg));
  return drop;
}

}  // namespace

double cap_radius(double diameter_m, double contact_rad) {
  // pi D^3 / 6 = pi r^3 (2 - 3 cos + cos^3) / (3 sin^3)
  const double c = std::cos(contact_rad), s = std::sin(contact_rad);
  return diameter_m * s / std::cbrt(2.0 * (2.0 - 3.0 * c + c * c * c));
}

FallenDrops::FallenDrops(double rain_mm_h) {
  const double slope = 4.1 * std::pow(rain_mm_h, -0.21),
               width = (most_fallen_m - least_fallen_m) / fallen_bins;
  shares_.assign(1, 0.0);
  for (size_t i = 0; i < fallen_bins; ++i) {
    const double d = least_fallen_m + (double(i) + 0.5) * width, mm = 1e3 * d;
    const double flux = std::exp(-slope * mm) * (9.65 - 10.3 * std::exp(-0.6 * mm));
    shares_.push_back(shares_.back() + flux);
    mean_square_ += flux * d * d;
  }
  mean_square_ /= shares_.back();
  for (double& share : shares_) share /= shares_[fallen_bins];
}

double FallenDrops::diameter(double share) const {
  const auto above = std::ranges::upper_bound(shares_, share);
  const size_t i = std::clamp<size_t>(static_cast<size_t>(above - shares_.begin()), 1, fallen_bins);
  const double part = (share - shares_[i - 1]) / (shares_[i] - shares_[i - 1]);
  return least_fallen_m + (double(i - 1) + part) * (most_fallen_m - least_fallen_m) / fallen_bins;
}

std::vector<GlassDrop> drops_on_glass(const LensDrops& drops, const FallenDrops& fallen,
                                      const RainView& numbers, uint32_t sequence, double time_s,
                                      const dvec2& low, const dvec2& high) {
  const shared::uvec4 bits = shared::philox4x32(
      shared::uvec4(numbers.stream, sequence, 0x64726f70u, 0u),
      shared::uvec2(static_cast<uint32_t>(numbers.seed), static_cast<uint32_t>(numbers.seed >> 32)));
  const double unit = cap_radius(1.0, radians(drops.contact_deg)), largest = unit * most_fallen_m;
  // Each cell of the glass has one drop at any time.
  const double cell = std::sqrt(mean_area * pi * unit * unit * fallen.mean_square() / drops.coverage);
  const auto number = [&](double place) { return static_cast<int32_t>(std::floor(place / cell)); };
  std::vector<GlassDrop> found;
  for (int32_t row = number(low.y - largest - run_m); row <= number(high.y + largest); ++row)
    for (int32_t column = number(low.x - largest); column <= number(high.x + largest); ++column) {
      const GlassDrop drop = drop_at({column, row}, drops, fallen, {bits.x, bits.y}, time_s, cell);
      const dvec2 near = glm::clamp(drop.middle, low, high) - drop.middle;
      if (glm::dot(near, near) < drop.radius * drop.radius) found.push_back(drop);
    }
  return found;
}

LensDropPass::LensDropPass(const SceneLighting& lighting, const CameraDesc& desc)
    : drops_(desc.drops),
      numbers_(desc.rain),
      seconds_per_tick_(desc.drop_seconds_per_tick),
      fallen_(desc.drops.rain_mm_h),
      scope_(desc.name + " lens drops") {
  gpu::Device& device = lighting.scene().device();
  gpu::ComputeDesc compute;
  compute.shader = "camera/lens_drops.comp";
  for (const uint32_t slot :
       {shared::drops_color_binding, shared::drops_small_binding, shared::drops_words_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::DropConstants);
  pipeline_ = gpu::ComputePipeline(device, compute, scope_);
  const auto blocks = [](uint32_t pixels) {
    return (pixels + shared::drops_block - 1) / shared::drops_block;
  };
  small_ = gpu::Buffer(device, sizeof(uvec2) * blocks(desc.width) * blocks(desc.height), gpu::Memory::device,
                       scope_);
  constants_.focal = vec2(desc.fx, desc.fy);
  constants_.center = vec2(desc.cx, desc.cy);
  constants_.glass = float(drops_.glass_m);
  constants_.radius = float(0.5 * drops_.aperture_m);
  constants_.contact = float(std::cos(radians(drops_.contact_deg)));
  constants_.width = desc.width;
  constants_.height = desc.height;
  constants_.tiles_across = (desc.width + shared::drops_tile - 1) / shared::drops_tile;
}

std::vector<uint32_t> LensDropPass::words_of(std::vector<GlassDrop> drops) const {
  // Where drops overlap, the largest is on top.
  std::ranges::stable_sort(drops, [](const GlassDrop& a, const GlassDrop& b) { return a.radius > b.radius; });
  const uint32_t across = constants_.tiles_across,
                 down = (constants_.height + shared::drops_tile - 1) / shared::drops_tile;
  std::vector<std::vector<uint32_t>> tiles(size_t{across} * down);
  const dvec2 focal(constants_.focal), center(constants_.center);
  for (uint32_t i = 0; i < drops.size(); ++i) {
    const dvec2 middle = center + focal * (drops[i].middle / drops_.glass_m),
                reach = focal * ((drops[i].radius + 0.5 * drops_.aperture_m) / drops_.glass_m) + 1.0;
    const auto first = [](double at) {
      return static_cast<uint32_t>(std::max(std::floor(at / shared::drops_tile), 0.0));
    };
    const auto end = [](double at, uint32_t count) {
      return static_cast<uint32_t>(std::clamp(std::floor(at / shared::drops_tile) + 1.0, 0.0, double(count)));
    };
    for (uint32_t y = first(middle.y - reach.y); y < end(middle.y + reach.y, down); ++y)
      for (uint32_t x = first(middle.x - reach.x); x < end(middle.x + reach.x, across); ++x)
        tiles[size_t{y} * across + x].push_back(i);
  }
  std::vector<uint32_t> words;
  auto entry = static_cast<uint32_t>(tiles.size() + 1);
  for (const auto& tile : tiles) {
    words.push_back(entry);
    entry += static_cast<uint32_t>(tile.size());
  }
  words.push_back(entry);
  for (const auto& tile : tiles)
    for (const uint32_t drop : tile) words.push_back(entry + 3 * drop);
  for (const GlassDrop& drop : drops)
    for (const double value : {drop.middle.x, drop.middle.y, drop.radius})
      words.push_back(std::bit_cast<uint32_t>(float(value)));
  return words;
}

void LensDropPass::record(gpu::TickSlot& slot, const gpu::Buffer& color, const FrameNumber& frame) {
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  const dvec2 focal(constants_.focal), center(constants_.center), size(constants_.width, constants_.height);
  const dvec2 margin(0.5 * drops_.aperture_m);
  const std::vector<uint32_t> words = words_of(drops_on_glass(
      drops_, fallen_, numbers_, frame.sequence, double(frame.tick) * seconds_per_tick_,
      -center / focal * drops_.glass_m - margin, (size - center) / focal * drops_.glass_m + margin));
  const std::vector<gpu::Descriptor> descriptors{
      gpu::Descriptor::buffer(shared::drops_color_binding, color),
      gpu::Descriptor::buffer(shared::drops_small_binding, small_),
      gpu::Descriptor::buffer(shared::drops_words_binding,
                              slot.upload.put(std::span<const uint32_t>(words)))};
  cmd.bind(pipeline_);
  cmd.push(descriptors);
  shared::DropConstants constants = constants_;
  for (const uint32_t scale : {shared::drops_block, 1u}) {
    constants.step = scale == 1u ? 1u : 0u;
    const auto groups = [&](uint32_t pixels, uint32_t of_group) {
      return ((pixels + scale - 1) / scale + of_group - 1) / of_group;
    };
    cmd.barrier(gpu::sync::compute, gpu::sync::compute);
    cmd.constants(constants);
    cmd.dispatch(groups(constants.width, shared::shade_group_width),
                 groups(constants.height, shared::shade_group_height));
  }
}

}  // namespace greatx::render
