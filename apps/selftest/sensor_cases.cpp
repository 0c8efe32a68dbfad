// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Cameras, event cameras and LiDAR on the device.
#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "apps/selftest/catalogue.h"
#include "core/units.h"
#include "gpu/condition.h"
#include "renderer/camera/camera.h"
#include "renderer/event/event_pass.h"
#include "renderer/light/lighting.h"

namespace greatx::apps::selftest {

namespace {

using render::EventFrame;

/// Returns the luminance of a pixel, cd/m^2, at a time in seconds.
using LuminanceAt = std::function<double(uint32_t column, uint32_t row, double t)>;

/// Runs an event pass over `count` intervals of 10 ms whose pictures come from a formula.
std::vector<EventFrame> events(const Lab& lab, const render::EventDesc& desc, int64_t count,
                               const LuminanceAt& luminance) {
  constexpr int64_t interval_ns = 10'000'000;
  const scene::Scene scene = Stage(false).quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}).build();
  const scene::GpuScene gpu(lab.device(), scene, {.acceleration_structure = false, .textures = false});
  render::EventPass pass(gpu, desc);
  gpu::TickRing ring(lab.device(), 1, 1u << 16, 1u << 20);
  const gpu::Buffer picture(lab.device(), sizeof(float) * desc.width * desc.height, gpu::Memory::device,
                            "luminance");
  const auto take = [&](gpu::TickSlot& slot, uint32_t index, int64_t t_ns) {
    const gpu::Slice staging = slot.upload.allocate(sizeof(float) * desc.width * desc.height);
    for (uint32_t row = 0; row < desc.height; ++row)
      for (uint32_t column = 0; column < desc.width; ++column)
        staging.as<float>()[size_t{row} * desc.width + column] =
            static_cast<float>(luminance(column, row, 1e-9 * static_cast<double>(t_ns)));
    slot.cmd->barrier(gpu::sync::compute_read, gpu::sync::transfer_write);
    slot.cmd->copy(staging, picture.slice());
    slot.cmd->barrier(gpu::sync::transfer_write, gpu::sync::compute_read);
    const gpu::Condition condition(*slot.cmd, pass.condition(index));
    pass.step(slot, index, picture, nullptr, {});
  };
  std::vector<EventFrame> frames;
  for (int64_t k = 0; k <= count; ++k) {
    gpu::TickSlot& slot = ring.begin();
    pass.begin(slot, {std::max<int64_t>(k - 1, 0) * interval_ns, k * interval_ns, k, 0});
    if (k == 0) take(slot, 0, 0);
    for (uint32_t i = 1; k > 0 && i <= desc.substeps; ++i) take(slot, i, pass.time_ns(i));
    pass.end(slot, picture);
    ring.submit(slot);
    ring.wait(slot);
    frames.push_back(pass.collect(slot));
  }
  return frames;
}

render::EventDesc plain_events(uint32_t width, uint32_t height, double threshold) {
  render::EventDesc desc;
  desc.width = width;
  desc.height = height;
  desc.threshold_on = desc.threshold_off = threshold;
  desc.dark_cd_m2 = 1e-6;
  desc.substeps = 1;
  return desc;
}

double total(const std::vector<EventFrame>& frames) {
  double count = 0.0;
  for (const EventFrame& frame : frames) count += static_cast<double>(frame.size());
  return count;
}

constexpr const char* device = "device, fp32";

void n53_black(const Lab& lab, Rows& rows) {
  const double light = lab.given(1.0) - 1.0;  // 0
  rows.add("events, black to black", device, 0.0,
           total(events(lab, plain_events(16, 16, 0.2), 4,
                        [&](uint32_t, uint32_t, double t) { return light * t; })),
           0.0);
}

