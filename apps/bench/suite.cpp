// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/bench/measure.h"
#include "apps/bench/suite_embree.h"
#include "apps/bench/suite_output.h"
#include "apps/bench/suite_passes.h"
#include "apps/bench/suite_tick.h"
#include "apps/console/progress.h"
#include "apps/console/summary.h"
#include "core/parallel.h"
#include "core/utc.h"

namespace greatx::apps {

namespace {

constexpr int64_t suite_schema = 1;
/// Triangles of the scenes in which bodies, lamps and receivers grow.
constexpr uint64_t middle_triangles = 20'000;
/// A row whose runs take longer than this altogether ends early, but not before three runs.
constexpr double row_seconds = 20.0;
constexpr uint64_t triangle_sizes[] = {1'000, 10'000, 20'000, 100'000, 1'000'000, 10'000'000};
constexpr uint64_t quick_triangles = 100'000;

/// A scene to measure: what grows, and how large it is.
struct Step {
  std::string axis;
  uint64_t size = 0;
  SuiteSceneSize scene;
  SuiteWork work;
  std::vector<SuiteKind> kinds;
  bool embree = false;
  bool whole_ticks = false;
  /// Returns the expected duration, in units that only the progress knows: rows first, then triangles.
  int64_t weight() const {
    const int64_t rows = static_cast<int64_t>(kinds.size()) + (whole_ticks ? 4 : 0);
    return 20 * rows + static_cast<int64_t>(scene.triangles / 10'000);
  }
};

std::vector<Step> suite_steps(const SuiteOptions& options) {
  const uint64_t most = std::min(options.most_triangles, options.quick ? quick_triangles : uint64_t(-1)),
                 middle = std::min(middle_triangles, most);
  const std::vector<SuiteKind> tracing{SuiteKind::single_rays, SuiteKind::lidar, SuiteKind::crossings,
                                       SuiteKind::candidates, SuiteKind::radar};
  std::vector<SuiteKind> all = tracing;
  all.push_back(SuiteKind::camera);
  all.push_back(SuiteKind::events);
  std::vector<Step> steps;
  for (const uint64_t triangles : triangle_sizes)
    if (triangles <= most) steps.push_back({"triangles", triangles, {triangles, 0, 0}, {}, all, true, true});
  for (const uint32_t bodies : {1u, 10u, 100u})
    steps.push_back({"bodies", bodies, {middle, bodies, 0}, {}, all, false, true});
  for (const uint32_t lamps : {1u, 10u, 100u, 1000u})
    steps.push_back({"lamps", lamps, {middle, 0, lamps}, {}, {SuiteKind::lamps}, false, false});
  for (const uint32_t receivers : {1u, 10u, 100u, 1000u}) {
    Step step{"receivers", receivers, {middle, 0, 0}, {}, {SuiteKind::crossings}, false, false};
    step.work.rays = receivers;  // the lines of sight from one mast
    steps.push_back(step);
  }
  return steps;
}

/// Returns the memory that the system can still give, bytes; no limit where it does not say.
uint64_t available_bytes() {
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  for (uint64_t kibibytes = 0; file >> name >> kibibytes; std::getline(file, unit))
    if (name == "MemAvailable:") return kibibytes * 1024;
  return ~uint64_t{0};
}

/// Holds one tracer's copy of the scene on the device.
struct Stage {
  std::string tracer;
  std::unique_ptr<scene::GpuScene> scene;
};

/// Collects the times of a row.
struct Times {
  std::vector<double> wall_ms, cpu_ms;
  double total_ms = 0.0;
  template <typename Work>
  void measure(const Work& work) {
    const double cpu_before = cpu_milliseconds();
    const Clock::time_point begin = Clock::now();
    work();
    wall_ms.push_back(milliseconds_since(begin));
    cpu_ms.push_back(cpu_milliseconds() - cpu_before);
    total_ms += wall_ms.back();
  }
};

class Suite {
 public:
  Suite(const RunOptions& run, const SuiteOptions& options, bool quiet)
      : options_(options),
        device_options_(run.device_options()),
        device_(device_options_),
        ring_(device_, 1, 1u << 20, 1u << 20),
        steps_(suite_steps(options)),
        progress_("suite", total(steps_), quiet, "") {
    if (run.tracer == gpu::Tracer::automatic)
      for (const gpu::Tracer tracer : {gpu::Tracer::tree, gpu::Tracer::driver}) {
        if (tracer != gpu::Tracer::driver || device_.info().has_ray_query()) tracers_.push_back(tracer);
      }
    else
      tracers_.push_back(run.tracer);
    result_ = {{"greatx_suite", suite_schema},
               {"greatx", GREATX_VERSION},
               {"device", suite_device(device_.info())},
               {"cores", usable_cores()},
               {"date", utc_text(std::time(nullptr))},
               {"embree", SuiteEmbree::version()},
               {"quick", options.quick},
               {"repeats", options.repeats},
               {"finished", false},
               {"rows", nlohmann::json::array()},
               {"scenes", nlohmann::json::array()}};
  }

