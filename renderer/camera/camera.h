// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a pinhole camera. The scene is drawn once, into a picture that says which triangle each sample
// sees. A compute pass turns that picture into radiance, planar depth and ids. Another pass develops and
// packs them. docs/camera.md has the conventions.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "renderer/camera/picture.h"
#include "renderer/lens/lens.h"
#include "renderer/light/lighting.h"
#include "renderer/light/near_shadow.h"
#include "scene/device/gpu_scene.h"

namespace greatx::render {

/// Selects the arrays to deliver. Colour is rendered only for rgb or hdr, depth and ids only if one of them
/// is wanted.
struct CameraOutputs {
  bool rgb = true, depth = true, instance = true, semantic = true, material = true;
  bool hdr = false;
  // These outputs stay on the GPU for another pass (CameraPass::luminance, CameraPass::seen).
  bool luminance = false, seen = false;
  bool cells = false;  ///< record_cells() works; needs luminance
  /// Returns the outputs for an event camera, which sends nothing to the host.
  static CameraOutputs of_luminance(bool seen) {
    return {.rgb = false,
            .depth = false,
            .instance = false,
            .semantic = false,
            .material = false,
            .luminance = true,
            .seen = seen};
  }
  bool color() const { return rgb || hdr; }
  bool ids() const { return depth || instance || semantic || material || seen || cells; }
  bool arrays() const { return rgb || hdr || depth || instance || semantic || material; }
};

/// Describes the noise of a sensor of light (docs/film.md). Every draw is a function of (seed, stream,
/// sequence, tick, pixel) only.
struct SensorNoise {
  double full_well_e = 10000.0;  ///< electrons that saturate the sensor at the exposure's L_max
  double read_noise_e = 2.5;     ///< rms
  uint32_t bits = 12;            ///< resolution of the converter
  uint64_t seed = 0;
  uint32_t stream = 0;  ///< identifies the sensor, unique within a run
};

/// Describes how a camera sees falling drops. Every draw is a function of (seed, stream, sequence, tick).
struct RainView {
  double shutter_s = 0.01;  ///< the time over which drops draw streaks
  uint64_t seed = 0;
  uint32_t stream = 0;  ///< identifies the sensor, unique within a run
};

/// Names one picture of a run. Noise and drops differ from one picture to the next.
struct FrameNumber {
  uint32_t sequence = 0;
  int64_t tick = 0;
  dvec3 velocity{0.0};  ///< of the camera, m/s, local axes: drops fall past it
};

struct CameraDesc {
  std::string name = "camera";  ///< for labels, timestamps and messages
  uint32_t width = 640, height = 480;
  double fx = 0.0, fy = 0.0;  ///< focal lengths, pixels
  /// Principal point, pixels; the centre of pixel (column i, row j) is (i + .5, j + .5).
  double cx = 0.0, cy = 0.0;
  double near_m = 0.1;              ///< planar depth of the nearest visible point; there is no far plane
  uint32_t msaa = 4;                ///< samples per pixel: 1 or 4
  bool smooth_edges = false;        ///< smooths pictures with one sample per pixel; renderer/camera/edges.h
  bool parts = false;               ///< exposures consist of several parts: ExposurePart
  double exposure_ev100 = 15.0;     ///< used without `automatic_exposure`
  bool automatic_exposure = false;  ///< meters each picture by itself (renderer/camera/meter.h)
  double compensation_ev = 0.0;     ///< with `automatic_exposure`: positive is brighter
  Distortion distortion;
  WideLens wide;                     ///< instead of `distortion`; depth is then the distance along the ray
  uint32_t bands = 0;                ///< rolling shutter: the most bands of rows, each with its own record()
  ChromaticAberration chromatic;     ///< applies to rgb and hdr
  Vignetting vignetting;             ///< applies to rgb
  std::optional<SensorNoise> noise;  ///< applies to rgb
  double glare = 0.0;                ///< share of the light that the lens scatters; renderer/camera/glare.h
  LensDrops drops;                   ///< drawn by RainView's numbers; renderer/camera/lens_drops.h
  double drop_seconds_per_tick = 0.1;
  /// What streaks of rain depend on, beside the light (renderer/camera/streaks.h).
  RainView rain;
  CameraOutputs outputs;
  /// The body that carries the camera, if the camera shall see neither it nor its parts.
  std::optional<uint32_t> excluded_body;
};

LensGeometry lens_geometry(const CameraDesc& desc);

/// Describes a part of the exposure time. Pictures of several instants add up to one with motion blur.
struct ExposurePart {
  float weight = 1.0f;  ///< the weights of a picture sum to 1
  bool first = true;
  bool last = true;  ///< this part's depth and ids are those of the picture, which is then developed
  /// With CameraDesc::bands: the band of rows that is drawn. The last band is the `last` part.
  uint32_t band = 0;
};

/// Holds the arrays that a camera delivers at one tick. Arrays that were not asked for are empty. The arrays
/// are in C order, row 0 on top.
struct CameraImages {
  uint32_t width = 0, height = 0;
  float ev100 = 0.0f;        ///< exposure with which rgb was developed
  std::vector<uint8_t> rgb;  ///< [height, width, 3], sRGB
  /// [height, width, 3], linear Rec. 709, cd/m^2; saturates at 65504 stored_luminance().
  std::vector<float> hdr;
  /// [height, width], planar metres at the pixel's centre; sky: +inf. Behind a WideLens: along the ray.
  std::vector<float> depth;
  std::vector<uint32_t> instance;  ///< [height, width], instance index + 1; 0: nothing
  std::vector<uint8_t> semantic;   ///< [height, width], SemanticClass; 0: nothing or unlabeled
  std::vector<uint16_t> material;  ///< [height, width], material index + 1; 0: nothing
};

/// Returns the luminance that saturates the sensor at an exposure value: 1.2 * 2^EV100 cd/m^2 (ISO 12232 with
/// a lens transmission of .65; Lagarde and de Rousiers, "Moving Frostbite to PBR", SIGGRAPH course 2014,
/// section 5.1.2).
double saturation_luminance(double ev100);
/// Returns the cd/m^2 that a stored radiance of 1 stands for. With a fixed exposure it is L_max. With an
/// automatic one it suits the light of the scene, so that halves hold day and night (docs/film.md).
double stored_luminance(const CameraDesc& desc, const SceneLighting& lighting);

/// Counts the lamps of one picture (renderer/camera/lamps.h).
struct LampCounts {
  uint32_t seen = 0;     ///< lamps in at least one cluster
  uint32_t entries = 0;  ///< lamps summed over clusters
};

struct CameraView;
class CellPass;
class DevelopPass;
class DrawList;
struct DrawPiece;
class EdgePass;
class FaceTable;
class GlarePass;
class LensDropPass;
class MirrorPass;
class PanePass;
class StreakPass;
class ThinLines;
struct PinholeView;

class CameraPass {
 public:
  /// Builds only the pipelines that this scene, these outputs and the lighting's effects need. `lighting` and
  /// its scene outlive the pass. Throws UserError naming the camera and the field if `desc` is not sensible.
  CameraPass(const SceneLighting& lighting, const CameraDesc& desc);
  ~CameraPass();

