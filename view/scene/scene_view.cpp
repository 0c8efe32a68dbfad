// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/scene/scene_view.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

#include <spdlog/spdlog.h>

#include "draw/paths/render.h"
#include "renderer/camera/camera.h"
#include "renderer/light/lighting.h"
#include "scene/device/gpu_scene.h"
#include "sim/plan/camera_desc.h"
#include "sim/plan/plan_options.h"
#include "sim/world/posed_scene.h"
#include "view/scene/moment_cache.h"

namespace greatx::view {

namespace {

using WallClock = std::chrono::steady_clock;

render::CameraDesc desc_of(const SceneRequest& request) {
  render::CameraDesc desc;
  desc.name = request.fine ? "view, fine" : "view";
  desc.width = request.view.width;
  desc.height = request.view.height;
  desc.fx = request.view.fx;
  desc.fy = request.view.fy;
  desc.cx = request.view.cx;
  desc.cy = request.view.cy;
  desc.near_m = request.view.near_m;
  desc.distortion = request.view.distortion;
  desc.excluded_body = request.excluded_body;
  desc.automatic_exposure = true;  // by day and by night
  desc.msaa = 1;
  desc.smooth_edges = request.fine;
  desc.outputs = {.rgb = true, .depth = true, .instance = true, .semantic = false, .material = true};
  return desc;
}

bool same_lens(const render::Distortion& a, const render::Distortion& b) {
  return std::tie(a.k1, a.k2, a.p1, a.p2, a.k3) == std::tie(b.k1, b.k2, b.p1, b.p2, b.k3);
}

/// Whether a pass of `have` draws the pictures of `want`.
bool same_pass(const render::CameraDesc& have, const render::CameraDesc& want) {
  return have.width == want.width && have.height == want.height && have.fx == want.fx && have.fy == want.fy &&
         have.cx == want.cx && have.cy == want.cy && have.near_m == want.near_m &&
         same_lens(have.distortion, want.distortion) && have.excluded_body == want.excluded_body &&
         have.smooth_edges == want.smooth_edges;
}

/// Draws pictures on the thread that makes it.
class Renderer {
 public:
  Renderer(const std::shared_ptr<const sim::Experiment>& experiment, const gpu::DeviceOptions& options)
      : moments_(experiment),
        plan_(apps::picture_plan(*experiment)),
        device_(options),
        gpu_scene_(device_, experiment->scene(), sim::gpu_scene_options(plan_)),
        ring_(device_, 2, upload_bytes, readback_bytes),
        lighting_(gpu_scene_, sim::lighting_of(experiment->scenario.environment, experiment->plan),
                  sim::camera_effects(plan_)) {}

  std::shared_ptr<const ScenePicture> draw(const SceneRequest& request) {
    const WallClock::time_point begin = WallClock::now();
    const sim::Moment& moment = moments_.at(request.sequence, request.tick);
    render::CameraPass& pass = pass_for(request);
    gpu::TickSlot& slot = ring_.begin();
    sim::set_lamps(gpu_scene_, moment.context, moment.context.time_s);
    gpu_scene_.record_update(slot, moment.bodies);
    lighting_.record(slot, moment.bodies);
    pass.record(slot, request.view.local_from_sensor);
    ring_.submit(slot);
    ring_.wait(slot);
    render::CameraImages images = pass.collect(slot);
    auto picture = std::make_shared<ScenePicture>();
    picture->request = request;
    picture->rgb = std::move(images.rgb);
    picture->depth = std::move(images.depth);
    picture->instance = std::move(images.instance);
    picture->material = std::move(images.material);
    picture->bodies = moment.bodies;
    picture->nodes = moment.motions;
    picture->milliseconds = std::chrono::duration<double, std::milli>(WallClock::now() - begin).count();
    return picture;
  }

  std::vector<std::string> validation_messages() { return device_.validation_log()->take(); }

 private:
  static constexpr VkDeviceSize upload_bytes = 1 << 20, readback_bytes = 16 << 20;

