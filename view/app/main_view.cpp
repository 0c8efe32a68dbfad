// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/main_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/same_pose.h"
#include "core/units.h"
#include "sim/plan/camera_desc.h"
#include "view/app/overlay_dots.h"
#include "view/app/overlay_panel.h"
#include "view/window/style.h"

namespace greatx::view {

namespace {

constexpr double vertical_fov = 50.0 * pi / 180.0;
constexpr double rest_s = 0.15;  ///< without a change, after which the picture is made fine
/// The same while a run plays. A fine picture costs several coarse ones, and the next tick replaces it.
constexpr double playing_rest_s = 1.0;
constexpr double turn_per_pixel = 0.005, zoom_per_turn = 0.85;
constexpr double fly_per_s = 0.7;  ///< of the distance to the pivot
constexpr float drag_px = 4.0f;    ///< a click moves less
/// While the view moves, a picture has this share of the columns and rows.
constexpr double coarse_share = 0.5;

/// Whether two requests show the same, whatever their quality.
bool same_view(const SceneRequest& a, const SceneRequest& b) {
  return same_pose(a.view.local_from_sensor, b.view.local_from_sensor) && a.sequence == b.sequence &&
         a.tick == b.tick && a.excluded_body == b.excluded_body;
}
bool same_request(const SceneRequest& a, const SceneRequest& b) {
  return same_view(a, b) && a.fine == b.fine && a.view.width == b.view.width &&
         a.view.height == b.view.height && a.view.fx == b.view.fx;
}

dvec3 keys_pressed() {
  const auto axis = [](int plus, int minus) {
    return (ImGui::IsKeyDown(plus) ? 1.0 : 0.0) - (ImGui::IsKeyDown(minus) ? 1.0 : 0.0);
  };
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl || io.KeyAlt || io.WantTextInput) return dvec3(0.0);
  return {axis('W', 'S'), axis('A', 'D'), axis('E', 'Q')};
}

Array rgb_array(const ScenePicture& picture, std::span<const uint8_t> rgb) {
  return Array::of<uint8_t>({picture.request.view.height, picture.request.view.width, 3}, rgb);
}

}  // namespace

MainView::~MainView() {
  if (texture_ != nullptr) window_.drop_texture(texture_);
}

/// Finds what is followed, and the camera that is looked through, in the changed experiment.
void MainView::keep_names(const sim::Experiment& before, const sim::Experiment& after) {
  const auto& nodes = after.scenario.nodes;
  if (followed_) {
    const auto found =
        std::ranges::find(nodes, before.scenario.nodes.at(*followed_).name, &sim::NodeConfig::name);
    follow(found == nodes.end() ? std::nullopt : std::optional(static_cast<uint32_t>(found - nodes.begin())));
  }
  if (!camera_) return;
  const sim::NodeConfig& node = before.scenario.nodes.at(camera_->node);
  const std::string name = node.name + "/" + node.sensors.at(camera_->sensor).name;
  const std::optional<sim::SensorPlace> place = sim::find_sensor(nodes, name);
  camera_.reset();
  if (place && apps::can_look_through(nodes[place->node].sensors[place->sensor]))
    camera_ = apps::CameraName{place->node, place->sensor};
}

std::unique_ptr<SceneView> MainView::set_scene(std::shared_ptr<const sim::Experiment> experiment,
                                               std::unique_ptr<SceneView> scene) {
  const std::shared_ptr<const sim::Experiment> before = std::exchange(experiment_, std::move(experiment));
  std::unique_ptr<SceneView> old = std::exchange(scene_, std::move(scene));
  moments_.emplace(experiment_);
  map_.reset();
  painted_.reset();
  has_asked_ = false;
  painted_version_ = ~uint64_t{0};
  if (before == nullptr) {
    look_from_outside();
  } else {
    keep_names(*before, *experiment_);
    if (before->world != experiment_->world) picked_.reset();
  }
  return old;
}

void MainView::look_from_outside() {
  if (experiment_ == nullptr) return;
  scene::Bounds bounds = experiment_->scene().bounds;
  if (bounds.empty()) bounds = {dvec3(-10.0), dvec3(10.0)};
  bounds.min += experiment_->scene().origin;
  bounds.max += experiment_->scene().origin;
  viewpoint_ = Viewpoint::outside(bounds);
  camera_.reset();
  follow({});
}

void MainView::follow(std::optional<uint32_t> node) {
  followed_ = node;
  followed_at_ = dvec3(std::numeric_limits<double>::quiet_NaN());
}

