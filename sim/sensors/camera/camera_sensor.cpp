// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/camera/camera_sensor.h"

#include <cmath>

#include "sim/compare/consistency.h"
#include "sim/plan/camera_desc.h"
#include "sim/sensors/camera/box_arrays.h"
#include "sim/sensors/camera/camera_metadata.h"

namespace greatx::sim {

namespace {

constexpr uint32_t probes_per_picture = 256;

/// Returns ids as 16-bit values.
Array narrow_ids(const std::vector<uint32_t>& ids, std::vector<int64_t> shape) {
  Array array(DType::u16, std::move(shape));
  std::transform(ids.begin(), ids.end(), array.as<uint16_t>().begin(),
                 [](uint32_t id) { return static_cast<uint16_t>(id); });
  return array;
}

/// Returns whether every pixel looks from one instant, along the straight ray of a pinhole camera.
bool is_pinhole(const render::CameraDesc& desc) {
  return !desc.distortion.any() && !desc.wide.any() && desc.bands == 0;
}

bool fits_16_bits(size_t instances) { return instances < 65535; }

}  // namespace

CameraSensor::CameraSensor(PosedScene& posed, const render::ProbePass* probe, const Scenario& scenario,
                           uint32_t node, uint32_t sensor)
    : posed_(posed),
      world_(posed.world()),
      config_(std::get<CameraConfig>(scenario.nodes[node].sensors[sensor].config)),
      node_(node),
      mount_(mount_pose(scenario.nodes[node].sensors[sensor].mount)),
      clock_(scenario.tick_rate_hz),
      times_(scenario.tick_rate_hz, scenario.nodes[node].sensors[sensor].rate_hz),
      pass_(posed.lighting(), camera_desc(scenario, scenario.nodes[node],
                                          scenario.nodes[node].sensors[sensor], world_.body_of_node[node])),
      probe_(pass_.desc().outputs.depth && is_pinhole(pass_.desc()) ? probe : nullptr) {
  spec_.name = pass_.desc().name;
  spec_.kind = "camera";
  spec_.rate = scenario.nodes[node].sensors[sensor].rate_hz.str();
  describe(config_, world_.scene.instances.size());
  if (probe_ != nullptr) probe_pixels_ = probe_pixels(config_.width, config_.height, probes_per_picture);
  if (const render::TruthOutputs outputs = truth_outputs(config_); outputs.any())
    truth_ = std::make_unique<render::TruthPass>(posed.lighting(), pass_.desc(), outputs);
  if (!config_.boxes) return;
  boxes_ = std::make_unique<Boxes>(world_.scene, pass_.desc(), config_.box_classes);
  node_of_body_.assign(world_.scene.bodies.size(), -1);
  for (size_t i = 0; i < world_.body_of_node.size(); ++i)
    if (const uint32_t body = world_.body_of_node[i]; body != 0)
      node_of_body_[body] = static_cast<int32_t>(i);
}

void CameraSensor::describe(const CameraConfig& config, size_t instances) {
  const int64_t h = config.height, w = config.width;
  const auto array = [&](const char* name, DType dtype, std::vector<int64_t> shape, const char* unit,
                         const char* text) {
    spec_.arrays.push_back({name, dtype, std::move(shape), unit, text});
  };
  const auto output = [&](const char* name, FileFormat format, const char* source) {
    spec_.outputs.push_back({name, format, {source}});
  };
  if (config.rgb) {
    array("rgb", DType::u8, {h, w, 3}, "1", "[row, column, channel] sRGB");
    output("rgb", FileFormat::png, "rgb");
  }
  if (config.hdr) {
    array("hdr", DType::f32, {h, w, 3}, "cd/m^2", "[row, column, channel] linear Rec. 709 luminance");
    output("hdr", FileFormat::exr, "hdr");
  }
  if (config.depth || config.depth_png24) {
    array("depth", DType::f32, {h, w}, "m",
          config.wide.any() ? "[row, column] distance along the pixel's ray; nothing there: +inf"
                            : "[row, column] planar depth at the pixel's centre; sky: +inf");
    if (config.depth) output("depth", config.depth_exr ? FileFormat::exr : FileFormat::npy_frame, "depth");
    if (config.depth_png24) output("depth24", FileFormat::png_depth24, "depth");
  }
  if (config.depth_log) {
    array("depth_log", DType::f32, {h, w}, "1",
          config.wide.any() ? "[row, column] ln(distance in metres + 1); nothing there: +inf"
                            : "[row, column] ln(planar depth in metres + 1); sky: +inf");
    output("depth_log", FileFormat::exr, "depth_log");
  }
  if (config.depth_ray) {
    array("depth_ray", DType::f32, {h, w}, "m", "[row, column] distance along the pixel's ray; sky: +inf");
    output("depth_ray", FileFormat::exr, "depth_ray");
  }
  if (config.normals) {
    array("normals", DType::f32, {h, w, 3}, "1",
          "[row, column, xyz] surface normal on the camera's side, unit, world axes; sky: 0");
    output("normals", FileFormat::exr, "normals");
  }
  if (config.flow) {
    array("flow", DType::f32, {h, w, 2}, "pixel",
          "[row, column, uv] motion to the camera's next picture, right and down; NaN: out of sight then");
    output("flow", FileFormat::npy_frame, "flow");
  }
  if (config.ids) {
    const bool narrow = fits_16_bits(instances);
    array("instance", narrow ? DType::u16 : DType::u32, {h, w}, "1",
          "[row, column] index into instances + 1; 0: nothing");
    array("semantic", DType::u8, {h, w}, "1",
          "[row, column] index into semantic_classes; 0: nothing or unlabeled");
    array("material", DType::u16, {h, w}, "1", "[row, column] index into materials + 1; 0: nothing");
    output("instance", narrow ? FileFormat::png : FileFormat::npy_frame, "instance");
    output("semantic", FileFormat::png, "semantic");
    output("material", FileFormat::png, "material");
  }
  if (config.boxes) describe_boxes(spec_);
  if (config.rgb && config.exposure.automatic) {
    array("ev100", DType::f32, {}, "EV", "exposure that the meter set, at ISO 100");
    output("ev100", FileFormat::npy_stack, "ev100");
  }
  spec_.metadata_json = camera_metadata(config, mount_).dump();
}

TruthMoment CameraSensor::next_sample(const TickContext& context) const {
  const int64_t next = times_.tick_of(times_.sample_at(context.tick) + 1);
  const double time_s = clock_.seconds(next);
  return {world_.scene.to_local(context.motion_at(node_, time_s).pose) * mount_,
          context.body_poses_at(time_s)};
}

/// Records the instants of an exposure, evenly around the tick. The tick itself comes last, since depth and
/// ids of the picture are those of the tick.
void CameraSensor::expose(gpu::TickSlot& slot, const TickContext& context, const Pose& local_from_sensor) {
  const render::FrameNumber frame{context.sequence, context.tick, context.nodes[node_].velocity};
  if (config_.rolling.any()) return expose_rows(slot, context);
  const uint32_t instants = config_.motion_blur_samples;
  if (!pass_.desc().parts) return pass_.record(slot, local_from_sensor, frame);
  const float weight = 1.0f / static_cast<float>(instants);
  bool first = true;
  posed_.at_instants(slot, context, [&](Instants& at) {
    for (uint32_t i = 0; i < instants; ++i) {
      if (i == instants / 2) continue;
      const double time_s = context.time_s + *config_.exposure.shutter_s * ((i + 0.5) / instants - 0.5);
      at.move_to(time_s);
      const Pose pose = world_.scene.to_local(context.motion_at(node_, time_s).pose) * mount_;
      pass_.record(slot, pose, frame, {.weight = weight, .first = first, .last = false});
      first = false;
    }
  });
  pass_.record(slot, local_from_sensor, frame, {.weight = weight, .first = false, .last = true});
}

/// Records the bands of a rolling shutter, each at the instant of its middle row.
void CameraSensor::expose_rows(gpu::TickSlot& slot, const TickContext& context) {
  const render::FrameNumber frame{context.sequence, context.tick};
  const uint32_t bands = pass_.bands();
  posed_.at_instants(slot, context, [&](Instants& at) {
    for (uint32_t band = 0; band < bands; ++band) {
      const double time_s = context.time_s + config_.rolling.readout_s * pass_.middle_of_band(band);
      at.move_to(time_s);
      const Pose pose = world_.scene.to_local(context.motion_at(node_, time_s).pose) * mount_;
      pass_.record(slot, pose, frame, {.first = band == 0, .last = band + 1 == bands, .band = band});
    }
  });
}

void CameraSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  const Pose local_from_sensor = world_.scene.to_local(context.nodes[node_].pose) * mount_;
  expose(slot, context, local_from_sensor);
  if (truth_) {
    TruthMoment next{local_from_sensor, {context.body_poses.begin(), context.body_poses.end()}};
    if (config_.flow) next = next_sample(context);
    truth_->record(slot, pass_.seen(), {local_from_sensor, context.body_poses},
                   {next.local_from_sensor, next.bodies});
  }
  if (boxes_)
    moments_[slot.index] = {local_from_sensor, {context.body_poses.begin(), context.body_poses.end()}};
  if (probe_ == nullptr) return;
  std::vector<shared::ProbeRay> rays;
  for (const glm::uvec2& pixel : probe_pixels_)
    rays.push_back({vec3(local_from_sensor.position),
                    vec3(local_from_sensor.rotate(pixel_ray(pass_.desc(), pixel.x + 0.5, pixel.y + 0.5)))});
  probe_hits_[slot.index] = probe_->record(slot, rays, pass_.desc().excluded_body);
}