  nlohmann::json run() {
    install_interrupt_handler();
    progress_.update(0);
    for (const Step& step : steps_) {
      measure(step);
      done_ += step.weight();
      progress_.update(done_);
      write_suite(options_.folder, result_);
    }
    result_["finished"] = true;
    write_suite(options_.folder, result_);
    check_validation(device_);
    return result_;
  }

 private:
  static int64_t total(const std::vector<Step>& steps) {
    int64_t sum = 0;
    for (const Step& step : steps) sum += step.weight();
    return sum;
  }

  void measure(const Step& step) {
    const uint64_t needed = suite_bytes(step.scene.triangles, tracers_.size()), free = available_bytes();
    if (needed > free) {
      skip(step, "all",
           fmt::format("needs about {} MiB of memory, {} MiB are free", needed >> 20, free >> 20));
      return;
    }
    try {
      const SuiteScene scene = make_suite_scene(step.scene);
      std::vector<Stage> stages;
      for (const gpu::Tracer tracer : tracers_) upload(step, scene, tracer, stages);
      for (size_t i = 0; i < step.kinds.size(); ++i) {
        measure(step, scene, step.kinds[i], stages);
        progress_.update(done_ + step.weight() * int64_t(i + 1) / int64_t(step.kinds.size()));
      }
      stages.clear();  // the simulator has a copy of its own
      if (step.whole_ticks) measure_ticks(step, scene);
      result_["scenes"].push_back({{"axis", step.axis},
                                   {"size", step.size},
                                   {"triangles", scene.scene.triangle_count()},
                                   {"bodies", step.scene.bodies},
                                   {"lamps", step.scene.lamps},
                                   {"side_m", scene.side_m},
                                   {"expected_bytes", needed},
                                   {"peak_rss_bytes", peak_rss_bytes()}});
    } catch (const UserError& error) {
      skip(step, "all", error.what());
    } catch (const std::bad_alloc&) {
      skip(step, "all", "the memory is used up");
    }
  }

  /// Brings the scene to the device for a tracer: the row of the set-up, measured once.
  void upload(const Step& step, const SuiteScene& scene, gpu::Tracer tracer, std::vector<Stage>& stages) {
    Stage stage{std::string(gpu::name_of(tracer)), nullptr};
    Times times;
    times.measure([&] {
      stage.scene = std::make_unique<scene::GpuScene>(
          device_, scene.scene, scene::GpuSceneOptions{.textures = false, .tracer = tracer});
    });
    if (step.axis == "triangles")
      add(step, "set-up", "scene", "triangles", stage.tracer, step.scene.triangles, times);
    stages.push_back(std::move(stage));
  }

  /// Measures a pass with every tracer in turns, and with Embree.
  void measure(const Step& step, const SuiteScene& scene, SuiteKind kind, const std::vector<Stage>& stages) {
    const SuiteKindInfo& info = info_of(kind);
    const size_t count = info.traces ? stages.size() : 1;
    std::vector<std::unique_ptr<SuitePass>> passes;
    std::vector<std::vector<SuiteAnswer>> answers;
    std::vector<Times> times(count);
    try {
      for (size_t i = 0; i < count; ++i) {
        passes.push_back(make_suite_pass(kind, *stages[i].scene, scene, step.work));
        answers.push_back(submit(stages[i], *passes[i], suite_poses(scene, 0)));  // warms up, too
      }
    } catch (const UserError& error) {
      skip(step, info.name, error.what());
      return;
    }
    for (uint32_t round = 0; round < options_.repeats && !long_enough(times, round); ++round) {
      const std::vector<Pose> poses = suite_poses(scene, round + 1);
      for (size_t i = 0; i < count; ++i)
        times[i].measure([&] { record_and_wait(stages[i], *passes[i], poses); });
      stop_if_interrupted();
    }
    for (size_t i = 0; i < count; ++i) {
      nlohmann::json& row =
          add(step, info.name, info.modality, info.unit, info.traces ? stages[i].tracer : "raster",
              suite_count(kind, step.work), times[i]);
      if (i > 0) row["differing"] = count_differing(answers[0], answers[i]);
    }
    if (step.embree && !SuiteEmbree::version().empty()) beside(step, scene, kind, answers[0]);
  }

