// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/animation.h"

#include <cmath>

#include "io/dataset/summary.h"
#include "io/formats/webp.h"

namespace greatx::io {

namespace {

using namespace sheet;

constexpr int frame_header_height = 84, bar_height = 4;
constexpr int shortest_own_step_ms = 25, longest_own_step_ms = 150, step_otherwise_ms = 100;

size_t columns_for(size_t panels) { return panels == 4 ? 2 : std::min<size_t>(panels, 3); }

std::string speed_text(double speed) {
  return std::abs(speed - 1.0) < 0.005 ? "real time" : fmt::format("{:.3g} x real time", speed);
}

}  // namespace

Playback playback_of(const std::vector<SheetMoment>& moments) {
  GREATX_CHECK(!moments.empty(), "no moments");
  if (moments.size() == 1) return {{0}, step_otherwise_ms, 1.0};
  const double total_ms = 1e-6 * static_cast<double>(moments.back().time_ns - moments.front().time_ns);
  const double own_step_ms = total_ms / static_cast<double>(moments.size() - 1);
  const bool own = own_step_ms >= shortest_own_step_ms && own_step_ms <= longest_own_step_ms;
  for (size_t i = 1; i < moments.size(); ++i)
    if (moments[i].time_ns <= moments[i - 1].time_ns)
      throw_user_error("animation: expected times that ascend, found {} ns behind {} ns", moments[i].time_ns,
                       moments[i - 1].time_ns);
  Playback playback;
  playback.speed = own ? 1.0 : own_step_ms / step_otherwise_ms;
  for (size_t i = 0; i < moments.size(); ++i) {
    const auto since_first = static_cast<double>(moments[i].time_ns - moments[0].time_ns);
    playback.start_ms.push_back(own ? static_cast<int>(std::lround(1e-6 * since_first))
                                    : static_cast<int>(i) * step_otherwise_ms);
  }
  playback.end_ms =
      playback.start_ms.back() + (own ? static_cast<int>(std::lround(own_step_ms)) : step_otherwise_ms);
  return playback;
}

Animation::Animation(const DatasetReader& reader, size_t frames, uint32_t sequence) {
  if (frames == 0) throw_user_error("animation: expected 1 frame or more, found 0");
  check_has_records(reader, sequence);
  moments_ = choose_moments(reader, sequence, frames);
  try {
    playback_ = playback_of(moments_);
  } catch (const UserError& error) {
    throw_user_error("{}: {}", (reader.folder() / sequence_folder(sequence)).string(), error.what());
  }
  choose_panels(reader, sequence);
  draw_background(summarize(reader).title);
}

void Animation::choose_panels(const DatasetReader& reader, uint32_t sequence) {
  std::vector<Panels> all = panels_by_sensor(reader, sequence, moments_);
  for (Panels& panels : all)
    for (auto& panel : panels.frames) panels_.frames.push_back(std::move(panel));
  const size_t count = panels_.frames.size();
  if (count == 0)
    throw_user_error("{}: no sensor of sequence {} is drawn moment by moment, so there is nothing to animate",
                     reader.folder().string(), sequence);
  const size_t columns = columns_for(count);
  bands_ = make_bands(panels_.frames, columns);
  const size_t free = bands_.size() * columns - count;
  for (Panels& panels : all)
    if (!panels.series.empty() && panels_.series.size() < free)
      panels_.series.push_back(std::move(panels.series[0]));

  int y = margin + frame_header_height;
  for (const Band& band : bands_) {
    tops_.push_back(y + title_height);
    y += title_height + band.picture_height + legend_height + row_gap;
  }
  const auto wide = static_cast<int>(columns);
  background_ = Canvas(2 * margin + wide * (tile_width + gap) - gap, y - row_gap + margin / 2, theme::page);
}

Rect Animation::tile(const Band& band, size_t column) const {
  return {margin + static_cast<int>(column) * (tile_width + gap),
          tops_[static_cast<size_t>(&band - bands_.data())], tile_width, band.picture_height};
}

void Animation::draw_background(const std::string& title) {
  background_.text(margin, margin, title, 3, theme::text);
  background_.fill({margin, margin + 64, width() - 2 * margin, bar_height}, theme::grid);
  for (const Band& band : bands_)
    for (size_t c = 0; c < band.count; ++c) {
      const Rect at = tile(band, c);
      draw_title(background_, at.x, at.y - title_height, panels_.frames[band.first + c]->title());
    }
  for (size_t i = 0; i < panels_.series.size(); ++i) {
    const Rect at = tile(bands_.back(), bands_.back().count + i);
    draw_title(background_, at.x, at.y - title_height, panels_.series[i]->title());
    panels_.series[i]->draw(background_, {at.x, at.y, at.width, at.height + legend_height});
  }
}

Array Animation::frame(size_t i) const {
  const SheetMoment& moment = moments_.at(i);
  Canvas canvas = background_;
  const std::string line =
      fmt::format("{:.3f} s   tick {}   frame {} of {}   {}", 1e-9 * static_cast<double>(moment.time_ns),
                  moment.tick, i + 1, frames(), speed_text(playback_.speed));
  canvas.text(margin, margin + 34, line, theme::text_scale, theme::dim);
  const auto whole = static_cast<size_t>(width() - 2 * margin);
  canvas.fill({margin, margin + 64, static_cast<int>(whole * (i + 1) / frames()), bar_height}, theme::text);
  for (const Band& band : bands_)
    for (size_t c = 0; c < band.count; ++c)
      draw_tile(canvas, *panels_.frames[band.first + c], tile(band, c), i);
  return canvas.image();
}

AnimationFile write_animation(const DatasetReader& reader, const std::filesystem::path& file, size_t frames,
                              uint32_t sequence) {
  if (file.extension() != ".webp")
    throw_user_error("animation: expected a file name that ends in .webp, found '{}'", file.string());
  const Animation animation(reader, frames, sequence);
  if (animation.height() > webp_longest_side)
    throw_user_error("{}: the panels of all sensors make {} x {} pixels, but a WebP has at most {} a side",
                     file.string(), animation.width(), animation.height(), webp_longest_side);
  const Playback& playback = animation.playback();
  WebpAnimator animator(animation.width(), animation.height());
  for (size_t i = 0; i < animation.frames(); ++i) animator.add(animation.frame(i), playback.start_ms[i]);
  const Bytes webp = animator.finish(playback.end_ms);
  create_folder_of(file);
  write_file_atomically(file, webp);
  return {animation.frames(), animation.width(), animation.height(), playback.end_ms, webp.size()};
}

}  // namespace greatx::io
