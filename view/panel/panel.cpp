// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/panel.h"

#include <algorithm>
#include <cmath>

#include "draw/sheet/sheet_tiles.h"
#include "view/panel/panel_kinds.h"

namespace greatx::view {

namespace theme = io::theme;

namespace {

/// A picture of the contact sheet, one record at a time.
class FrameView : public Panel {
 public:
  FrameView(const PanelChoice& choice, Records records, const io::FrameKind& kind)
      : Panel(choice, std::move(records)), kind_(kind) {}
  PanelSize wanted() const override {
    PanelSize size{400, 300 + io::sheet::legend_height};
    const auto array = std::ranges::find(spec().arrays, kind_.arrays[0], &ArraySpec::name);
    const std::vector<int64_t>& shape = array->shape;
    if (spec().kind == "camera" && shape.size() >= 2 && shape[0] > 0 && shape[1] > 0)
      size.height =
          static_cast<int>(std::clamp<int64_t>(shape[0] * size.width / shape[1], 100, 2 * size.width)) +
          io::sheet::legend_height;
    return size;
  }

 protected:
  void load(const io::IndexRow& row) override {
    panel_ = kind_.make(source({row}));
    if (panel_ == nullptr)
      throw_user_error("{}: its metadata do not say how to draw {}", spec().name, kind_.name);
  }
  void paint(io::Canvas& canvas) override {
    const int legend = canvas.height() >= 4 * io::sheet::legend_height ? io::sheet::legend_height : 0;
    const io::Rect tile{0, 0, canvas.width(), canvas.height() - legend};
    canvas.fill(tile, theme::panel);
    picture_ = io::fit(tile, panel_->aspect());
    if (legend > 0)
      panel_->draw(canvas, picture_, {2, tile.bottom() + 2, canvas.width() - 4, legend - 4}, 0);
    else
      panel_->draw(canvas, picture_, {0, canvas.height(), 0, 0}, 0);
  }
  std::string text_at(int x, int y) override { return panel_->value_at(picture_, 0, x, y, names()); }
  std::string nothing() override { return panel_->nothing_of(0); }