SceneRequest MainView::wanted(const ShownTick& tick, bool fine) {
  SceneRequest request;
  request.sequence = tick.sequence;
  request.tick = tick.packet.tick;
  request.fine = fine;
  const double share = fine ? 1.0 : coarse_share;
  const auto width = static_cast<uint32_t>(std::max(16.0, std::round(share * region_.x)));
  const auto height = static_cast<uint32_t>(std::max(16.0, std::round(share * region_.y)));
  if (camera_) {
    const sim::Moment& moment = moments_->at(tick.sequence, tick.packet.tick);
    const apps::ScenarioView through = apps::scenario_view(*camera_, *experiment_, moment, width);
    request.view = through.view;
    request.excluded_body = through.excluded_body;
  } else {
    request.view = viewpoint_->picture_view(experiment_->scene().origin, width, height, vertical_fov);
  }
  return request;
}

/// Moves with the node that is followed.
void MainView::carry_along(const ShownTick& tick) {
  if (!followed_) return;
  const dvec3 at = moments_->at(tick.sequence, tick.packet.tick).motions.at(*followed_).pose.position;
  if (std::isfinite(followed_at_.x)) viewpoint_->carry(at - followed_at_);
  followed_at_ = at;
}

void MainView::look_ahead(const ShownTick& tick) {
  if (scene_ == nullptr || !has_asked_) return;
  carry_along(tick);
  request(tick, true);
}

void MainView::navigate(const ShownTick& tick) {
  carry_along(tick);
  if (camera_) return;
  const ImGuiIO& io = ImGui::GetIO();
  const dvec3 keys = ImGui::IsWindowFocused() ? keys_pressed() : dvec3(0.0);
  const double metres = fly_per_s * viewpoint_->distance_m() * io.DeltaTime * (io.KeyShift ? 4.0 : 1.0);
  bool moved = keys != dvec3(0.0);
  if (moved) viewpoint_->fly(metres * keys);
  if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f) {
    viewpoint_->approach(std::pow(zoom_per_turn, io.MouseWheel));
    moved = true;
  }
  const dvec2 delta(io.MouseDelta.x, io.MouseDelta.y);
  if (ImGui::IsItemActive() && !tool_has_mouse_ && delta != dvec2(0.0)) {
    const dvec2 angle = turn_per_pixel * delta;
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
      viewpoint_->turn(-angle.x, angle.y);
    else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || io.KeyShift)
      viewpoint_->pan(delta, 0.5 * size_.y / std::tan(0.5 * vertical_fov));
    else if (dragged_)
      viewpoint_->orbit(-angle.x, angle.y);
    moved = true;
  }
  if (moved) moved_at_s_ = ImGui::GetTime();
}

void MainView::request(const ShownTick& tick, bool plays) {
  const bool rests = ImGui::GetTime() - moved_at_s_ > (plays ? playing_rest_s : rest_s);
  SceneRequest request = wanted(tick, rests);
  // The first picture is coarse, too, so that there is something to see soon.
  if (!has_asked_ || !same_view(request, asked_)) {
    moved_at_s_ = ImGui::GetTime();
    request = wanted(tick, false);
  }
  if (!has_asked_ || !same_request(request, asked_)) {
    scene_->look(request);
    asked_ = request;
    has_asked_ = true;
  }
  awaits_ = !picture_ || !same_request(picture_->request, request);
  settled_ = request.fine && !awaits_;
}

bool MainView::has_picture_of(const ShownTick& tick) const {
  if (scene_ == nullptr || !scene_->error().empty()) return true;
  const std::shared_ptr<const ScenePicture> newest = scene_->picture();
  return newest == nullptr ||
         (newest->request.sequence == tick.sequence && newest->request.tick == tick.packet.tick);
}

void MainView::show_picture(const Shapes& shapes, uint64_t shapes_version) {
  const std::shared_ptr<const ScenePicture> newest = scene_->picture();
  if (newest == nullptr || (newest == picture_ && map_ == painted_ && shapes_version == painted_version_ &&
                            hovered_id_ == painted_id_))
    return;
  picture_ = newest;
  painted_ = map_;
  painted_version_ = shapes_version;
  painted_id_ = hovered_id_;
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<uint8_t> with_map = map_ ? map_->painted(*picture_) : std::vector<uint8_t>();
  paint_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  Array rgb = rgb_array(*picture_, map_ ? with_map : picture_->rgb);
  paint_dots(shapes, overlay_frame(), hovered_id_, rgb);
  const apps::PictureView& view = picture_->request.view;
  if (texture_ != nullptr && (texture_width_ != view.width || texture_height_ != view.height)) {
    window_.drop_texture(texture_);
    texture_ = nullptr;
  }
  if (texture_ == nullptr) {
    texture_ = window_.make_texture(rgb);
    texture_width_ = view.width;
    texture_height_ = view.height;
  } else {
    window_.update_texture(texture_, rgb);
  }
}

std::optional<ImVec2> MainView::pixel_under(const ImVec2& at) const {
  if (picture_ == nullptr || size_.x <= 0.0f) return {};
  const apps::PictureView& view = picture_->request.view;
  const float scale = size_.x / static_cast<float>(view.width);
  return ImVec2((at.x - corner_.x) / scale, (at.y - corner_.y) / scale);
}

