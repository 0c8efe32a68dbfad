// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/camera_sensor.h"

#include <cmath>

#include "sim/consistency.h"
#include "sim/sensors/sensor_metadata.h"

namespace greatx::sim {

namespace {

constexpr uint32_t probes_per_picture = 256;

render::CameraDesc camera_desc(const NodeConfig& node, const SensorConfig& sensor, uint32_t body) {
  const auto& config = std::get<CameraConfig>(sensor.config);
  render::CameraDesc desc;
  desc.name = node.name + "/" + sensor.name;
  desc.width = config.width;
  desc.height = config.height;
  desc.fx = config.fx;
  desc.fy = config.fy;
  desc.cx = config.cx;
  desc.cy = config.cy;
  desc.near_m = config.near_m;
  desc.msaa = config.msaa;
  desc.exposure_ev100 = config.exposure.ev100;
  desc.outputs = {config.rgb, config.depth || config.depth_png24 || config.depth_log,
                  config.ids, config.ids,
                  config.ids, config.hdr};
  if (body != 0 && !config.see_own_body) desc.excluded_body = body;
  return desc;
}

/// Ids as 16-bit pictures where they fit.
Array narrow_ids(const std::vector<uint32_t>& ids, std::vector<int64_t> shape) {
  Array array(DType::u16, std::move(shape));
  std::transform(ids.begin(), ids.end(), array.as<uint16_t>().begin(),
                 [](uint32_t id) { return static_cast<uint16_t>(id); });
  return array;
}

bool fits_16_bits(size_t instances) { return instances < 65535; }

}  // namespace

CameraSensor::CameraSensor(Stage& stage, const render::ProbePass* probe, const Scenario& scenario,
                           uint32_t node, uint32_t sensor)
    : stage_(stage),
      world_(stage.world()),
      config_(std::get<CameraConfig>(scenario.nodes[node].sensors[sensor].config)),
      node_(node),
      mount_(mount_pose(scenario.nodes[node].sensors[sensor].mount)),
      pass_(stage.lighting(), camera_desc(scenario.nodes[node], scenario.nodes[node].sensors[sensor],
                                          world_.body_of_node[node])),
      probe_(pass_.desc().outputs.depth ? probe : nullptr) {
  spec_.name = pass_.desc().name;
  spec_.kind = "camera";
  spec_.rate = scenario.nodes[node].sensors[sensor].rate_hz.str();
  describe(config_, world_.scene.instances.size());
  if (probe_ != nullptr) probe_pixels_ = probe_pixels(config_.width, config_.height, probes_per_picture);
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
    array("depth", DType::f32, {h, w}, "m", "[row, column] planar depth at the pixel's centre; sky: +inf");
    if (config.depth) output("depth", FileFormat::exr, "depth");
    if (config.depth_png24) output("depth24", FileFormat::png_depth24, "depth");
  }
  if (config.depth_log) {
    array("depth_log", DType::f32, {h, w}, "1", "[row, column] ln(planar depth in metres + 1); sky: +inf");
    output("depth_log", FileFormat::exr, "depth_log");
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
  nlohmann::json metadata;
  metadata["width"] = w;
  metadata["height"] = h;
  metadata["fx"] = config.fx;
  metadata["fy"] = config.fy;
  metadata["cx"] = config.cx;
  metadata["cy"] = config.cy;
  metadata["pixel_center"] = 0.5;
  metadata["near_m"] = config.near_m;
  metadata["msaa"] = config.msaa;
  metadata["exposure_ev100"] = config.exposure.ev100;
  metadata["depth"] = "planar";
  metadata["optical_frame"] = "x right, y down, z forward";
  metadata["body_from_sensor"] = json_of(mount_);
  spec_.metadata_json = metadata.dump();
}

void CameraSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  const Pose local_from_sensor = world_.scene.to_local(context.nodes[node_].pose) * mount_;
  pass_.record(slot, local_from_sensor);
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
  if (config_.ids) {
    if (fits_16_bits(world_.scene.instances.size()))
      arrays.push_back(narrow_ids(images_.instance, shape));
    else
      arrays.push_back(Array::of<uint32_t>(shape, images_.instance));
    arrays.push_back(Array::of<uint8_t>(shape, images_.semantic));
    arrays.push_back(Array::of<uint16_t>(shape, images_.material));
  }
  return arrays;
}

void CameraSensor::check(const gpu::TickSlot& slot) {
  const std::span<const shared::ProbeHit> hits = probe_hits_[slot.index].as<shared::ProbeHit>();
  for (size_t i = 0; i < probe_pixels_.size(); ++i) {
    const glm::uvec2 pixel = probe_pixels_[i];
    if (!interior_plane(images_, pixel.x, pixel.y)) continue;
    const double depth = images_.depth[size_t{pixel.y} * images_.width + pixel.x];
    if (depth <= pass_.desc().near_m || hits[i].t <= pass_.desc().near_m) continue;
    depth_errors_.add(std::abs(depth - hits[i].t) / depth);
  }
}

void CameraSensor::report(Consistency& consistency) const { consistency.depth.add(depth_errors_); }

}  // namespace greatx::sim
