// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/event/event_pass.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "gpu/condition.h"
#include "renderer/event/event_sort.h"

namespace greatx::render {

namespace {

constexpr uint32_t pattern_sequence = ~0u;  ///< sequence of draws that belong to the sensor alone

constexpr uint32_t groups(uint32_t count, uint32_t size) { return (count + size - 1) / size; }

/// Converts a threshold to fixed point. It rounds down, so that k thresholds never exceed k times the given
/// number.
int32_t fixed_threshold(double c) { return static_cast<int32_t>(std::floor(c * shared::log_one)); }

glm::uvec2 key_of(const EventDesc& desc, uint32_t sequence) {
  const uint64_t bits = RandomStream(desc.seed, desc.stream, sequence).bits();
  return {static_cast<uint32_t>(bits), static_cast<uint32_t>(bits >> 32)};
}

/// Returns the thresholds leaked by then, in 32.32 fixed point.
uint64_t turns_at(double rate_hz, int64_t t_ns) {
  __extension__ using Wide = unsigned __int128;
  const auto rate = static_cast<uint64_t>(std::llround(rate_hz * 0x1p32));
  return static_cast<uint64_t>(Wide{rate} * static_cast<uint64_t>(t_ns) / 1'000'000'000u);
}

}  // namespace

EventPass::EventPass(const scene::GpuScene& scene, const EventDesc& desc)
    : scene_(&scene),
      desc_(desc),
      scope_(desc.name + " events"),
      difference_scope_(desc.name + " differences") {
  check();
  build_pipelines();
  create_resources();
}

void EventPass::check() const {
  const auto require = [&](bool holds, const char* field, const char* expected, double found) {
    if (!holds)
      throw_user_error("event camera {}: {}: expected {}, found {}", desc_.name, field, expected, found);
  };
  constexpr uint32_t largest_edge = 16384;  // 14 bits of an event's place
  require(desc_.width >= 1 && desc_.width <= largest_edge, "width", "1 to 16384", desc_.width);
  require(desc_.height >= 1 && desc_.height <= largest_edge, "height", "1 to 16384", desc_.height);
  constexpr uint64_t pixel_bytes = 8;  // size of the largest value kept per pixel
  const uint64_t pixels = uint64_t{desc_.width} * desc_.height,
                 most_pixels = scene_->device().limits().maxStorageBufferRange / pixel_bytes;
  if (pixels > most_pixels)
    throw_user_error("event camera {}: width, height: expected at most {} pixels on '{}', found {} x {}",
                     desc_.name, most_pixels, scene_->device().info().name, desc_.width, desc_.height);
  require(desc_.substeps >= 1 && desc_.substeps <= shared::most_substeps, "steps", "1 to 64", desc_.substeps);
  require(desc_.threshold_on >= least_threshold && desc_.threshold_on <= 1.0, "threshold", "0.01 to 1",
          desc_.threshold_on);
  require(desc_.threshold_off >= least_threshold && desc_.threshold_off <= 1.0, "threshold", "0.01 to 1",
          desc_.threshold_off);
  require(desc_.threshold_sigma >= 0.0 && desc_.threshold_sigma <= 0.5, "threshold.sigma", "0 to 0.5",
          desc_.threshold_sigma);
  require(desc_.refractory_s >= 0.0 && desc_.refractory_s <= 1.0, "refractory_s", "0 to 1",
          desc_.refractory_s);
  require(desc_.leak_rate_hz >= 0.0 && desc_.leak_rate_hz <= 10.0, "leak_rate_hz", "0 to 10",
          desc_.leak_rate_hz);
  require(desc_.shot_rate_hz >= 0.0 && desc_.shot_rate_hz <= 1000.0, "shot_rate_hz", "0 to 1000",
          desc_.shot_rate_hz);
  require(desc_.cutoff_hz >= 0.0 && desc_.cutoff_hz <= 1e6, "cutoff_hz", "0 to 1e6", desc_.cutoff_hz);
  require(desc_.dark_cd_m2 >= 1e-6 && desc_.dark_cd_m2 <= 1e6, "dark_cd_m2", "1e-6 to 1e6", desc_.dark_cd_m2);
  require(desc_.bright_cd_m2 >= 1e-6 && desc_.bright_cd_m2 <= 1e9, "bright_cd_m2", "1e-6 to 1e9",
          desc_.bright_cd_m2);
  require(desc_.capacity >= 1 && desc_.capacity <= 1u << 28, "max_events_per_pixel",
          "room for 1 to 268435456 events an interval", desc_.capacity);
  require(desc_.instants >= 1 && desc_.instants <= shared::most_instants, "steps.most", "1 to 256",
          desc_.instants);
  require(desc_.steps == EventSteps::fixed || desc_.wanted > 0.0, "steps", "a positive motion or change",
          desc_.wanted);
  if (desc_.adaptive() && !gpu::has_conditions(scene_->device()))
    throw_user_error(
        "event camera {}: steps: expected a number, for adaptive ones need VK_EXT_conditional_rendering, "
        "which "
        "'{}' does not have",
        desc_.name, scene_->device().info().name);
}

void EventPass::build_pipelines() {
  gpu::Device& device = scene_->device();
  if (desc_.differences) {
    gpu::ComputeDesc compute;
    compute.shader = "event/difference.comp";
    compute.bindings = {{shared::event_previous_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                        {shared::event_luminance_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    compute.push_constant_bytes = sizeof(shared::DifferenceConstants);
    difference_ = gpu::ComputePipeline(device, compute, difference_scope_);
  }
  if (!desc_.events) return;
  gpu::ComputeDesc compute;
  for (const uint32_t slot :
       {shared::event_model_binding, shared::event_control_binding, shared::event_runs_binding,
        shared::event_objects_binding, shared::event_motion_binding, shared::event_luminance_binding,
        shared::event_seen_binding, shared::event_pixel_binding, shared::event_extra_binding,
        shared::event_before_binding, shared::event_awake_binding, shared::event_threshold_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::EventConstants);
  compute.specialization.resize(shared::event_spec_count);
  compute.specialization[shared::event_spec_mismatch] = desc_.threshold_sigma > 0.0;
  compute.specialization[shared::event_spec_leak] = desc_.leak_rate_hz > 0.0;
  compute.specialization[shared::event_spec_shot] = desc_.shot_rate_hz > 0.0;
  compute.specialization[shared::event_spec_refractory] = desc_.refractory_s > 0.0;
  compute.specialization[shared::event_spec_bandwidth] = desc_.cutoff_hz > 0.0;
  compute.specialization[shared::event_spec_instance] = desc_.instance;
  compute.specialization[shared::event_spec_adaptive] =
      desc_.adaptive() ? static_cast<uint32_t>(desc_.steps) : 0;
  const auto build = [&](gpu::ComputePipeline& pipeline, const char* name) {
    compute.shader = std::string("event/") + name + ".comp";
    pipeline = gpu::ComputePipeline(device, compute, desc_.name + " " + name);
  };
  build(begin_, "begin");
  build(step_, "step");
  build(scan_, "scan");
  build(emit_, "emit");
  if (desc_.steps == EventSteps::by_pixel) reprojection_.emplace(*scene_, desc_, compute.specialization);
}

void EventPass::create_resources() {
  gpu::Device& device = scene_->device();
  const auto pixels = [&](gpu::Buffer& to, size_t bytes, bool wanted, const char* what) {
    const size_t size = wanted ? bytes * desc_.width * desc_.height : 0;
    to = gpu::Buffer(device, size, gpu::Memory::device, desc_.name + " " + what);
  };
  const bool extra = desc_.cutoff_hz > 0.0 || desc_.refractory_s > 0.0;
  pixels(previous_, sizeof(float), desc_.differences, "picture before");
  pixels(pixels_, sizeof(glm::ivec2), desc_.events, "pixels");
  pixels(extra_, sizeof(glm::ivec2), desc_.events && extra, "pixels' delays");
  pixels(before_, sizeof(glm::ivec2), desc_.events, "pixels before");
  pixels(awake_, sizeof(int32_t), desc_.events && desc_.refractory_s > 0.0, "pixels asleep before");
  upload_thresholds();
  const shared::EventModel block = model();
  model_ = gpu::upload_buffer(device, std::as_bytes(std::span(&block, 1)), desc_.name + " model");
  control_ = gpu::Buffer(device, sizeof(shared::EventControl), gpu::Memory::device, desc_.name + " control",
                         gpu::condition_usage(device));
  runs_ =
      gpu::Buffer(device, sizeof(shared::EventRun) * groups(desc_.width, shared::run_pixels) * desc_.height,
                  gpu::Memory::device, desc_.name + " runs");
  nothing_ = gpu::Buffer(device, 0, gpu::Memory::device, desc_.name + " nothing");
  upload_objects();
}

shared::EventModel EventPass::model() const {
  shared::EventModel block{};
  block.width = desc_.width;
  block.height = desc_.height;
  block.on = fixed_threshold(desc_.threshold_on);
  block.off = fixed_threshold(desc_.threshold_off);
  block.dark = static_cast<float>(desc_.dark_cd_m2);
  block.bright = static_cast<float>(desc_.bright_cd_m2);
  block.angular_cutoff = static_cast<float>(2.0 * pi * desc_.cutoff_hz * 1e-9);
  block.shot_rate_hz = static_cast<float>(desc_.shot_rate_hz);
  block.refractory_ns = static_cast<int32_t>(std::llround(desc_.refractory_s * 1e9));
  block.capacity = desc_.capacity;
  block.fx = static_cast<float>(desc_.fx);
  block.fy = static_cast<float>(desc_.fy);
  block.cx = static_cast<float>(desc_.cx);
  block.cy = static_cast<float>(desc_.cy);
  block.wanted = static_cast<float>(desc_.wanted);
  const glm::uvec2 key = key_of(desc_, pattern_sequence);
  block.pattern_seed = key.x;
  block.pattern_stream = key.y;
  return block;
}

void EventPass::upload_thresholds() {
  const glm::uvec2 key = key_of(desc_, pattern_sequence);
  const bool wanted = desc_.events && desc_.threshold_sigma > 0.0;
  std::vector<glm::ivec2> values(wanted ? size_t(desc_.width) * desc_.height : 0);
  for (uint32_t pixel = 0; pixel < values.size(); ++pixel) {
    const glm::uvec4 words = shared::random_bits(key.x, key.y, 0, pixel, 0);
    // Box and Muller's method gives two normal numbers, one for each threshold.
    const double radius = std::sqrt(-2.0 * std::log((words.x + 0.5) * 0x1p-32));
    const double angle = 2.0 * pi * words.y * 0x1p-32;
    const auto threshold = [&](double c, double normal) {
      return fixed_threshold(
          std::clamp(c + desc_.threshold_sigma * normal, least_threshold, largest_threshold));
    };
    values[pixel] = {threshold(desc_.threshold_on, radius * std::cos(angle)),
                     threshold(desc_.threshold_off, radius * std::sin(angle))};
  }
  thresholds_ =
      gpu::upload_buffer(scene_->device(), std::as_bytes(std::span(values)), desc_.name + " thresholds");
}

void EventPass::upload_objects() {
  std::vector<glm::uvec2> objects;
  if (needs_seen()) {
    const scene::Scene& scene = scene_->scene();
    objects.resize(scene.indices.size() / 3);
    for (const scene::Primitive& primitive : scene.primitives)
      std::fill_n(objects.begin() + primitive.first_index / 3, primitive.index_count / 3,
                  glm::uvec2(primitive.instance + 1, scene.instances[primitive.instance].body));
  }
  objects_ = gpu::upload_buffer(scene_->device(), std::as_bytes(std::span(objects)), desc_.name + " objects");
}

void EventPass::begin(gpu::TickSlot& slot, const EventInterval& interval) {
  GREATX_CHECK(interval.begin_ns >= 0 &&
                   (first_ || (interval.end_ns > interval.begin_ns &&
                               interval.end_ns - interval.begin_ns <= shared::longest_interval_ns)),
               "{}: interval from {} to {} ns", desc_.name, interval.begin_ns, interval.end_ns);
  now_ = {};
  now_.interval = interval;
  now_.first = first_;
  first_ = false;
  if (!desc_.events) return;
  if (!now_.first) {
    now_.events = slot.readback.allocate_for<shared::uvec2>(desc_.capacity);
    if (desc_.instance) now_.instances = slot.readback.allocate_for<uint32_t>(desc_.capacity);
  }
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  if (desc_.adaptive())
    cmd.barrier(
        {gpu::sync::condition_read.stage | VK_PIPELINE_STAGE_2_TRANSFER_BIT | gpu::sync::compute.stage,
         gpu::sync::compute.access},
        gpu::sync::compute);
  else
    cmd.barrier({VK_PIPELINE_STAGE_2_TRANSFER_BIT | gpu::sync::compute.stage, gpu::sync::compute.access},
                gpu::sync::compute);
  descriptors_.clear();
  for (const auto& [binding, buffer] : {std::pair{shared::event_model_binding, &model_},
                                        {shared::event_control_binding, &control_},
                                        {shared::event_runs_binding, &runs_},
                                        {shared::event_objects_binding, &objects_},
                                        {shared::event_pixel_binding, &pixels_},
                                        {shared::event_extra_binding, &extra_},
                                        {shared::event_before_binding, &before_},
                                        {shared::event_awake_binding, &awake_},
                                        {shared::event_threshold_binding, &thresholds_},
                                        {shared::event_luminance_binding, &nothing_},
                                        {shared::event_seen_binding, &nothing_},
                                        {shared::event_motion_binding, &nothing_}})
    descriptors_.push_back(gpu::Descriptor::buffer(binding, *buffer));
  bind(cmd, begin_, now_.first ? 0 : 1);
  cmd.dispatch(1);
  if (desc_.adaptive())
    cmd.barrier(gpu::sync::compute_write, {gpu::sync::condition_read.stage | gpu::sync::compute.stage,
                                           gpu::sync::condition_read.access | gpu::sync::compute.access});
}

gpu::Slice EventPass::condition(uint32_t index) const {
  if (!desc_.adaptive() || !desc_.events || now_.first || index == desc_.substeps) return {};
  return control_.slice().part(shared::event_due_offset + sizeof(uint32_t) * index, sizeof(uint32_t));
}

int64_t EventPass::time_ns(uint32_t index) const {
  const auto length = static_cast<uint32_t>(now_.interval.end_ns - now_.interval.begin_ns);
  return now_.interval.begin_ns + shared::grid_time(length, desc_.substeps, index);
}

shared::EventConstants EventPass::constants(uint32_t index) const {
  const glm::uvec2 key = key_of(desc_, now_.interval.sequence);
  shared::EventConstants constants{};
  constants.events = now_.events.address;
  constants.instances = now_.instances.address;
  const auto length = static_cast<uint32_t>(now_.interval.end_ns - now_.interval.begin_ns);
  const uint64_t leaked = turns_at(desc_.leak_rate_hz, now_.interval.begin_ns),
                 leak = turns_at(desc_.leak_rate_hz, now_.interval.end_ns) - leaked;
  const uint32_t before = std::max(index, 1u) - 1;
  constants.leaked_from = shared::leak_at(leaked, leak, desc_.substeps, before);
  constants.leaked_to = shared::leak_at(leaked, leak, desc_.substeps, index);
  constants.from_ns = shared::grid_time(length, desc_.substeps, before);
  constants.to_ns = shared::grid_time(length, desc_.substeps, index);
  constants.interval_ns = length;
  constants.grid = desc_.substeps;
  constants.index = index;
  constants.noise_seed = key.x;
  constants.noise_stream = key.y;
  constants.noise_sample = static_cast<uint32_t>(now_.interval.sample);
  return constants;
}

void EventPass::bind(gpu::Cmd& cmd, const gpu::ComputePipeline& pipeline, uint32_t index) {
  cmd.bind(pipeline);
  cmd.push(descriptors_);
  cmd.constants(constants(index));
}

void EventPass::step(gpu::TickSlot& slot, uint32_t index, const gpu::Buffer& luminance,
                     const gpu::Buffer* seen, std::span<const shared::EventMotion> motions,
                     const PixelPaths* paths) {
  GREATX_CHECK((index == 0) == now_.first && index <= desc_.substeps, "{}: picture {} of {}", desc_.name,
               index, desc_.substeps);
  if (!desc_.events) return;
  GREATX_CHECK((seen != nullptr) == needs_seen(), "{}: what pixels see is needed: {}", desc_.name,
               needs_seen());
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::compute);
  for (gpu::Descriptor& descriptor : descriptors_) {
    if (descriptor.slot == shared::event_luminance_binding)
      descriptor = gpu::Descriptor::buffer(descriptor.slot, luminance);
    if (descriptor.slot == shared::event_seen_binding && seen != nullptr)
      descriptor = gpu::Descriptor::buffer(descriptor.slot, *seen);
    if (descriptor.slot == shared::event_motion_binding && !motions.empty())
      descriptor = gpu::Descriptor::buffer(descriptor.slot, slot.upload.put(motions));
  }
  if (reprojection_) reprojection_->take();
  if (reprojection_ && index > 0) {
    GREATX_CHECK(paths != nullptr, "{}: the paths of pixels are needed", desc_.name);
    return reprojection_->record(slot, descriptors_, constants(index), *paths, pixels_, extra_);
  }
  const uint32_t runs = groups(desc_.width, shared::run_pixels) * desc_.height;
  bind(cmd, step_, index);
  cmd.dispatch_linear(runs, shared::event_group_size);
  if (index == 0 && !desc_.adaptive()) return;
  cmd.barrier(gpu::sync::compute_write, gpu::sync::compute);
  bind(cmd, scan_, index);
  cmd.dispatch(1);
  if (index > 0) {
    cmd.barrier(gpu::sync::compute_write, gpu::sync::compute);
    bind(cmd, emit_, index);
    cmd.dispatch_linear(runs, shared::event_group_size);
  }
  if (desc_.adaptive())
    cmd.barrier(gpu::sync::compute_write, {gpu::sync::condition_read.stage | gpu::sync::compute.stage,
                                           gpu::sync::condition_read.access | gpu::sync::compute.access});
}

void EventPass::end(gpu::TickSlot& slot, const gpu::Buffer& luminance) {
  gpu::Cmd& cmd = *slot.cmd;
  if (desc_.differences) {
    const auto scope = cmd.scope(difference_scope_);
    const uint32_t words = groups(desc_.width * desc_.height, 4);
    now_.difference = slot.readback.allocate_for<uint32_t>(words);
    cmd.barrier(gpu::sync::compute_write, gpu::sync::compute);
    shared::DifferenceConstants constants{};
    constants.picture = now_.difference.address;
    constants.width = desc_.width;
    constants.height = desc_.height;
    constants.on = static_cast<float>(desc_.difference_on_cd_m2);
    constants.off = static_cast<float>(desc_.difference_off_cd_m2);
    constants.first = now_.first;
    cmd.bind(difference_);
    cmd.push({gpu::Descriptor::buffer(shared::event_previous_binding, previous_),
              gpu::Descriptor::buffer(shared::event_luminance_binding, luminance)});
    cmd.constants(constants);
    cmd.dispatch_linear(words, shared::event_group_size);
  }
  if (desc_.events) {
    now_.control = slot.readback.allocate(sizeof(shared::EventControl));
    cmd.barrier(gpu::sync::compute_write, gpu::sync::transfer_read);
    cmd.copy(control_.slice(), now_.control);
  }
  if (pending_.size() <= slot.index) pending_.resize(slot.index + 1);
  pending_[slot.index] = now_;
}

namespace {

/// Writes the sorted events column by column: such loops become vector code.
template <typename Event, typename Time>
void unpack(const std::vector<Event>& sorted, const EventColumns<Time>& to) {
  const Event* const from = sorted.data();
  const size_t count = sorted.size();
  for (size_t i = 0; i < count; ++i) to.t_ns[i] = to.begin_ns + Time{from[i].t_ns};
  for (size_t i = 0; i < count; ++i) to.x[i] = static_cast<uint16_t>(from[i].place >> 1 & 0x3fffu);
  for (size_t i = 0; i < count; ++i) to.y[i] = static_cast<uint16_t>(from[i].place >> 15);
  for (size_t i = 0; i < count; ++i) to.p[i] = static_cast<uint8_t>(from[i].place & 1u);
  if constexpr (std::is_same_v<Event, ListedEventOfInstance>)
    for (size_t i = 0; i < count; ++i) to.instance[i] = from[i].instance;
}

}  // namespace

const EventPass::Pending& EventPass::recorded(const gpu::TickSlot& slot) const {
  GREATX_CHECK(slot.index < pending_.size(), "{}: nothing was recorded into slot {}", desc_.name, slot.index);
  return pending_[slot.index];
}

EventCounts EventPass::counts(const gpu::TickSlot& slot) const {
  const Pending& from = recorded(slot);
  EventCounts counts;
  if (!desc_.events || from.first) return counts;
  const shared::EventControl& control = from.control.as<shared::EventControl>()[0];
  counts.events = std::min(control.events, desc_.capacity);
  counts.dropped = control.events - counts.events;
  counts.pictures = desc_.adaptive() ? control.pictures : desc_.substeps;
  counts.coarse = control.coarse;
  counts.largest = shared::uintBitsToFloat(control.largest);
  return counts;
}

std::span<const int8_t> EventPass::difference(const gpu::TickSlot& slot) const {
  if (!desc_.differences) return {};
  return recorded(slot).difference.as<int8_t>().first(size_t(desc_.width) * desc_.height);
}

template <typename Time>
void EventPass::sort_columns(const gpu::TickSlot& slot, const EventColumns<Time>& columns) {
  const size_t count = counts(slot).events;
  if (count == 0) return;
  const Pending& from = recorded(slot);
  const auto interval_ns = static_cast<uint32_t>(from.interval.end_ns - from.interval.begin_ns);
  const std::span<const ListedEvent> listed = from.events.as<ListedEvent>().first(count);
  if (!desc_.instance) {
    sorter_.sort(listed, interval_ns);
    return unpack(sorter_.sorted(), columns);
  }
  const std::span<const uint32_t> instances = from.instances.as<uint32_t>();
  with_instance_.resize(count);
  for (size_t i = 0; i < count; ++i) with_instance_[i] = {listed[i], instances[i]};
  instance_sorter_.sort(with_instance_, interval_ns);
  unpack(instance_sorter_.sorted(), columns);
}

void EventPass::sort_into(const gpu::TickSlot& slot, const EventColumns<int64_t>& columns) {
  sort_columns(slot, columns);
}

EventFrame EventPass::collect(const gpu::TickSlot& slot) {
  const EventCounts of = counts(slot);
  EventFrame frame;
  frame.t_ns.resize(of.events);
  frame.x.resize(of.events);
  frame.y.resize(of.events);
  frame.p.resize(of.events);
  if (desc_.instance) frame.instance.resize(of.events);
  frame.dropped = of.dropped;
  frame.pictures = of.pictures;
  frame.coarse = of.coarse;
  frame.largest = of.largest;
  const std::span<const int8_t> change = difference(slot);
  frame.difference.assign(change.begin(), change.end());
  sort_columns<uint32_t>(
      slot, {frame.t_ns.data(), frame.x.data(), frame.y.data(), frame.p.data(), frame.instance.data(), 0});
  return frame;
}

}  // namespace greatx::render
