// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/animation.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "io/dataset/summary.h"
#include "io/video/frame_file.h"

namespace greatx::io {

namespace {

using namespace sheet;

constexpr int frame_header_height = 84, bar_height = 4;
constexpr int bar_top = 64;  ///< below the top of the header
constexpr int shortest_own_step_ms = 25, longest_own_step_ms = 150, step_otherwise_ms = 100;

std::string speed_text(double speed) {
  return std::abs(speed - 1.0) < 0.005 ? "real time" : fmt::format("{:.3g} x real time", speed);
}

}  // namespace

Playback playback_of(const std::vector<SheetMoment>& moments, double rate_hz) {
  GREATX_CHECK(!moments.empty(), "no moments");
  for (size_t i = 1; i < moments.size(); ++i)
    if (moments[i].time_ns <= moments[i - 1].time_ns)
      throw_user_error("animation: expected times that ascend, found {} ns behind {} ns", moments[i].time_ns,
                       moments[i - 1].time_ns);
  const double total_ms = 1e-6 * static_cast<double>(moments.back().time_ns - moments.front().time_ns);
  const double own_step_ms = moments.size() < 2 ? 0.0 : total_ms / static_cast<double>(moments.size() - 1);
  const bool own =
      rate_hz == 0.0 && own_step_ms >= shortest_own_step_ms && own_step_ms <= longest_own_step_ms;
  const double step_ms = rate_hz > 0.0 ? 1e3 / rate_hz : own ? own_step_ms : step_otherwise_ms;
  Playback playback;
  playback.speed = own || moments.size() < 2 ? 1.0 : own_step_ms / step_ms;
  for (size_t i = 0; i < moments.size(); ++i) {
    const double since_first_ms = 1e-6 * static_cast<double>(moments[i].time_ns - moments[0].time_ns);
    playback.start_ms.push_back(
        static_cast<int>(std::lround(own ? since_first_ms : static_cast<double>(i) * step_ms)));
  }
  playback.end_ms =
      std::max(playback.start_ms.back() + 1,
               static_cast<int>(std::lround(own ? playback.start_ms.back() + step_ms
                                                : static_cast<double>(moments.size()) * step_ms)));
  return playback;
}

Animation::Animation(const DatasetReader& reader, const AnimationOptions& options, uint32_t sequence) {
  if (options.frames == 0) throw_user_error("animation: expected 1 frame or more, found 0");
  check_has_records(reader, sequence);
  const std::vector<size_t> sensors = shown_sensors(reader, options.sheet.sensors);
  moments_ = choose_moments(reader, sequence, sensors, options.frames);
  if (moments_.empty())
    throw_user_error("{}: the chosen sensors have no records in sequence {}", reader.folder().string(),
                     sequence);
  try {
    playback_ = playback_of(moments_, options.rate_hz);
  } catch (const UserError& error) {
    throw_user_error("{}: {}", (reader.folder() / sequence_folder(sequence)).string(), error.what());
  }
  choose_panels(reader, sequence, sensors, options.sheet);
  draw_background(summarize(reader).title, options.sheet);
}

void Animation::choose_panels(const DatasetReader& reader, uint32_t sequence,
                              const std::vector<size_t>& sensors, const SheetOptions& options) {
  std::vector<std::unique_ptr<SeriesPanel>> further;
  for (Panels& panels : panels_by_sensor(reader, sequence, sensors, moments_, options.panels)) {
    std::ranges::move(panels.frames, std::back_inserter(panels_.frames));
    for (size_t i = 0; i < panels.series.size(); ++i)
      (i == 0 ? panels_.series : further).push_back(std::move(panels.series[i]));
  }
  if (panels_.frames.empty())
    throw_user_error("{}: no sensor of sequence {} is drawn moment by moment, so there is nothing to animate",
                     reader.folder().string(), sequence);
  const size_t tiles = panels_.frames.size() + panels_.series.size(), columns = columns_for(tiles, true);
  const size_t free = (columns - tiles % columns) % columns;
  for (size_t i = 0; i < std::min(free, further.size()); ++i) panels_.series.push_back(std::move(further[i]));
}

void Animation::draw_background(const std::string& title, const SheetOptions& options) {
  LayoutWish wish;
  std::vector<std::vector<KeyEntry>> keys;
  for (const auto& panel : panels_.frames) {
    keys.push_back(panel->key(*options.theme));
    wish.aspects.push_back(panel->aspect());
    wish.key_lines.push_back(keys.back().size());
  }
  wish.plots = panels_.series.size();
  wish.header = frame_header_height;
  wish.animation = true;
  layout_ = sheet_layout(wish);
  constexpr int64_t most_pixels = int64_t{1} << 26;  // of a frame: 200 MB
  if (int64_t{layout_.width} * layout_.height * options.factor * options.factor > most_pixels)
    throw_user_error("animation: expected frames of at most {} pixels, found {} x {}; choose some sensors",
                     most_pixels, layout_.width * options.factor, layout_.height * options.factor);
  background_ = Canvas(layout_.width, layout_.height, *options.theme, options.factor);
  const Rect& head = layout_.header;
  background_.text(head.x, head.y, fitted(title, head.width, 3), 3, options.theme->text);
  background_.fill({head.x, head.y + bar_top, head.width, bar_height}, options.theme->grid);
  for (size_t i = 0; i < panels_.frames.size(); ++i) {
    draw_title(background_, layout_.tiles[i].title, panels_.frames[i]->title());
    draw_key(background_, layout_.tiles[i].key, keys[i]);
  }
  for (size_t i = 0; i < panels_.series.size(); ++i) {
    draw_title(background_, layout_.plots[i].title, panels_.series[i]->title());
    panels_.series[i]->draw(background_, layout_.plots[i].area);
  }
}

Array Animation::frame(size_t i) const {
  const SheetMoment& moment = moments_.at(i);
  const double time_s = 1e-9 * static_cast<double>(moment.time_ns);
  Canvas canvas = background_;
  const Rect& head = layout_.header;
  const std::string line = fmt::format("{:.3f} s   tick {}   frame {} of {}   {}", time_s, moment.tick, i + 1,
                                       frames(), speed_text(playback_.speed));
  canvas.text(head.x, head.y + 34, fitted(line, head.width, theme::text_scale), theme::text_scale,
              canvas.theme().dim);
  const auto done = static_cast<int>(static_cast<size_t>(head.width) * (i + 1) / frames());
  canvas.fill({head.x, head.y + bar_top, done, bar_height}, canvas.theme().text);
  for (size_t p = 0; p < panels_.frames.size(); ++p)
    draw_tile(canvas, *panels_.frames[p], layout_.tiles[p].pictures[0], layout_.tiles[p].legends[0], i);
  for (size_t p = 0; p < panels_.series.size(); ++p)
    panels_.series[p]->mark_time(canvas, layout_.plots[p].area, time_s);
  return canvas.image();
}

AnimationFile write_animation(const DatasetReader& reader, const std::filesystem::path& file,
                              const AnimationOptions& options, uint32_t sequence) {
  check_frame_file(file);
  const Animation animation(reader, options, sequence);
  const Playback& playback = animation.playback();
  create_folder_of(file);
  const std::unique_ptr<FrameFile> written = open_frame_file(file, animation.width(), animation.height());
  for (size_t i = 0; i < animation.frames(); ++i) {
    written->add(animation.frame(i), playback.start_ms[i]);
    if (options.on_frame) options.on_frame(i + 1, animation.frames());
  }
  written->finish(playback.end_ms);
  return {animation.frames(), animation.width(), animation.height(), playback.end_ms, written->bytes()};
}

}  // namespace greatx::io
