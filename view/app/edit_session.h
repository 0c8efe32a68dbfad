// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Editing a live run. A change goes into the scenario's document. A new run of the changed scenario is then
// made ready beside the run that is shown, at the same tick, and takes its place when its first tick is
// there. A run and its experiment therefore never change, and a change that fails leaves the old run.
//
//   form, gizmo, text, script ─► ScenarioDocument ─► a new ShownRun (thread) ─► the viewer swaps runs
//                                                   └► differences of the tick, before and after
#pragma once

#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/app/disposer.h"
#include "view/app/shown_run.h"
#include "view/edit/difference.h"
#include "view/edit/document.h"

namespace greatx::view {

/// Holds the times of ticks that a run has simulated under one setting.
struct TickSamples {
  std::deque<double> milliseconds;
  std::shared_ptr<const ShownTick> last;
  bool cold = true;  ///< the next tick pays for what is done once, and is not counted

  void add(const std::shared_ptr<const ShownTick>& tick);
  std::optional<double> median_ms() const;
};

/// What a change did: the records of one tick, and the times, before and after.
struct EditComparison {
  std::string label;  ///< "effects.diffraction"
  int64_t tick = 0;
  std::vector<Difference> rows;
  TickSamples before;
};

class EditSession {
 public:
  explicit EditSession(const ViewerOptions& options) : options_(options) {}
  ~EditSession();
  EditSession(const EditSession&) = delete;
  EditSession& operator=(const EditSession&) = delete;

  /// To be called once a frame with the run that is shown. Returns the run that takes its place now, or null.
  std::unique_ptr<ShownRun> update(ShownRun& shown);
  /// Takes a run that is shown no more.
  void retire(std::unique_ptr<ShownRun> run) { disposer_.drop(std::move(run)); }
  Disposer& disposer() { return disposer_; }

  /// Null while the scenario loads, and for data sets.
  const ScenarioDocument* document() const { return document_ ? &*document_ : nullptr; }
  /// These throw UserError if there is no document or the change is refused.
  void change(const YamlChange& change);
  void change(const std::vector<YamlChange>& changes, const std::string& label);
  void change_materials(const std::vector<YamlChange>& changes);
  void replace(const std::string& text);
  void undo();
  void redo();
  /// Reads models and tables again, which may have changed on disk.
  void reload();
  /// An empty `file`: where the document comes from.
  void save(const std::string& file);
  /// The command line that generates a data set of the scenario as it was saved last.
  std::string command() const;

  /// Whether a changed run is being made ready.
  bool preparing() const { return pending_ != nullptr; }
  /// Whether a change, or its comparison, is not done yet.
  bool busy() const {
    return preparing() || comparing_.valid() || reload_ ||
           (document_ && document_->version() != launched_version_);
  }
  std::string activity() const;
  /// Why the last changed scenario cannot run; empty if it can.
  const std::string& error() const { return error_; }
  /// Whether the last change lost comments of the text.
  bool lost_comments() const { return lost_comments_; }
  const std::optional<EditComparison>& comparison() const { return comparison_; }
  const TickSamples& samples() const { return samples_; }

 private:
  ScenarioDocument& need_document();
  void launch(ShownRun& shown);
  void compare(ShownRun& fresh);
  bool failed();
  bool arrived(ShownRun& shown);

  const ViewerOptions& options_;
  std::optional<ScenarioDocument> document_;
  uint64_t launched_version_ = 0;
  std::unique_ptr<ShownRun> pending_;
  bool reload_ = false;  ///< the next run reads all files
  /// The pending run has shown the tick before the wanted one, so that what is done once is done.
  std::shared_ptr<const ShownTick> warm_tick_;
  bool warmed_ = false;
  std::shared_ptr<const ShownTick> tick_before_;
  std::shared_ptr<const io::DatasetInfo> info_before_;
  std::string error_;
  bool lost_comments_ = false;
  TickSamples samples_;
  std::optional<EditComparison> comparison_;
  std::future<std::vector<Difference>> comparing_;
  Disposer disposer_;
};

}  // namespace greatx::view
