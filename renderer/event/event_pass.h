// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns linear luminance into events and difference images (docs/events.md). A camera takes pictures at
// several instants of each interval between two samples. This pass turns each step from one picture to the
// next into events, on the GPU, and keeps the state of every pixel from tick to tick. The model of a pixel is
// shaders/shared/events.h.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/tick_ring.h"
#include "renderer/event/event_sort.h"
#include "renderer/event/reprojection.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/events.h"

namespace greatx::render {

/// Names the rule by which pictures are taken within an interval.
enum class EventSteps {
  fixed,  ///< at each of `substeps` even instants
  /// At only as many even instants as keep the motion from picture to picture to `wanted` pixels.
  by_flow,
  /// At only as many even instants as keep the change of every pixel to `wanted` thresholds.
  by_brightness,
  /// At each of `substeps` even instants. Between two pictures, each pixel looks at so many of `instants`
  /// even instants as keep its own motion to `wanted` pixels (docs/events.md, "Reconstructed instants").
  by_pixel,
};

struct EventDesc {
  std::string name = "event camera";  ///< for labels, timestamps and messages
  uint32_t width = 640, height = 480;
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0;  ///< pixels; used only by by_flow
  uint32_t substeps = 4;                          ///< even instants per interval, at most most_substeps
  EventSteps steps = EventSteps::fixed;
  uint32_t instants = shared::most_instants;       ///< by_pixel: between two pictures, at most most_instants
  bool smooth_edges = false;                       ///< by_pixel: the pictures have them
  double wanted = 0.5;                             ///< largest motion or change of adaptive steps
  double threshold_on = 0.2, threshold_off = 0.2;  ///< change of the natural logarithm, 0.01 to 1
  double threshold_sigma = 0.0;                    ///< standard deviation from pixel to pixel
  double refractory_s = 0.0;
  double leak_rate_hz = 0.0;
  double shot_rate_hz = 0.0;
  double cutoff_hz = 0.0;       ///< 0: unlimited bandwidth
  double dark_cd_m2 = 1e-3;     ///< added before the logarithm
  double bright_cd_m2 = 1e3;    ///< luminance of relative intensity 1, for bandwidth and shot noise
  uint32_t capacity = 1 << 20;  ///< room for events per interval
  bool events = true, instance = false, differences = false;
  double difference_on_cd_m2 = 1.0, difference_off_cd_m2 = 1.0;
  uint64_t seed = 0;
  uint32_t stream = 0;  ///< identifies the sensor, unique within a run
  /// Returns whether the device decides which pictures are taken.
  bool adaptive() const { return steps == EventSteps::by_flow || steps == EventSteps::by_brightness; }
};

/// Thresholds of a pixel stay within these bounds, whatever the mismatch draws (0.01: v2e, ESIM).
inline constexpr double least_threshold = 0.01, largest_threshold = 2.0;

/// Holds the interval from the sample before to this one.
struct EventInterval {
  int64_t begin_ns = 0, end_ns = 0;  ///< after the beginning of the sequence
  int64_t sample = 0;
  uint32_t sequence = 0;
};

/// Holds the events and pictures of an interval, in order of (t, y, x, p).
struct EventFrame {
  std::vector<uint32_t> t_ns;  ///< after the interval's start, 1 to its length
  std::vector<uint16_t> x, y;  ///< column, row
  std::vector<uint8_t> p;      ///< 1: brighter, 0: darker
  std::vector<uint32_t> instance;
  uint64_t dropped = 0;            ///< events beyond the capacity
  uint32_t pictures = 0;           ///< pictures taken, without the one that the interval begins with
  uint32_t coarse = 0;             ///< the number of those that moved or changed more than wanted
  double largest = 0.0;            ///< motion or change from picture to picture; only with adaptive steps
  std::vector<int8_t> difference;  ///< [height, width]: 1, 0, -1
  size_t size() const { return t_ns.size(); }
};

/// Holds what is known of an interval beside its events.
struct EventCounts {
  size_t events = 0;     ///< that were kept
  uint64_t dropped = 0;  ///< as in EventFrame
  uint32_t pictures = 0, coarse = 0;
  double largest = 0.0;
};

/// Says where the columns of sorted events go. `instance` may be null.
template <typename Time>
struct EventColumns {
  Time* t_ns;
  uint16_t *x, *y;
  uint8_t* p;
  uint32_t* instance;
  Time begin_ns;  ///< added to the times after the interval's start
};

class EventPass {
 public:
  /// Builds the pipelines that `desc` needs. `scene` outlives this. Throws UserError naming the sensor and
  /// the field if a value is out of its range or the device cannot do adaptive steps.
  EventPass(const scene::GpuScene& scene, const EventDesc& desc);