std::vector<Array> CameraSensor::collect(const gpu::TickSlot& slot) {
  images_ = pass_.collect(slot);
  if (probe_ != nullptr) check(slot);
  const std::vector<int64_t> shape{config_.height, config_.width};
  const std::vector<int64_t> color_shape{config_.height, config_.width, 3};
  std::vector<Array> arrays;
  if (config_.rgb) arrays.push_back(Array::of<uint8_t>(color_shape, images_.rgb));
  if (config_.hdr) arrays.push_back(Array::of<float>(color_shape, images_.hdr));
  if (config_.depth || config_.depth_png24) arrays.push_back(Array::of<float>(shape, images_.depth));
  if (config_.depth_log) {
    Array log(DType::f32, shape);
    std::transform(images_.depth.begin(), images_.depth.end(), log.as<float>().begin(),
                   [](float z) { return std::log1p(z); });
    arrays.push_back(std::move(log));
  }
  if (truth_) {
    const render::TruthImages truth = truth_->collect(slot);
    if (config_.depth_ray) arrays.push_back(Array::of<float>(shape, truth.depth_ray));
    if (config_.normals) arrays.push_back(Array::of<float>(color_shape, truth.normals));
    if (config_.flow) arrays.push_back(Array::of<float>({config_.height, config_.width, 2}, truth.flow));
  }
  if (config_.ids) {
    if (fits_16_bits(world_.scene.instances.size()))
      arrays.push_back(narrow_ids(images_.instance, shape));
    else
      arrays.push_back(Array::of<uint32_t>(shape, images_.instance));
    arrays.push_back(Array::of<uint8_t>(shape, images_.semantic));
    arrays.push_back(Array::of<uint16_t>(shape, images_.material));
  }
  if (boxes_) {
    const TruthMoment& moment = moments_[slot.index];
    const std::vector<ObjectBox> found =
        boxes_->find(moment.local_from_sensor, moment.bodies, images_.instance);
    for (Array& array : box_arrays(*boxes_, found, node_of_body_)) arrays.push_back(std::move(array));
  }
  if (config_.rgb && config_.exposure.automatic)
    arrays.push_back(Array::of<float>({}, std::span(&images_.ev100, 1)));
  return arrays;
}

