// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The main view: the scene from where the user looks, with the overlays over it. It asks SceneView for
// pictures and shows the newest one it has; overlays are placed by the view of the picture that is shown, so
// that both fit together while the user flies.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "draw/paths/render.h"
#include "view/app/overlay_draw.h"
#include "view/camera/viewpoint.h"
#include "view/pick/pick.h"
#include "view/run/run.h"
#include "view/scene/moment_cache.h"
#include "view/scene/scene_view.h"
#include "view/window/window.h"
#include "view/world/map_paint.h"

namespace greatx::view {

class MainView {
 public:
  explicit MainView(Window& window) : window_(window) {}
  ~MainView();
  MainView(const MainView&) = delete;
  MainView& operator=(const MainView&) = delete;

  /// Shows a scene. `scene` draws it and has been made from the experiment. Whoever looks at another scene
  /// already goes on to look from there, through the camera or after the node of the same name. Returns what
  /// drew the scene before, whose end may take a while.
  std::unique_ptr<SceneView> set_scene(std::shared_ptr<const sim::Experiment> experiment,
                                       std::unique_ptr<SceneView> scene);
  bool has_scene() const { return scene_ != nullptr; }
  std::string error() const { return scene_ ? scene_->error() : ""; }

  /// Draws into the current ImGui window, and takes its mouse and keys. `shapes` come from records, and
  /// `shapes_version` changes with them. `world` comes from the experiment; `map` may be null. `plays`: the
  /// next tick will follow by itself.
  void draw(const ShownTick& tick, const Shapes& shapes, uint64_t shapes_version, const Shapes& world,
            std::shared_ptr<const MapLayerPaint> map, bool plays);
  /// Asks for the picture of a tick that no frame has drawn yet. The run plays.
  void look_ahead(const ShownTick& tick);
  /// Whether the shown picture is the one that is wanted, at full quality.
  bool settled() const { return settled_; }
  /// Whether a picture is being drawn for the view that is wanted.
  bool awaits() const { return awaits_; }
  /// Whether the newest picture is of this tick, or none will come.
  bool has_picture_of(const ShownTick& tick) const;
  /// Changes whenever there is a new picture, or an error.
  uint64_t version() const { return scene_ ? scene_->version() : 0; }
  /// The picture that is shown, and the one that was asked for last.
  const std::shared_ptr<const ScenePicture>& picture() const { return picture_; }
  const SceneRequest& asked() const { return asked_; }
  /// Wall time of painting the map into the last picture.
  double paint_ms() const { return paint_ms_; }
  /// Wall time of drawing the overlays of the last frame, without the window's own drawing.
  double overlay_ms() const { return overlay_ms_; }
  double picture_ms() const { return picture_ ? picture_->milliseconds : 0.0; }

  void look_from_outside();
  /// Moves with a node from now on; none: stays.
  void follow(std::optional<uint32_t> node);
  std::optional<uint32_t> followed() const { return followed_; }
  /// Looks through a camera of the scenario, with its lens; none: flies.
  void look_through(std::optional<apps::CameraName> camera) { camera_ = camera; }
  std::optional<apps::CameraName> camera() const { return camera_; }

  /// What the user clicked at, and the tick's facts about it.
  const std::optional<Picked>& picked() const { return picked_; }
  Facts picked_facts(double carrier_hz) const;
  /// Whether the legend of the overlays is drawn; may be changed.
  bool& show_legend() { return show_legend_; }
  void select_nothing() { picked_.reset(); }
  /// The identity of the shape under the cursor; 0: none. It stays highlighted while it moves.
  uint64_t hovered_id() const { return hovered_id_; }
  void highlight(uint64_t id) { hovered_id_ = id; }
  /// The identity of the shape that the user clicked at; 0: none. It stays highlighted, too.
  uint64_t pinned_id() const { return pinned_id_; }
  void pin(uint64_t id) { pinned_id_ = id; }
  /// The point of the world around which the user looks.
  dvec3 focus() const;

  /// Draws over the picture and may take the mouse, which it returns; `hovered` tells whether the cursor is
  /// over the picture.
  using Tool = std::function<bool(const OverlayFrame& frame, bool hovered)>;
  void set_tool(Tool tool) { tool_ = std::move(tool); }

 private:
  void carry_along(const ShownTick& tick);
  void navigate(const ShownTick& tick);
  void request(const ShownTick& tick, bool plays);
  SceneRequest wanted(const ShownTick& tick, bool fine);
  void show_picture(const Shapes& shapes, uint64_t shapes_version);
  OverlayFrame overlay_frame() const;
  void draw_overlays(const ShownTick& tick, const Shapes& shapes, const Shapes& world);
  void draw_map_value(const ImVec2& cursor) const;
  void keep_names(const sim::Experiment& before, const sim::Experiment& after);
  void click(const ImVec2& at);
  std::optional<ImVec2> pixel_under(const ImVec2& at) const;

  Window& window_;
  std::shared_ptr<const sim::Experiment> experiment_;
  std::unique_ptr<SceneView> scene_;
  std::optional<MomentCache> moments_;
  std::optional<Viewpoint> viewpoint_;
  std::optional<uint32_t> followed_;
  dvec3 followed_at_{0.0};
  std::optional<apps::CameraName> camera_;
  std::shared_ptr<const ScenePicture> picture_;
  std::shared_ptr<const MapLayerPaint> map_, painted_;  ///< wanted, and in the texture
  TextureId texture_ = nullptr;
  uint32_t texture_width_ = 0, texture_height_ = 0;
  ImVec2 corner_{0, 0}, size_{0, 0};  ///< of the picture in the window
  ImVec2 region_{0, 0};               ///< that a picture may fill
  SceneRequest asked_;
  bool has_asked_ = false;
  double moved_at_s_ = -1e9;  ///< ImGui's time of the last change of the view
  bool settled_ = false, awaits_ = false;
  /// What the texture shows beside the picture.
  uint64_t painted_version_ = 0, painted_id_ = 0;
  bool dragged_ = false;  ///< since the button went down
  std::optional<Picked> picked_;
  uint64_t hovered_id_ = 0, pinned_id_ = 0;
  double paint_ms_ = 0.0, overlay_ms_ = 0.0;
  bool show_legend_ = true;
  Tool tool_;
  bool tool_has_mouse_ = false;
};

}  // namespace greatx::view