  /// Forgets everything: the picture of the next interval sets the references.
  void restart() { first_ = true; }
  bool first() const { return first_; }

  /// Begins an interval in the slot's command buffer. In the first interval, step() takes one picture, of
  /// index 0. Otherwise it takes one for each index from 1 to substeps, in order.
  void begin(gpu::TickSlot& slot, const EventInterval& interval);
  /// Returns the word that says whether the picture is taken. gpu::Condition uses it around everything that
  /// makes the picture, step() included. If the slice is empty, the picture is always taken.
  gpu::Slice condition(uint32_t index) const;
  /// Returns the instant of the picture, after the beginning of the sequence.
  int64_t time_ns(uint32_t index) const;
  /// `luminance` is float [height * width], cd/m^2. `seen` is as CameraPass::seen(), for `instance` and
  /// by_flow, else null. A compute shader writes both, and one reads them until end(). `motions` has one
  /// element a body, for by_flow.
  void step(gpu::TickSlot& slot, uint32_t index, const gpu::Buffer& luminance, const gpu::Buffer* seen,
            std::span<const shared::EventMotion> motions, const PixelPaths* paths = nullptr);
  /// Returns the buffers for the cells of the next picture, which are recorded before step(); null unless
  /// by_pixel. `paths` of step() leads from the picture before to that one.
  const gpu::Buffer* next_cells() const { return reprojection_ ? &reprojection_->next() : nullptr; }
  /// Ends the interval; `luminance` is that of the last picture.
  void end(gpu::TickSlot& slot, const gpu::Buffer& luminance);

  /// Returns the interval that was recorded into `slot`, once its submission is done.
  EventFrame collect(const gpu::TickSlot& slot);
  // The same in parts, for callers that have memory for the events.
  EventCounts counts(const gpu::TickSlot& slot) const;
  /// Writes counts().events events, in order of (t, y, x, p).
  void sort_into(const gpu::TickSlot& slot, const EventColumns<int64_t>& columns);
  /// Returns [height, width]: 1, 0, -1; empty without differences. Valid until the slot is begun again.
  std::span<const int8_t> difference(const gpu::TickSlot& slot) const;

  const EventDesc& desc() const { return desc_; }
  /// Returns whether step() reads the view of the pixels.
  bool needs_seen() const {
    return desc_.steps == EventSteps::by_flow || (desc_.instance && desc_.steps != EventSteps::by_pixel);
  }

 private:
  struct Pending {
    gpu::Slice control, events, instances, difference;
    EventInterval interval;
    bool first = false;
  };
  void check() const;
  void build_pipelines();
  void create_resources();
  void upload_thresholds();
  void upload_objects();
  shared::EventModel model() const;
  shared::EventConstants constants(uint32_t index) const;
  void bind(gpu::Cmd& cmd, const gpu::ComputePipeline& pipeline, uint32_t index);
  const Pending& recorded(const gpu::TickSlot& slot) const;
  template <typename Time>
  void sort_columns(const gpu::TickSlot& slot, const EventColumns<Time>& columns);

  const scene::GpuScene* scene_;
  EventDesc desc_;
  gpu::ComputePipeline begin_, step_, scan_, emit_, difference_;
  gpu::Buffer model_, control_, runs_, objects_, nothing_;
  gpu::Buffer pixels_, extra_, before_, awake_, thresholds_, previous_;
  std::vector<Pending> pending_;  ///< by slot
  Pending now_;                   ///< being recorded
  std::vector<gpu::Descriptor> descriptors_;
  EventSorter<ListedEvent> sorter_;
  EventSorter<ListedEventOfInstance> instance_sorter_;
  std::vector<ListedEventOfInstance> with_instance_;
  bool first_ = true;
  std::optional<Reprojection> reprojection_;  ///< by_pixel
  std::string scope_, difference_scope_;
};

}  // namespace greatx::render