void n54_thresholds(const Lab& lab, Rows& rows) {
  // A step of exactly one e-fold crosses ten thresholds of 0.1. Adding 0.1 in fp32 finds nine.
  const auto step = [&](uint32_t, uint32_t, double t) {
    return (t > 0 ? 2.7182818 + 1000.0 * (lab.given(1.0) - 1.0) : 1.0) - 1e-6;
  };
  rows.add("events of a step by ten thresholds of 0.1", device, 10.0,
           total(events(lab, plain_events(1, 1, 0.1), 3, step)), 0.0);
  // ln L rises by 40/s from 0: event k fires at k 0.15/40 s.
  const double slope = 40.0, threshold = 0.15;
  const auto frames = events(lab, plain_events(8, 1, threshold), 8,
                             [&](uint32_t, uint32_t, double t) { return std::exp(lab.given(slope) * t); });
  double worst = 0.0, count = 0.0;
  for (size_t interval = 1; interval < frames.size(); ++interval)
    for (size_t i = 0; i < frames[interval].size(); ++i) {
      if (frames[interval].x[i] != 3) continue;
      const double at = 0.01 * static_cast<double>(interval - 1) + 1e-9 * frames[interval].t_ns[i];
      worst = std::max(worst, std::abs(at - ++count * threshold / slope));
    }
  rows.add("events of a ramp of 3.2 at 0.15", device, std::floor(3.2 / threshold), count, 0.0);
  // 7e-7 of each logarithm, thresholds rounded to 2^-24, times to 1 ns (docs/events.md).
  rows.add("largest error of their times, s", device, 0.0, worst, 1e-9 + (7e-7 + 6e-8 * 22) / slope);
}

void n55_still(const Lab& lab, Rows& rows) {
  const double change = lab.given(1.0) - 1.0;  // 0
  rows.add(
      "events of still pictures", device, 0.0,
      total(events(lab, plain_events(32, 8, 0.01), 4,
                   [&](uint32_t x, uint32_t y, double t) { return 1.0 + 3.0 * x * y + 1e6 * change * t; })),
      0.0);
}

void n56_order(const Lab& lab, Rows& rows) {
  const double speed = lab.given(1.0) == 1.0 ? 20.0 : 0.0;
  double unordered = 0.0, ties = 0.0;
  for (const EventFrame& frame :
       events(lab, plain_events(70, 20, 0.05), 4,
              [&](uint32_t x, uint32_t y, double t) { return std::exp(2 + speed * t * ((x / 5 + y) % 3)); }))
    for (size_t i = 1; i < frame.size(); ++i) {
      const auto key = [&](size_t j) {
        return std::tuple(frame.t_ns[j], frame.y[j], frame.x[j], frame.p[j]);
      };
      unordered += !(key(i - 1) < key(i));
      ties += frame.t_ns[i] == frame.t_ns[i - 1];
    }
  rows.add("events out of order (t, y, x, p)", device, 0.0, unordered, 0.0);
  rows.add("1 if there were ties to order", device, 1.0, ties > 100 ? 1.0 : 0.0, 0.0);
}

/// Returns the depth and the instances of a picture of 32 x 32 pixels, 90 degrees wide, that looks along x.
render::CameraImages picture(const Lab& lab, const scene::Scene& scene) {
  scene::GpuScene gpu(lab.device(), scene, {.acceleration_structure = false, .textures = true});
  render::Lighting light;
  light.static_shadow_texels = 128;
  render::CameraEffects effects;
  effects.static_shadows = effects.moving_shadows = effects.specular = false;
  render::SceneLighting lighting(gpu, light, effects);
  render::CameraDesc desc;
  desc.width = desc.height = 32;
  desc.fx = desc.fy = desc.cx = desc.cy = 16.0;
  desc.msaa = 1;
  render::CameraPass camera(lighting, desc);
  gpu::TickRing ring(lab.device(), 1, 1u << 16, 1u << 20);
  gpu::TickSlot& slot = ring.begin();
  const std::vector<Pose> bodies(scene.bodies.size());
  gpu.record_update(slot, bodies);
  lighting.record(slot, bodies);
  camera.record(slot, Pose{}, {});
  ring.submit(slot);
  ring.wait(slot);
  return camera.collect(slot);
}

void n57_depth(const Lab& lab, Rows& rows) {
  struct Walls {
    double distance_m, gap_m;
    const char* name;
  };
  // A reversed depth in fp32 is accurate to 6e-8 of the distance. The planar depth may have one rounding
  // more.
  for (const Walls& walls :
       {Walls{0.2, 1e-6, "0.2 m"}, Walls{1000.0, 1e-3, "1 km"}, Walls{1e4, 0.1, "10 km"}}) {
    Stage stage = lab.stage();
    for (const char* name : {"near", "far"}) {
      const double x = lab.given(walls.distance_m) + (name[0] == 'f' ? walls.gap_m : 0.0),
                   w = 3.0 * walls.distance_m;
      stage.object(name).quad({x, w, -w}, {x, -w, -w}, {x, -w, w}, {x, w, w});
    }
    const scene::Scene scene = stage.build();
    const render::CameraImages images = picture(lab, scene);
    double worst = 0.0, behind = 0.0;
    for (size_t i = 0; i < images.depth.size(); ++i) {
      worst = std::max(worst, std::abs(images.depth[i] / walls.distance_m - 1.0));
      behind += images.instance[i] != 1;
    }
    const std::string name = walls.name;
    rows.add("largest relative error of depth at " + name, device, 0.0, worst, 7e-8);
    rows.add("pixels that see a wall behind the wall at " + name, device, 0.0, behind, 0.0);
  }
}