  /// Measures ticks of all modalities with every tracer, one after the other.
  void measure_ticks(const Step& step, const SuiteScene& scene) {
    const uint64_t needed = suite_tick_bytes(step.scene.triangles), free = available_bytes();
    if (needed > free) {
      skip(step, "whole tick",
           fmt::format("needs about {} MiB more memory, {} MiB are free", needed >> 20, free >> 20));
      return;
    }
    for (const gpu::Tracer tracer : tracers_) {
      Times times;
      try {
        gpu::DeviceOptions options = device_options_;
        options.tracer = tracer;
        gpu::Device device(options);
        SuiteTick tick(device, scene);
        tick.run();  // warms up
        for (uint32_t round = 0; round < options_.repeats && !long_enough({times}, round); ++round) {
          times.measure([&] { tick.run(); });
          stop_if_interrupted();
        }
        check_validation(device);
      } catch (const UserError& error) {
        skip(step, "whole tick", error.what());
        return;
      }
      add(step, "whole tick", "all", "ticks", std::string(gpu::name_of(tracer)), SuiteTick::ticks_of_a_run,
          times);
    }
  }

  /// Adds the row of Embree, if it can trace the rays of the pass.
  void beside(const Step& step, const SuiteScene& scene, SuiteKind kind,
              const std::vector<SuiteAnswer>& answers) {
    bool closest = true;
    const std::vector<SuiteRay> rays = suite_rays(kind, scene, step.work, closest);
    if (rays.empty()) return;
    const SuiteEmbree embree(scene.scene);
    const std::vector<SuiteAnswer> other = embree.trace(rays, closest);
    std::vector<Times> times(1);
    for (uint32_t round = 0; round < options_.repeats && !long_enough(times, round); ++round)
      times[0].measure([&] { embree.trace(rays, closest); });
    const SuiteKindInfo& info = info_of(kind);
    add(step, info.name, info.modality, info.unit, "embree", rays.size(), times[0])["differing"] =
        count_differing(answers, other);
  }

  static bool long_enough(const std::vector<Times>& times, uint32_t round) {
    double total_ms = 0.0;
    for (const Times& each : times) total_ms += each.total_ms;
    return round >= 3 && total_ms > 1e3 * row_seconds;
  }

  gpu::TickSlot& record_and_wait(const Stage& stage, SuitePass& pass, const std::vector<Pose>& poses) {
    gpu::TickSlot& slot = ring_.begin();
    stage.scene->record_update(slot, poses);
    pass.record(slot, poses);
    ring_.submit(slot);
    ring_.wait(slot);
    pass.collect(slot);
    return slot;
  }
  std::vector<SuiteAnswer> submit(const Stage& stage, SuitePass& pass, const std::vector<Pose>& poses) {
    record_and_wait(stage, pass, poses);
    return pass.answers(poses);
  }

  void stop_if_interrupted() {
    if (!interrupted()) return;
    write_suite(options_.folder, result_);
    throw Interrupted(fmt::format("bench --suite: {} rows are measured and written to '{}'",
                                  result_["rows"].size(), options_.folder.string()));
  }

  nlohmann::json& add(const Step& step, const std::string& pass, const std::string& modality,
                      const std::string& unit, const std::string& tracer, uint64_t count,
                      const Times& times) {
    nlohmann::json row{{"axis", step.axis},
                       {"size", step.size},
                       {"pass", pass},
                       {"modality", modality},
                       {"tracer", tracer},
                       {"unit", unit},
                       {"count", count},
                       {"wall_ms", distribution(times.wall_ms)},
                       {"cpu_ms", distribution(times.cpu_ms)}};
    const auto per_second = [count](const nlohmann::json& ms) {
      return 1e3 * static_cast<double>(count) / std::max(1e-6, ms["median"].get<double>());
    };
    row["per_second"] = per_second(row["wall_ms"]);
    row["per_core_second"] = per_second(row["cpu_ms"]);
    return result_["rows"].emplace_back(std::move(row));
  }
  void skip(const Step& step, const std::string& pass, const std::string& reason) {
    result_["rows"].push_back(
        {{"axis", step.axis}, {"size", step.size}, {"pass", pass}, {"skipped", reason}});
  }

  const SuiteOptions options_;
  const gpu::DeviceOptions device_options_;
  gpu::Device device_;
  gpu::TickRing ring_;
  std::vector<Step> steps_;
  Progress progress_;
  std::vector<gpu::Tracer> tracers_;
  nlohmann::json result_;
  int64_t done_ = 0;
};

}  // namespace

nlohmann::json run_suite(const RunOptions& run, const SuiteOptions& options, bool quiet) {
  return Suite(run, options, quiet).run();
}

std::string suite_text(const nlohmann::json& result) { return suite_markdown(result); }

}  // namespace greatx::apps