  /// The passes are kept: one that moves and one that rests, and those of cameras that were looked through.
  render::CameraPass& pass_for(const SceneRequest& request) {
    const render::CameraDesc desc = desc_of(request);
    const auto found =
        std::ranges::find_if(passes_, [&](const auto& pass) { return same_pass(pass->desc(), desc); });
    if (found != passes_.end()) {
      std::rotate(passes_.begin(), found, found + 1);
    } else {
      if (passes_.size() == most_passes) passes_.pop_back();
      passes_.insert(passes_.begin(), std::make_unique<render::CameraPass>(lighting_, desc));
    }
    return *passes_.front();
  }

  static constexpr size_t most_passes = 4;
  MomentCache moments_;
  const sim::EffectPlan plan_;
  gpu::Device device_;
  scene::GpuScene gpu_scene_;
  gpu::TickRing ring_;
  render::SceneLighting lighting_;
  std::vector<std::unique_ptr<render::CameraPass>> passes_;  ///< the one used last is the first
};

}  // namespace

class SceneView::Worker {
 public:
  Worker(std::shared_ptr<const sim::Experiment> experiment, gpu::DeviceOptions device,
         std::vector<uint64_t> lost_at)
      : experiment_(std::move(experiment)),
        lost_at_(std::move(lost_at)),
        thread_([this, device] { run(device); }) {}
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

  void look(const SceneRequest& request) {
    {
      const std::lock_guard lock(mutex_);
      waiting_ = request;
    }
    wake_.notify_one();
  }
  std::shared_ptr<const ScenePicture> picture() const {
    const std::lock_guard lock(mutex_);
    return picture_;
  }
  std::string error() const {
    const std::lock_guard lock(mutex_);
    return error_;
  }
  uint64_t version() const {
    const std::lock_guard lock(mutex_);
    return version_;
  }

 private:
  void run(const gpu::DeviceOptions& options) {
    try {
      std::optional<SceneRequest> failed;
      do {
        failed = draw_until_lost(options, failed);
      } while (failed);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      error_ = error.what();
      ++version_;
    }
  }
  /// Draws until there is nothing more to draw, or until the device fails: returns the request that it failed
  /// at. Throws if that is the request that it failed at before.
  std::optional<SceneRequest> draw_until_lost(const gpu::DeviceOptions& options,
                                              const std::optional<SceneRequest>& failed) {
    Renderer renderer(experiment_, options);
    if (failed) draw(renderer, *failed);
    while (const std::optional<SceneRequest> request = next()) try {
        draw(renderer, *request);
      } catch (const gpu::VulkanError& error) {
        spdlog::warn("{}: the device of the scene's picture is opened anew", error.what());
        return request;
      }
    return {};
  }
  void draw(Renderer& renderer, const SceneRequest& request) {
    if (std::ranges::find(lost_at_, draws_++) != lost_at_.end())
      throw gpu::VulkanError(VK_ERROR_DEVICE_LOST, "a picture, on purpose");
    publish(renderer.draw(request));
    const std::vector<std::string> messages = renderer.validation_messages();
    if (!messages.empty())
      throw std::runtime_error("the validation layer on the device of the scene's picture: " +
                               messages.front());
  }
  std::optional<SceneRequest> next() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [&] { return quit_ || waiting_; });
    return quit_ ? std::nullopt : std::exchange(waiting_, std::nullopt);
  }
  void publish(std::shared_ptr<const ScenePicture> picture) {
    const std::lock_guard lock(mutex_);
    picture_ = std::move(picture);
    ++version_;
  }

  const std::shared_ptr<const sim::Experiment> experiment_;
  const std::vector<uint64_t> lost_at_;
  uint64_t draws_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool quit_ = false;
  std::optional<SceneRequest> waiting_;
  std::shared_ptr<const ScenePicture> picture_;
  std::string error_;
  uint64_t version_ = 0;
  std::thread thread_;  ///< the last member: it uses the others
};

SceneView::SceneView(std::shared_ptr<const sim::Experiment> experiment, gpu::DeviceOptions device,
                     std::vector<uint64_t> lost_at)
    : worker_(std::make_unique<Worker>(std::move(experiment), std::move(device), std::move(lost_at))) {}
SceneView::~SceneView() = default;
void SceneView::look(const SceneRequest& request) { worker_->look(request); }
std::shared_ptr<const ScenePicture> SceneView::picture() const { return worker_->picture(); }
std::string SceneView::error() const { return worker_->error(); }
uint64_t SceneView::version() const { return worker_->version(); }

}  // namespace greatx::view
