// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pictures and plots of a sensor's records beside the main view. A panel draws into memory and knows what
// each of its pixels shows; the window makes a texture of it. Panels read records alone (io::RecordSource),
// so a live run and a data set look the same. All functions belong to one thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "draw/sheet/panels.h"
#include "view/run/run.h"

namespace greatx::view {

/// A panel that a run can show.
struct PanelChoice {
  uint32_t sensor = 0;  ///< index into the SensorSpecs
  std::string kind;     ///< "depth", "range-Doppler", "delay over time"; unique for the sensor
  std::string title;    ///< "uav/front: depth"
  friend bool operator==(const PanelChoice&, const PanelChoice&) = default;
};

/// A number that the user may set.
struct PanelKnob {
  std::string name, unit;
  double value = 0.0, least = 0.0, most = 1.0;
  bool whole = true;  ///< integers alone
};

struct PanelSize {
  int width = 400, height = 300;  ///< pixels
};

class Panel {
 public:
  virtual ~Panel() = default;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  const PanelChoice& choice() const { return choice_; }
  const std::string& title() const { return choice_.title; }
  virtual PanelSize wanted() const { return {}; }

  /// Chooses the sensor's newest record at or before the tick among those that the source has. It costs
  /// little, because nothing is read before draw().
  void show(const ShownTick& tick);
  /// Returns the picture, u8 [height, width, 3]. It is drawn anew only if the record, a knob or the size has
  /// changed. A record that cannot be drawn gives a picture that says why, and error().
  const Array& draw(int width, int height);
  /// Returns a number that grows with every new picture, so that a texture is updated only then.
  uint64_t version() const { return version_; }
  /// Returns what pixel (x, y) of the picture drawn last shows: the place and the value with its unit, in
  /// lines. Empty where it shows nothing, and outside.
  std::string value_at(int x, int y);
  /// Returns the message of the record drawn last; empty if it could be drawn.
  const std::string& error() const { return error_; }

  const std::vector<PanelKnob>& knobs() const { return knobs_; }
  /// Sets a knob to the value in its range that is nearest. Throws ContractError if there is no such knob.
  void set_knob(std::string_view name, double value);

 protected:
  Panel(PanelChoice choice, std::shared_ptr<const io::RecordSource> records);

  /// Reads what a picture of the record needs. Called before paint() if the record or a knob has changed.
  virtual void load(const io::IndexRow& row) = 0;
  virtual void paint(io::Canvas& canvas) = 0;
  virtual std::string text_at(int x, int y) = 0;
  /// Says what the loaded record has none of; it is written over the picture. Empty if there is something.
  virtual std::string nothing() { return {}; }

  const SensorSpec& spec() const { return records_->sensors()[choice_.sensor]; }
  /// The sensor's records `rows` of the sequence that is shown.
  io::PanelSource source(std::vector<io::IndexRow> rows = {}) const;
  /// The last `most` records of the sequence up to the one that is shown, ascending.
  std::vector<io::IndexRow> past(size_t most) const;
  Array read(const io::IndexRow& row, const char* array, const std::vector<DType>& types,
             const std::vector<int64_t>& shape) const;
  const io::SceneNames& names();
  uint32_t sequence() const { return sequence_; }
  void add_knob(PanelKnob knob) { knobs_.push_back(std::move(knob)); }
  double knob(std::string_view name) const;

 private:
  PanelChoice choice_;
  std::shared_ptr<const io::RecordSource> records_;
  std::optional<io::SceneNames> names_;
  std::vector<PanelKnob> knobs_;
  uint32_t sequence_ = 0;
  std::optional<io::IndexRow> row_;
  bool loaded_ = false, drawn_ = false;
  Array picture_;
  uint64_t version_ = 0;
  std::string error_;
};

/// Lists what sensors with these declarations can show, in the order of the sensors.
std::vector<PanelChoice> panels_of(std::span<const SensorSpec> sensors);
/// Throws UserError if the sensor has no such panel, or lacks an array that it needs; the message names both.
std::unique_ptr<Panel> make_panel(const PanelChoice& choice, std::shared_ptr<const io::RecordSource> records);

}  // namespace greatx::view