void CameraSensor::check(const gpu::TickSlot& slot) {
  depth_errors_ = {};
  const std::span<const shared::ProbeHit> hits = probe_hits_[slot.index].as<shared::ProbeHit>();
  for (size_t i = 0; i < probe_pixels_.size(); ++i) {
    const glm::uvec2 pixel = probe_pixels_[i];
    if (!interior_plane(images_, pixel.x, pixel.y)) continue;
    const double depth = images_.depth[size_t{pixel.y} * images_.width + pixel.x];
    if (depth <= pass_.desc().near_m || hits[i].t <= pass_.desc().near_m) continue;
    // Rays take a material with holes as solid, while a picture filters its mask, so the two may rightly see
    // different surfaces there.
    if (hits[i].primitive != 0 && world_.scene.has_holes(hits[i].primitive - 1)) continue;
    depth_errors_.add(std::abs(depth - hits[i].t) / depth);
  }
}

Evidence CameraSensor::evidence() const {
  Evidence evidence;
  if (probe_ != nullptr) evidence.pixels_against_rays = &depth_errors_;
  if (is_pinhole(pass_.desc()) && !images_.depth.empty())
    evidence.depth = {node_, mount_, &pass_.desc(), &images_};
  return evidence;
}

}  // namespace greatx::sim
