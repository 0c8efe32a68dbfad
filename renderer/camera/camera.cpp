// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/camera.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "renderer/camera/camera_view.h"
#include "renderer/camera/cells.h"
#include "renderer/camera/develop.h"
#include "renderer/camera/draw_list.h"
#include "renderer/camera/edges.h"
#include "renderer/camera/faces.h"
#include "renderer/camera/glare.h"
#include "renderer/camera/lamps.h"
#include "renderer/camera/lens_drops.h"
#include "renderer/camera/meter.h"
#include "renderer/camera/mirror.h"
#include "renderer/camera/panes.h"
#include "renderer/camera/streaks.h"
#include "renderer/camera/thin_lines.h"
#include "renderer/surface/pane_color.h"
#include "shaders/shared/film.h"

namespace greatx::render {

namespace {

constexpr VkFormat visibility_format = VK_FORMAT_R32_UINT;
constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

}  // namespace

LensGeometry lens_geometry(const CameraDesc& desc) {
  return {desc.name, desc.width, desc.height, desc.fx, desc.fy, desc.cx, desc.cy, desc.distortion, desc.wide};
}

double saturation_luminance(double ev100) { return 1.2 * std::exp2(ev100); }

double stored_luminance(const CameraDesc& desc, const SceneLighting& lighting) {
  if (!desc.automatic_exposure) return saturation_luminance(desc.exposure_ev100);
  return anchor_luminance(lighting.ground_illuminance_lux());
}

CameraPass::CameraPass(const SceneLighting& lighting, const CameraDesc& desc)
    : lighting_(&lighting),
      scene_(&lighting.scene()),
      desc_(desc),
      effects_(lighting.effects()),
      visibility_scope_(desc.name + " visibility"),
      shade_scope_(desc.name + " shade"),
      lines_scope_(desc.name + " lines") {
  check();
  const bool shaded = desc_.outputs.color() || desc_.outputs.luminance;
  desc_.smooth_edges = desc_.smooth_edges && shaded;
  if (has_faces(desc_)) faces_ = std::make_unique<FaceTable>(scene_->device(), desc_);
  pinhole_ = std::make_unique<PinholeView>(faces_ ? faces_->largest() : pinhole_of(desc_));
  const bool mirrors = wants_mirrors(effects_, desc_),
             streaks = effects_.rain_streaks && desc_.outputs.color() && !has_faces(desc_);
  desc_.outputs.seen = desc_.outputs.seen || desc_.smooth_edges || mirrors || streaks || effects_.lamp_halos;
  const uint32_t most = scene_->device().limits().maxImageDimension2D;
  if (std::max(pinhole_->width, pinhole_->height) > most)
    throw_user_error(
        "camera {}: distortion: expected a pinhole picture of at most {} pixels along a side, found {} x {}",
        desc_.name, most, pinhole_->width, pinhole_->height);
  draws_ = std::make_unique<DrawList>(
      scene_->scene(), lighting_->surfaces().closed(), desc_.excluded_body, effects_.alpha_mask,
      effects_.panes && shaded ? pane_materials(scene_->scene()) : std::vector<bool>());
  if (effects_.shadow_cascades && shaded) near_shadows_ = std::make_unique<NearShadows>(lighting_->shadows());
  if (wants_lines(effects_, desc_)) lines_ = std::make_unique<ThinLines>(scene_->scene());
  if (lines_ && lines_->size() == 0) lines_.reset();
  build_pipelines();
  create_images();
  create_pictures();
  upload_lens();
  if (desc_.smooth_edges) edges_ = std::make_unique<EdgePass>(*lighting_, desc_, lines_ != nullptr);
  if (mirrors) mirror_ = std::make_unique<MirrorPass>(*lighting_, desc_);
  if (streaks) streaks_ = std::make_unique<StreakPass>(*lighting_, desc_);
  if (desc_.drops.any() && desc_.outputs.color())
    lens_drops_ = std::make_unique<LensDropPass>(*lighting_, desc_);
  if (desc_.glare > 0.0 && desc_.outputs.color()) glare_ = std::make_unique<GlarePass>(*lighting_, desc_);
  if (desc_.outputs.cells) cells_ = std::make_unique<CellPass>(*lighting_, desc_);
  if (desc_.outputs.arrays()) develop_ = std::make_unique<DevelopPass>(*lighting_, desc_);
}

CameraPass::~CameraPass() = default;

// These functions check the camera and build its pipelines, images and buffers before the first picture.

void CameraPass::check() const {
  const auto require = [&](bool holds, const char* field, const char* expected, double found) {
    if (!holds) throw_user_error("camera {}: {}: expected {}, found {}", desc_.name, field, expected, found);
  };
  const double most = scene_->device().limits().maxImageDimension2D;
  require(desc_.width >= 1 && desc_.width <= most, "width", "1 to the device's largest image", desc_.width);
  require(desc_.height >= 1 && desc_.height <= most, "height", "1 to the device's largest image",
          desc_.height);
  const uint64_t pixels = uint64_t{desc_.width} * desc_.height,
                 most_pixels = scene_->device().limits().maxStorageBufferRange / sizeof(uvec2);
  if (pixels > most_pixels)
    throw_user_error("camera {}: width, height: expected at most {} pixels on '{}', found {} x {}",
                     desc_.name, most_pixels, scene_->device().info().name, desc_.width, desc_.height);
  require(std::isfinite(desc_.fx) && desc_.fx > 0.0, "fx", "a positive number of pixels", desc_.fx);
  require(std::isfinite(desc_.fy) && desc_.fy > 0.0, "fy", "a positive number of pixels", desc_.fy);
  require(std::isfinite(desc_.cx), "cx", "a number of pixels", desc_.cx);
  require(std::isfinite(desc_.cy), "cy", "a number of pixels", desc_.cy);
  require(std::isfinite(desc_.near_m) && desc_.near_m > 0.0, "near_m", "a positive number of metres",
          desc_.near_m);
  require(desc_.msaa == 1 || desc_.msaa == 4, "msaa", "1 or 4", desc_.msaa);
  require(desc_.msaa == 1 || !desc_.smooth_edges, "msaa", "1, for edges are smoothed", desc_.msaa);
  require(!desc_.outputs.cells || !(desc_.distortion.any() || has_faces(desc_)), "distortion",
          "none, for an event camera reconstructs instants from its pictures", 1);
  require(!(desc_.drops.any() && desc_.wide.any()), "drops",
          "none behind a fisheye or an equirectangular lens", 1);
  require(!desc_.parts || desc_.bands == 0, "bands", "none, for the exposure has parts", desc_.bands);
  require(desc_.exposure_ev100 >= -20.0 && desc_.exposure_ev100 <= 24.0, "exposure_ev100", "-20 to 24",
          desc_.exposure_ev100);
  require(desc_.outputs.color() || desc_.outputs.luminance || desc_.outputs.ids(), "outputs", "at least one",
          0);
  const size_t materials = scene_->scene().materials.size();
  require(!desc_.outputs.material || materials < 65535, "outputs.material",
          "a scene of at most 65534 materials", double(materials));
}

void CameraPass::build_pipelines() {
  gpu::Device& device = scene_->device();
  gpu::GraphicsDesc draw;
  draw.bindings = scene::GpuScene::raster_bindings();
  draw.push_constant_bytes = sizeof(shared::CameraConstants);
  draw.color_formats = {visibility_format};
  draw.depth_format = depth_format;
  draw.samples = static_cast<VkSampleCountFlagBits>(desc_.msaa);
  draw.specialization.resize(shared::shade_spec_count);
  draw.vertex_shader = "camera/visibility.vert";
  draw.fragment_shader = "camera/visibility.frag";
  if (!draws_->still().empty())
    visibility_still_ = gpu::GraphicsPipeline(device, draw, desc_.name + " visibility");
  if (draws_->any_closed_still()) {
    gpu::GraphicsDesc closed = draw;
    // The picture's y points down, as in clip space: what faces the camera winds counter-clockwise.
    closed.cull = VK_CULL_MODE_BACK_BIT;
    visibility_still_closed_ =
        gpu::GraphicsPipeline(device, closed, desc_.name + " visibility of closed things");
  }
  if (!draws_->moving().empty()) {
    gpu::GraphicsDesc bodies = draw;
    bodies.vertex_shader = "camera/visibility_moving.vert";
    bodies.push_constant_bytes = sizeof(shared::BodyView);
    visibility_moving_ = gpu::GraphicsPipeline(device, bodies, desc_.name + " visibility of bodies");
    bodies.cull = VK_CULL_MODE_BACK_BIT;
    if (draws_->any_closed())
      visibility_closed_ = gpu::GraphicsPipeline(device, bodies, desc_.name + " visibility of closed bodies");
  }
  if (!draws_->masked().empty()) {
    draw.vertex_shader = "camera/visibility_masked.vert";
    draw.fragment_shader = "camera/visibility_masked.frag";
    draw.textures = &scene_->textures().table();
    draw.specialization[shared::spec_base_color_arrays] =
        scene_->textures().arrays_of(&scene::MaterialTextures::base_color);
    visibility_masked_ = gpu::GraphicsPipeline(device, draw, desc_.name + " visibility masked");
  }

  const gpu::ComputeDesc shade = shading();
  shade_ = gpu::ComputePipeline(device, shade, desc_.name + " shade");
  if (lines_) {
    gpu::ComputeDesc blend = shade;
    blend.shader = "camera/shade_lines.comp";
    shade_lines_ = gpu::ComputePipeline(device, blend, lines_scope_);
  }
  if (!draws_->panes().empty())
    panes_ = std::make_unique<PanePass>(*lighting_, desc_, shade, pinhole_->width, pinhole_->height);
}

void CameraPass::create_images() {
  const auto image = [&](VkFormat format, VkImageUsageFlags usage, const char* what) {
    return gpu::Image(scene_->device(),
                      {.format = format,
                       .width = pinhole_->width,
                       .height = pinhole_->height,
                       .mip_levels = 1,
                       .samples = static_cast<VkSampleCountFlagBits>(desc_.msaa),
                       .usage = usage},
                      fmt::format("{} {}", desc_.name, what));
  };
  const VkImageUsageFlags read = multisampled() ? VK_IMAGE_USAGE_SAMPLED_BIT : VK_IMAGE_USAGE_STORAGE_BIT;
  visibility_ = image(visibility_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | read, "visibility");
  depth_ = image(depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, "depth");
  texel_sampler_ =
      gpu::Sampler(scene_->device(), {.linear = false, .repeat_u = false, .repeat_v = false}, "texels");
}

void CameraPass::create_pictures() {
  constexpr size_t pad = shared::develop_pixels;
  const size_t pixels = (size_t{desc_.width} * desc_.height + pad - 1) / pad * pad;
  std::vector<gpu::Buffer*> all;
  const auto buffer = [&](gpu::Buffer& to, bool wanted, size_t bytes, const char* what) {
    to = gpu::Buffer(scene_->device(), wanted ? bytes * pixels : 0, gpu::Memory::device,
                     fmt::format("{} {}", desc_.name, what));
    all.push_back(&to);
  };
  const CameraOutputs& outputs = desc_.outputs;
  buffer(picture_.color, outputs.color(), sizeof(uvec2), "radiance");
  buffer(picture_.luminance, outputs.luminance, sizeof(float), "luminance");
  buffer(shaded_.color, outputs.color() && desc_.smooth_edges, sizeof(uvec2), "radiance with edges");
  buffer(shaded_.luminance, outputs.luminance && desc_.smooth_edges, sizeof(float), "luminance with edges");
  const bool mirrors = wants_mirrors(effects_, desc_);
  buffer(dry_, mirrors, sizeof(uvec2), "radiance without mirror images");
  const size_t mirror_bytes = mirrors ? sizeof(shared::uvec3) : 0,
               pane_bytes = panes_ ? shared::pane_pixel_words * sizeof(uint32_t) : 0;
  buffer(beside_, mirrors || panes_, mirror_bytes + pane_bytes, "mirrors and panes");
  buffer(seen_, outputs.ids(), sizeof(uvec2), "seen");
  gpu::submit_setup(scene_->device(), [&](gpu::Cmd& cmd) {
    for (const gpu::Buffer* each : all) cmd.fill(each->slice(), 0);
  });
  if (!faces_ || !outputs.ids()) return;
  // No view writes the pixels outside the image circle, which see nothing.
  const std::vector<uvec2> nothing(pixels, uvec2(0x7f800000u, 0u));
  const gpu::Buffer from = gpu::upload_buffer(scene_->device(), std::as_bytes(std::span(nothing)), "nothing");
  gpu::submit_setup(scene_->device(), [&](gpu::Cmd& cmd) { cmd.copy(from.slice(), seen_.slice()); });
}

void CameraPass::upload_lens() {
  gpu::Device& device = scene_->device();
  std::vector<vec2> places(1);
  const bool distorts = desc_.distortion.any() && !faces_;
  if (distorts) {
    const std::vector<dvec2> exact =
        Lens(lens_geometry(desc_)).centers({pinhole_->fx, pinhole_->fy}, {pinhole_->cx, pinhole_->cy});
    places.assign(exact.begin(), exact.end());
  }
  lens_ = gpu::Image(device,
                     {.format = VK_FORMAT_R32G32_SFLOAT,
                      .width = distorts ? desc_.width : 1,
                      .height = distorts ? desc_.height : 1,
                      .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                     fmt::format("{} lens", desc_.name));
  const std::span<const std::byte> texels = std::as_bytes(std::span(places));
  gpu::upload_image(device, lens_, std::span(&texels, 1));
}

// These functions record one picture.

gpu::Slice CameraPass::upload_lamps(gpu::TickSlot& slot, const CameraView& view) {
  std::vector<uint32_t> words(1);
  lamps_ = {};
  if (effects_.punctual_lights)
    words = cluster_lamps(view, scene_->scene().lights, lighting_->body_poses(), lamps_,
                          lighting_->lamp_shadows().tiles(), effects_.lamp_halos, beam_tiles_);
  return slot.upload.put(std::span<const uint32_t>(words));
}

void CameraPass::record(gpu::TickSlot& slot, const Pose& local_from_sensor, const FrameNumber& frame,
                        const ExposurePart& part) {
  GREATX_CHECK(desc_.parts || desc_.bands > 0 || (part.first && part.last),
               "camera {}: built for whole exposures", desc_.name);
  drawn_ = culled_ = 0;
  if (faces_) {
    record_faces(slot, local_from_sensor, part);
    if (part.last && lens_drops_) lens_drops_->record(slot, picture_.color, frame);
    if (part.last && glare_) glare_->record(slot, picture_.color);
    if (part.last && develop_) develop_->record(slot, picture_.color, seen_, frame);
    return;
  }
  CameraView view(*pinhole_, desc_.near_m, local_from_sensor, lighting_->shadows().frame(),
                  1.0 / stored_luminance(desc_, *lighting_));
  view.constants.weight = part.weight;
  view.constants.first = part.first ? shared::camera_first_part : 0u;
  view.constants.size = desc_.width | desc_.height << 16;
  draw_shadows(slot, view);
  record_visibility(*slot.cmd, view);
  LinesInView seen_lines;
  if (lines_) seen_lines = lines_->in_view(view);
  std::optional<gpu::Slice> lines;
  if (seen_lines.pixels > 0) {
    lines = slot.upload.put(std::span<const uint32_t>(seen_lines.words));
    view.constants.first |= shared::camera_sees_lines;
  }
  record_shading(slot, view, lines.value_or(seen_.slice()), seen_lines.pixels);
  if (!part.last) return;
  if (mirror_) mirror_->record(slot, view, {seen_, dry_, beside_, edges_ ? shaded_.color : picture_.color});
  if (cells_) cells_->see(view.constants);
  if (edges_)
    edges_->record(slot, view, gpu::Descriptor::sampled(shared::lens_binding, lens_, texel_sampler_),
                   {shaded_, seen_, picture_, lines ? &*lines : nullptr}, nullptr);
  if (streaks_) streaks_->record(slot, view, seen_, picture_.color, frame);
  if (lens_drops_) lens_drops_->record(slot, picture_.color, frame);
  if (glare_) glare_->record(slot, picture_.color);
  if (develop_) develop_->record(slot, picture_.color, seen_, frame);
}

/// Draws and shades one view after the other. They share the images of the visibility pass. Edges follow once
/// the neighbours of all pixels are shaded, while the bodies still stand as in the views.
void CameraPass::record_faces(gpu::TickSlot& slot, const Pose& local_from_sensor, const ExposurePart& part) {
  std::vector<std::pair<const CameraFace*, CameraView>> views;
  for (const CameraFace& face : faces_->faces()) {
    if (desc_.bands > 0 && face.band != part.band) continue;
    CameraView view(face.pinhole, desc_.near_m, local_from_sensor * face.sensor_from_face,
                    lighting_->shadows().frame(), 1.0 / stored_luminance(desc_, *lighting_));
    view.constants.weight = part.weight;
    view.constants.first = desc_.bands > 0 || part.first ? shared::camera_first_part : 0u;
    view.constants.size = desc_.width | desc_.height << 16;
    draw_shadows(slot, view);
    record_visibility(*slot.cmd, view);
    record_shading(slot, view, face.pixels);
    views.emplace_back(&face, view);
  }
  if (!edges_ || (desc_.bands == 0 && !part.last)) return;
  for (const auto& [face, view] : views)
    edges_->record(slot, view, gpu::Descriptor::sampled(shared::lens_binding, lens_, texel_sampler_),
                   {shaded_, seen_, picture_, nullptr}, &face->pixels);
}

uint32_t CameraPass::bands() const {
  const uint32_t rows = rows_of_band(desc_);
  return (desc_.height + rows - 1) / rows;
}

double CameraPass::middle_of_band(uint32_t band) const {
  const double rows = rows_of_band(desc_), height = desc_.height;
  return 0.5 * (band * rows + std::min((band + 1) * rows, height)) / height - 0.5;
}

void CameraPass::record_cells(gpu::TickSlot& slot, const gpu::Buffer& cells) {
  GREATX_CHECK(cells_ != nullptr, "camera {}: cells were not asked for", desc_.name);
  cells_->record(slot, seen_, edges_ ? shaded_.luminance : picture_.luminance, cells);
}

void CameraPass::record_visibility(gpu::Cmd& cmd, CameraView& view) {
  seen_panes_.clear();
  const auto scope = cmd.scope(visibility_scope_);
  cmd.transition(visibility_, gpu::ImageUse::color_target, true);
  cmd.transition(depth_, gpu::ImageUse::depth_target, true);
  gpu::RenderTargets targets;
  targets.color.push_back({.image = &visibility_, .clear = {.uint32 = {0, 0, 0, 0}}});
  targets.depth = &depth_;
  targets.width = view.pinhole.width;
  targets.height = view.pinhole.height;
  cmd.begin_rendering(targets);
  draw_still(cmd, view);
  draw_moving(cmd, view);
  draw_pieces(cmd, view, visibility_masked_, draws_->masked(), visible(draws_->masked(), view));
  cmd.end_rendering();
  if (seen_panes_.empty()) return;
  panes_->draw(cmd, view, draws_->panes(), seen_panes_, depth_);
  view.constants.first |= shared::camera_sees_panes;
}

std::vector<uint32_t> CameraPass::visible(std::span<const DrawPiece> pieces, const CameraView& view) {
  std::vector<uint32_t> order = visible_pieces(pieces, lighting_->body_poses(), view);
  culled_ += static_cast<uint32_t>(pieces.size() - order.size());
  drawn_ += static_cast<uint32_t>(order.size());
  return order;
}

void CameraPass::draw_pieces(gpu::Cmd& cmd, const CameraView& view, const gpu::GraphicsPipeline& with,
                             std::span<const DrawPiece> pieces, std::span<const uint32_t> order) {
  if (order.empty()) return;
  cmd.bind(with);
  cmd.push(scene_->raster_descriptors());
  cmd.constants(view.constants);
  for (const uint32_t i : order)
    cmd.draw_range(pieces[i].first_index, pieces[i].index_count, pieces[i].primitive);
}

void CameraPass::draw_glazed(gpu::Cmd& cmd, const CameraView& view, std::span<const DrawPiece> pieces,
                             std::span<const uint32_t> glazed) {
  std::vector<uint32_t> rests;
  for (const uint32_t i : glazed) {
    rests.insert(rests.end(), pieces[i].rests.begin(), pieces[i].rests.end());
    for (const uint32_t pane : pieces[i].panes) {
      const DrawPiece& piece = draws_->panes()[pane];
      const dvec3 center = lighting_->body_poses()[piece.body].apply(piece.center()) - view.eye;
      if (!view.outside(center, piece.radius())) seen_panes_.push_back(pane);
    }
  }
  if (rests.empty()) return;
  if (draws_->rests()[rests[0]].body == 0)
    return draw_pieces(cmd, view, visibility_still_, draws_->rests(), rests);
  cmd.bind(visibility_moving_);
  cmd.push(scene_->raster_descriptors());
  for (const uint32_t i : rests) {
    const DrawPiece& rest = draws_->rests()[i];
    cmd.constants(view.of_body(lighting_->body_poses()[rest.body]));
    cmd.draw_range(rest.first_index, rest.index_count, 0);
  }
}

/// Draws what is seen from outside without its back faces, and then the rest, most of which is ground.
void CameraPass::draw_still(gpu::Cmd& cmd, const CameraView& view) {
  std::vector<uint32_t> order = visible(draws_->still(), view);
  draw_glazed(cmd, view, draws_->still(),
              take_glazed(order, draws_->still(), lighting_->body_poses(), view.eye, pane_reach(view)));
  const double room = nearest_room(view);
  const auto rest = std::ranges::stable_partition(
      order, [&](uint32_t i) { return sees_from_outside(draws_->still()[i], view.eye, room); });
  const auto closed = static_cast<size_t>(rest.begin() - order.begin());
  draw_pieces(cmd, view, visibility_still_closed_, draws_->still(), std::span(order).first(closed));
  draw_pieces(cmd, view, visibility_still_, draws_->still(), std::span(order).subspan(closed));
}

void CameraPass::draw_shadows(gpu::TickSlot& slot, const CameraView& view) {
  if (!desc_.outputs.color() && !desc_.outputs.luminance) return;
  if (near_shadows_) near_shadows_->record(slot, view.eye);
  lighting_->draw_shadows(slot, [&](const dvec3& from, const dvec3& to, double radius) {
    return view.outside(from - view.eye, to - view.eye, radius);
  });
  if (!effects_.beam_shadows) return;
  // All views of one picture choose alike, so that no shadow ends where they meet.
  BeamView beams{view.eye, [](const dvec3&, double) { return 1.0; }};
  if (!faces_) beams.share = [&](const dvec3& center, double radius) { return view.share(center, radius); };
  beam_tiles_ = lighting_->draw_beams(slot, beams);
}

void CameraPass::draw_moving(gpu::Cmd& cmd, const CameraView& view) {
  std::vector<uint32_t> order = visible(draws_->moving(), view);
  draw_glazed(cmd, view, draws_->moving(),
              take_glazed(order, draws_->moving(), lighting_->body_poses(), view.eye, pane_reach(view)));
  const gpu::GraphicsPipeline* bound = nullptr;
  for (const uint32_t i : order) {
    const DrawPiece& piece = draws_->moving()[i];
    const Pose& pose = lighting_->body_poses()[piece.body];
    // Where the eye is outside of a closed body, its back faces are left out.
    const double room = piece.radius() + 1e-3 + 2.0 * double(view.constants.near_m);
    const bool culled = piece.closed && glm::distance(pose.apply(piece.center()), view.eye) > room;
    const gpu::GraphicsPipeline& with = culled ? visibility_closed_ : visibility_moving_;
    if (bound != &with) {
      cmd.bind(with);
      cmd.push(scene_->raster_descriptors());
      bound = &with;
    }
    cmd.constants(view.of_body(pose));
    cmd.draw_range(piece.first_index, piece.index_count, 0);
  }
}

CameraImages CameraPass::collect(const gpu::TickSlot& slot) const {
  return develop_ ? develop_->collect(slot) : CameraImages{.width = desc_.width, .height = desc_.height};
}

}  // namespace greatx::render