render::LidarDesc along(const std::vector<dvec3>& directions) {
  render::LidarDesc desc;
  desc.pattern.columns = static_cast<uint32_t>(directions.size());
  desc.pattern.directions = directions;
  desc.pattern.rings.assign(directions.size(), 0);
  desc.pattern.instants.assign(directions.size(), 0);
  desc.pattern.times_s = {0.0};
  desc.returns.mode = render::ReturnMode::all;
  return desc;
}

void n61_split_beam(const Lab& lab, Rows& rows) {
  // A plate at 20 m covers the beam up to y = 4 mm; the rest goes on to a wall at 30 m. Both are white.
  Stage stage = lab.stage();
  stage.object("wall").quad({30, 100, -100}, {30, -100, -100}, {30, -100, 100}, {30, 100, 100});
  const double near = lab.given(20.0);
  stage.object("plate").quad({near, 0.004, -50}, {near, -100, -50}, {near, -100, 50}, {near, 0.004, 50});
  const scene::Scene scene = stage.build();
  render::LidarDesc desc = along({{1, 0, 0}});
  desc.divergence = 0.004;
  desc.rings = 8;
  for (const gpu::Tracer tracer : lab.tracers()) {
    const render::LidarScan scan = lab.sweep(scene, desc, tracer);
    double share = 0.0;
    for (const float part : scan.share) share += part;
    rows.add("returns of a beam over two depths", precision_of(tracer), 2.0, static_cast<double>(scan.size()),
             0.0);
    rows.add("sum of their shares of the energy", precision_of(tracer), 1.0, share, 1e-6);
    // The rays of the beam, tilted by up to 2 mrad, lengthen the mean range by less than 0.1 mm.
    rows.add("range of the first, m", precision_of(tracer), 20.0, scan.size() > 0 ? scan.range_m[0] : 0.0,
             1e-3);
  }
}

void n61_ranges(const Lab& lab, Rows& rows) {
  // Plane x = 80 m, as seen at any angle up to 60 degrees: range 80/cos, intensity rho cos.
  Stage stage = lab.stage();
  const double x = lab.given(80.0);
  stage.object("wall").quad({x, 100, -100}, {x, -100, -100}, {x, -100, 100}, {x, 100, 100});
  const scene::Scene scene = stage.build();
  RandomStream random(61, 1);
  std::vector<dvec3> directions;
  while (directions.size() < 2048) {
    const dvec3 direction = random_direction(random);
    if (direction.x > 0.67) directions.push_back(direction);  // 80 m / 0.67 is within 120 m
  }
  for (const gpu::Tracer tracer : lab.tracers()) {
    const render::LidarScan scan = lab.sweep(scene, along(directions), tracer);
    double range = 0.0, intensity = 0.0;
    for (size_t i = 0; i < scan.size(); ++i) {
      const double cosine = directions[scan.shot[i]].x;
      range = std::max(range, std::abs(scan.range_m[i] - 80.0 / cosine));
      intensity = std::max(intensity, std::abs(static_cast<double>(scan.points[i].w) - cosine));
    }
    rows.add("returns of 2048 shots", precision_of(tracer), 2048.0, static_cast<double>(scan.size()), 0.0);
    // Eight roundings of coordinates and distances below 128 m, 3.8e-6 m each.
    rows.add("largest error of range, m", precision_of(tracer), 0.0, range, 3e-5);
    rows.add("largest error of rho cos(theta)", precision_of(tracer), 0.0, intensity, 1e-6);
  }
}

constexpr Case list_of_sensor_cases[] = {
    {53, "events: logarithm of 0", n53_black},
    {54, "events: on the threshold, and their times", n54_thresholds},
    {55, "events: still pictures", n55_still},
    {56, "events: order of ties", n56_order},
    {57, "depth from 0.2 m to 10 km", n57_depth},
    {61, "LiDAR: beam over two depths", n61_split_beam},
    {61, "LiDAR: ranges on a plane", n61_ranges},
};

}  // namespace

std::span<const Case> sensor_cases() { return list_of_sensor_cases; }

}  // namespace greatx::apps::selftest