  /// Records one picture into the slot. GpuScene::record_update and SceneLighting::record of the same tick
  /// come before. `local_from_sensor` is in local coordinates: x forward, y left, z up.
  void record(gpu::TickSlot& slot, const Pose& local_from_sensor, const FrameNumber& frame = {},
              const ExposurePart& part = {});
  /// Returns the picture that was recorded into `slot`, once its submission is done.
  CameraImages collect(const gpu::TickSlot& slot) const;

  /// Returns the number of bands of rows with CameraDesc::bands, which may be below it; otherwise 1.
  uint32_t bands() const;
  /// Returns the place of a band's middle within the height, from -0.5 (top) to 0.5. Rows of a rolling
  /// shutter are exposed at this share of the readout time after the tick.
  double middle_of_band(uint32_t band) const;

  /// Keeps of the picture recorded last what other instants need (renderer/camera/cells.h), with
  /// `outputs.cells`. `cells` is written. The bodies still stand as in that picture.
  void record_cells(gpu::TickSlot& slot, const gpu::Buffer& cells);

  const CameraDesc& desc() const { return desc_; }
  // The buffers below are those of the last record(). A compute shader writes them, so a reader puts a
  // barrier before.
  /// The stored radiance, four halves a pixel. Red, green and blue times stored_luminance() are cd/m^2. The
  /// fourth is the share of the pixel that shows the scene and not the sky.
  const gpu::Buffer& color() const { return picture_.color; }
  /// Holds float [height * width], cd/m^2, if `outputs.luminance` is set.
  const gpu::Buffer& luminance() const { return picture_.luminance; }
  /// The view of the pixels' centres: uvec2 [height * width], the bits of planar depth (sky: +inf),
  /// triangle + 1 (0: nothing).
  const gpu::Buffer& seen() const { return seen_; }
  /// The numbers of pieces (DrawList) that the last record() drew, and left out because they lie outside the
  /// view.
  uint32_t drawn() const { return drawn_; }
  uint32_t culled() const { return culled_; }
  /// The cascades of static shadows around this camera; null without them.
  const NearShadows* near_shadows() const { return near_shadows_.get(); }
  /// The lamps of the last record().
  const LampCounts& lamps() const { return lamps_; }
  /// The tiles of spots that move, of the last record().
  const std::vector<BeamTile>& beam_tiles() const { return beam_tiles_; }