void MainView::click(const ImVec2& at) {
  if (hovered_id_ != 0) pinned_id_ = hovered_id_;
  if (const std::optional<ImVec2> pixel = pixel_under(at))
    picked_ = pick(*picture_, static_cast<int>(std::floor(pixel->x)), static_cast<int>(std::floor(pixel->y)),
                   experiment_->scene().origin);
}

Facts MainView::picked_facts(double carrier_hz) const {
  if (!picked_ || picture_ == nullptr) return {};
  return facts_of(*picked_, *experiment_, *picture_, carrier_hz);
}

dvec3 MainView::focus() const {
  if (camera_ && picture_ != nullptr) {
    const Pose& eye = picture_->request.view.local_from_sensor;
    return eye.apply({10.0, 0.0, 0.0}) + experiment_->scene().origin;
  }
  return viewpoint_ ? viewpoint_->pivot() : dvec3(0.0);
}

void MainView::draw_map_value(const ImVec2& cursor) const {
  const std::optional<ImVec2> pixel = pixel_under(cursor);
  if (!pixel) return;
  const std::optional<size_t> cell = painted_->cell_at(*picture_, static_cast<int>(std::floor(pixel->x)),
                                                       static_cast<int>(std::floor(pixel->y)));
  if (cell) ImGui::SetTooltip("%s", painted_->text_of(*cell).c_str());
}

OverlayFrame MainView::overlay_frame() const {
  return {picture_->request.view, picture_->depth, experiment_->scene().origin, corner_, size_};
}

void MainView::draw_overlays(const ShownTick& tick, const Shapes& shapes, const Shapes& world) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(corner_.x + size_.x, corner_.y + size_.y);
  list.PushClipRect(corner_, end, true);
  const OverlayFrame frame = overlay_frame();
  std::optional<ImVec2> cursor;
  if (ImGui::IsItemHovered()) cursor = ImGui::GetMousePos();
  const Highlights highlights{hovered_id_, pinned_id_};
  // Rectangles belong to one tick's picture; while another one is still shown, they would be beside it.
  const bool through = camera_ && picture_->request.tick == tick.packet.tick;
  const Shapes* under = nullptr;
  std::optional<OverlayHit> hit;
  const auto begin = std::chrono::steady_clock::now();
  for (const Shapes* const some : {&world, &shapes}) {
    const auto found = draw_shapes(list, *some, frame, cursor, highlights, through);
    if (!found || (hit && hit->distance_px < found->distance_px)) continue;
    hit = found;
    under = some;
  }
  overlay_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  // Rows of the side panel, which come after this, highlight theirs for the next frame.
  hovered_id_ = hit ? under->rows[hit->row].id : 0;
  if (hit)
    ImGui::SetTooltip("%s", under->rows[hit->row].text.c_str());
  else if (cursor && painted_ != nullptr)
    draw_map_value(*cursor);
  Shapes legend;
  legend.legend = shapes.legend;
  legend.legend.insert(legend.legend.end(), world.legend.begin(), world.legend.end());
  if (show_legend_) draw_legend(list, legend, {corner_.x + scaled(10.0f), corner_.y + scaled(10.0f)});
  if (painted_ != nullptr) draw_map_legend(list, *painted_, {end.x - 10.0f, end.y - 10.0f});
  list.PopClipRect();
}

void MainView::draw(const ShownTick& tick, const Shapes& shapes, uint64_t shapes_version, const Shapes& world,
                    std::shared_ptr<const MapLayerPaint> map, bool plays) {
  map_ = std::move(map);
  corner_ = ImGui::GetCursorScreenPos();
  size_ = region_ = ImGui::GetContentRegionAvail();
  settled_ = awaits_ = false;
  if (scene_ == nullptr || size_.x < 16.0f || size_.y < 16.0f) return;
  ImGui::InvisibleButton("main view", size_,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  if (ImGui::IsItemActivated()) dragged_ = false;
  if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, drag_px)) dragged_ = true;
  navigate(tick);
  request(tick, plays);
  show_picture(shapes, shapes_version);
  if (picture_ == nullptr) return;
  // A camera's picture keeps its own shape.
  const apps::PictureView& view = picture_->request.view;
  const float shape = static_cast<float>(view.height) / static_cast<float>(view.width);
  size_.y = std::min(size_.y, size_.x * shape);
  size_.x = size_.y / shape;
  ImGui::GetWindowDrawList()->AddImage(texture_, corner_, {corner_.x + size_.x, corner_.y + size_.y});
  draw_overlays(tick, shapes, world);
  const bool clicked = ImGui::IsItemDeactivated() && !dragged_ && ImGui::IsItemHovered() &&
                       ImGui::IsMouseReleased(ImGuiMouseButton_Left);
  if (clicked && !tool_has_mouse_) click(ImGui::GetMousePos());
  const bool hovered = ImGui::IsItemHovered();
  tool_has_mouse_ = tool_ && tool_(overlay_frame(), hovered);
}

}  // namespace greatx::view