 private:
  const io::FrameKind& kind_;
  std::unique_ptr<io::FramePanel> panel_;
  io::Rect picture_;
};

const std::vector<PanelKind>& own_kinds() {
  static const std::vector<PanelKind> kinds = [] {
    std::vector<PanelKind> all;
    for (const auto list :
         {time_surface_kinds, range_image_kinds, channel_kinds, path_kinds, link_kinds, motion_kinds})
      for (PanelKind& kind : list()) all.push_back(std::move(kind));
    return all;
  }();
  return kinds;
}

}  // namespace

Panel::Panel(PanelChoice choice, std::shared_ptr<const io::RecordSource> records)
    : choice_(std::move(choice)), records_(std::move(records)) {}

void Panel::show(const ShownTick& tick) {
  std::optional<io::IndexRow> found;
  for (const io::IndexRow& row : records_->records_of(tick.sequence, choice_.sensor))
    if (row.tick <= tick.packet.tick) found = row;
  if (tick.sequence == sequence_ && found == row_) return;
  // The position among the records that are kept changes when old ones go; the record does not.
  const bool same = tick.sequence == sequence_ && found && row_ && found->tick == row_->tick;
  sequence_ = tick.sequence;
  row_ = found;
  if (same) return;
  loaded_ = drawn_ = false;
}

const Array& Panel::draw(int width, int height) {
  GREATX_CHECK(width > 0 && height > 0 && width <= 16384 && height <= 16384, "a panel of {} x {}", width,
               height);
  if (drawn_ && picture_.shape == std::vector<int64_t>{height, width, 3}) return picture_;
  io::Canvas canvas(width, height, theme::page);
  try {
    if (!loaded_ && row_) {
      error_.clear();
      load(*row_);
      loaded_ = true;
    }
    if (row_ && error_.empty()) {
      paint(canvas);
      if (const std::string none = nothing(); !none.empty()) write_note(canvas, none, theme::text);
    }
  } catch (const UserError& error) {
    error_ = error.what();
    loaded_ = true;  // the same record would fail again
  }
  if (!row_) write_note(canvas, "no record yet", theme::dim);
  if (!error_.empty()) {
    canvas.unclip();
    canvas.fill({0, 0, width, height}, theme::page);
    write_note(canvas, error_, {255, 120, 120});
  }
  picture_ = canvas.image();
  drawn_ = true;
  ++version_;
  return picture_;
}

std::string Panel::value_at(int x, int y) {
  if (!drawn_ || !row_ || !error_.empty()) return {};
  if (x < 0 || y < 0 || x >= picture_.shape[1] || y >= picture_.shape[0]) return {};
  try {
    return text_at(x, y);
  } catch (const UserError& error) {
    return error.what();
  }
}

void Panel::set_knob(std::string_view name, double value) {
  const auto found = std::ranges::find(knobs_, name, &PanelKnob::name);
  GREATX_CHECK(found != knobs_.end(), "{} has no knob {}", choice_.title, name);
  value = std::clamp(std::isfinite(value) ? value : found->value, found->least, found->most);
  if (found->whole) value = std::round(value);
  if (value == found->value) return;
  found->value = value;
  loaded_ = drawn_ = false;
}

double Panel::knob(std::string_view name) const {
  const auto found = std::ranges::find(knobs_, name, &PanelKnob::name);
  GREATX_CHECK(found != knobs_.end(), "{} has no knob {}", choice_.title, name);
  return found->value;
}

io::PanelSource Panel::source(std::vector<io::IndexRow> rows) const {
  return {*records_, sequence_, choice_.sensor, std::move(rows)};
}

std::vector<io::IndexRow> Panel::past(size_t most) const {
  if (!row_) return {};
  std::vector<io::IndexRow> rows = records_->records_of(sequence_, choice_.sensor);
  std::erase_if(rows, [&](const io::IndexRow& row) { return row.tick > row_->tick; });
  if (rows.size() > most) rows.erase(rows.begin(), rows.end() - static_cast<std::ptrdiff_t>(most));
  return rows;
}

Array Panel::read(const io::IndexRow& row, const char* array, const std::vector<DType>& types,
                  const std::vector<int64_t>& shape) const {
  return source().load(row, array, types, shape);
}

const io::SceneNames& Panel::names() {
  if (!names_) names_ = io::scene_names(*records_);
  return *names_;
}

std::vector<PanelChoice> panels_of(std::span<const SensorSpec> sensors) {
  std::vector<PanelChoice> choices;
  for (uint32_t s = 0; s < sensors.size(); ++s) {
    const auto add = [&](const char* kind) {
      choices.push_back({s, kind, fmt::format("{}: {}", sensors[s].name, kind)});
    };
    for (const io::FrameKind& kind : io::frame_kinds(sensors[s].kind))
      if (io::has_arrays(sensors[s], kind.arrays)) add(kind.name);
    for (const PanelKind& kind : own_kinds())
      if (sensors[s].kind == kind.sensor && io::has_arrays(sensors[s], kind.arrays)) add(kind.name);
  }
  return choices;
}

std::unique_ptr<Panel> make_panel(const PanelChoice& choice,
                                  std::shared_ptr<const io::RecordSource> records) {
  if (choice.sensor >= records->sensors().size())
    throw_user_error("{}: expected sensor 0 to {}, found {}", records->place(),
                     std::ssize(records->sensors()) - 1, choice.sensor);
  const SensorSpec& sensor = records->sensors()[choice.sensor];
  PanelChoice titled = choice;
  if (titled.title.empty()) titled.title = fmt::format("{}: {}", sensor.name, choice.kind);
  for (const io::FrameKind& kind : io::frame_kinds(sensor.kind)) {
    if (choice.kind != kind.name) continue;
    require_arrays(sensor, kind.arrays, choice.kind);
    return std::make_unique<FrameView>(titled, std::move(records), kind);
  }
  for (const PanelKind& kind : own_kinds()) {
    if (sensor.kind != kind.sensor || choice.kind != kind.name) continue;
    require_arrays(sensor, kind.arrays, choice.kind);
    return kind.make(titled, std::move(records));
  }
  throw_user_error("{}: a sensor of the kind '{}' has no panel '{}'", sensor.name, sensor.kind, choice.kind);
}

}  // namespace greatx::view