 private:
  bool multisampled() const { return desc_.msaa > 1; }
  void check() const;
  void build_pipelines();
  void create_images();
  void create_pictures();
  /// Returns the pieces to draw, front to back, and counts them.
  std::vector<uint32_t> visible(std::span<const DrawPiece> pieces, const CameraView& view);
  void draw_pieces(gpu::Cmd& cmd, const CameraView& view, const gpu::GraphicsPipeline& with,
                   std::span<const DrawPiece> pieces, std::span<const uint32_t> order);
  void draw_still(gpu::Cmd& cmd, const CameraView& view);
  void upload_lens();
  gpu::Slice upload_lamps(gpu::TickSlot& slot, const CameraView& view);
  void build_faces();
  void record_faces(gpu::TickSlot& slot, const Pose& local_from_sensor, const ExposurePart& part);
  void draw_shadows(gpu::TickSlot& slot, const CameraView& view);
  gpu::ComputeDesc shading() const;
  /// Draws what the view sees. It marks in the view's constants that panes are among it.
  void record_visibility(gpu::Cmd& cmd, CameraView& view);
  void draw_moving(gpu::Cmd& cmd, const CameraView& view);
  /// Draws what glazed pieces have beside their panes, and lists the panes for later.
  void draw_glazed(gpu::Cmd& cmd, const CameraView& view, std::span<const DrawPiece> pieces,
                   std::span<const uint32_t> glazed);
  /// `pixels` lists those that look through this view. Without a FaceTable all do; then these are the words
  /// of its thin lines, which lie over `line_pixels` pixels.
  void record_shading(gpu::TickSlot& slot, const CameraView& view, const gpu::Slice& pixels,
                      uint32_t line_pixels = 0);

  const SceneLighting* lighting_;
  const scene::GpuScene* scene_;
  CameraDesc desc_;
  CameraEffects effects_;
  std::unique_ptr<DrawList> draws_;
  std::unique_ptr<ThinLines> lines_;  ///< null without the effect, and if the scene has none
  gpu::GraphicsPipeline visibility_still_, visibility_still_closed_, visibility_moving_, visibility_closed_,
      visibility_masked_;
  gpu::ComputePipeline shade_;
  gpu::ComputePipeline shade_lines_;  ///< empty without lines_
  gpu::Image visibility_, depth_;     ///< multisampled if msaa is
  gpu::Sampler texel_sampler_;
  std::unique_ptr<PinholeView> pinhole_;  ///< with faces_: as large as the largest of them
  std::unique_ptr<FaceTable> faces_;      ///< null unless the lens or the shutter needs several views
  gpu::Image lens_;        ///< position of each pixel in the pinhole picture; 1 x 1 without distortion
  PictureBuffers shaded_;  ///< the picture before edges are smoothed; empty if they are not
  gpu::Buffer dry_;        ///< colour before mirror images are added; empty if there are none
  gpu::Buffer beside_;     ///< what MirrorPass and panes need beside the picture (shade_mirror_binding)
  PictureBuffers picture_;
  gpu::Buffer seen_;
  std::unique_ptr<NearShadows> near_shadows_;  ///< null without the effect
  std::unique_ptr<EdgePass> edges_;            ///< null if not wanted
  std::unique_ptr<MirrorPass> mirror_;         ///< null without water
  std::unique_ptr<PanePass> panes_;            ///< null without panes
  std::vector<uint32_t> seen_panes_;           ///< of DrawList, in the view that is recorded
  std::unique_ptr<StreakPass> streaks_;        ///< null without rain
  std::unique_ptr<LensDropPass> lens_drops_;   ///< null if not wanted
  std::unique_ptr<GlarePass> glare_;           ///< null if not wanted
  std::unique_ptr<CellPass> cells_;            ///< null if not wanted
  std::unique_ptr<DevelopPass> develop_;       ///< null if no array is wanted
  std::string visibility_scope_, shade_scope_, lines_scope_;
  uint32_t drawn_ = 0, culled_ = 0;
  LampCounts lamps_;
  std::vector<BeamTile> beam_tiles_;  ///< of the view that is recorded
};

}  // namespace greatx::render
