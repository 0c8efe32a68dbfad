// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/edit_session.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace greatx::view {

namespace {

constexpr size_t most_samples = 50;

/// Returns a word of a command line, in quotes if a shell would take it apart.
std::string shell_word(const std::string& text) {
  const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./=+,:@").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

void TickSamples::add(const std::shared_ptr<const ShownTick>& tick) {
  if (tick == nullptr || tick == last) return;
  last = tick;
  if (std::exchange(cold, false)) return;
  milliseconds.push_back(tick->simulated_ms);
  if (milliseconds.size() > most_samples) milliseconds.pop_front();
}

std::optional<double> TickSamples::median_ms() const {
  if (milliseconds.empty()) return {};
  std::vector<double> sorted(milliseconds.begin(), milliseconds.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  return *middle;
}

EditSession::~EditSession() { disposer_.drop(std::move(pending_)); }

ScenarioDocument& EditSession::need_document() {
  if (!document_)
    throw_user_error("{}", options_.datasets.empty()
                               ? "the scenario is not there yet"
                               : "a data set cannot be edited; view its scenario instead");
  return *document_;
}

void EditSession::change(const YamlChange& change) {
  this->change(std::vector{change}, yaml_path_text(change.path));
}
void EditSession::change(const std::vector<YamlChange>& changes, const std::string& label) {
  error_.clear();
  lost_comments_ = !need_document().change(changes, label);
}
void EditSession::change_materials(const std::vector<YamlChange>& changes) {
  error_.clear();
  lost_comments_ = false;
  need_document().change_materials(changes);
}
void EditSession::replace(const std::string& text) {
  error_.clear();
  lost_comments_ = false;
  need_document().replace(text);
}
void EditSession::undo() { need_document().undo(); }
void EditSession::redo() { need_document().redo(); }
void EditSession::reload() {
  need_document();
  reload_ = true;
}

void EditSession::save(const std::string& file) {
  ScenarioDocument& document = need_document();
  document.save(file.empty() ? document.file() : std::filesystem::path(file));
}

std::string EditSession::command() const {
  if (!document_) return "";
  std::string text = "greatx generate " + shell_word(document_->file().string());
  if (!options_.assets.empty()) text += " --assets " + shell_word(options_.assets.string());
  return text + " --output " + shell_word("out/" + document_->scenario().name);
}

std::string EditSession::activity() const {
  if (pending_ == nullptr) return "";
  const std::string what = pending_->run().status().activity;
  return what.empty() ? "preparing the change" : what;
}

void EditSession::launch(ShownRun& shown) {
  disposer_.drop(std::move(pending_));
  launched_version_ = document_->version();
  std::shared_ptr<const sim::Experiment> before = reload_ ? nullptr : shown.experiment();
  reload_ = false;
  pending_ = ShownRun::changed(shown.name(), options_, document_->scenario(), std::move(before));
  tick_before_ = shown.run().shown();
  info_before_ = shown.info();
  warm_tick_.reset();
  warmed_ = tick_before_ == nullptr || tick_before_->packet.tick == 0;
  if (tick_before_ == nullptr) return;
  pending_->run().jump(tick_before_->sequence, tick_before_->packet.tick);
  if (!warmed_) pending_->run().step(-1);
}

/// Drops a changed run that cannot show its tick, and keeps its error.
bool EditSession::failed() {
  const RunStatus status = pending_->run().status();
  if (status.error.empty()) return false;
  error_ = status.error;
  disposer_.drop(std::move(pending_));
  return true;
}

/// Tells whether the changed run shows the wanted tick.
bool EditSession::arrived(ShownRun& shown) {
  pending_->update();
  if (failed()) return false;
  const std::shared_ptr<const ShownTick> tick = pending_->run().shown();
  if (pending_->experiment() == nullptr || pending_->info() == nullptr || tick == nullptr) return false;
  if (!warmed_ && warm_tick_ == nullptr) {
    warm_tick_ = tick;
    pending_->run().jump(tick_before_->sequence, tick_before_->packet.tick);
  }
  if (!warmed_ && tick == warm_tick_) return false;
  const RunStatus now = shown.run().status();
  pending_->run().set_speed(now.speed);
  pending_->run().play(now.playing);
  return true;
}

void EditSession::compare(ShownRun& fresh) {
  const std::shared_ptr<const ShownTick> tick = fresh.run().shown();
  comparison_.reset();
  if (tick_before_ == nullptr || tick_before_->sequence != tick->sequence ||
      tick_before_->packet.tick != tick->packet.tick)
    return;
  comparison_ = EditComparison{document_->label(), tick->packet.tick, {}, std::move(samples_)};
  comparison_->before.last.reset();
  comparing_ = std::async(std::launch::async, [a = info_before_, x = tick_before_, b = fresh.info(),
                                               y = tick] { return differences(*a, *x, *b, *y); });
}

std::unique_ptr<ShownRun> EditSession::update(ShownRun& shown) {
  if (!document_ && options_.reparse && shown.experiment() != nullptr) {
    const sim::Scenario& first = shown.experiment()->scenario;
    document_.emplace(first,
                      [this, first](const std::string& text) { return options_.reparse(first, text); });
  }
  if (!document_) return nullptr;
  samples_.add(shown.run().shown());
  if (comparing_.valid() && comparing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    std::vector<Difference> rows = comparing_.get();
    if (comparison_) comparison_->rows = std::move(rows);
  }
  if (document_->version() != launched_version_ || reload_) launch(shown);
  if (pending_ == nullptr || !arrived(shown)) return nullptr;
  compare(*pending_);
  samples_ = {};
  samples_.cold = !warmed_;
  tick_before_.reset();
  info_before_.reset();
  return std::move(pending_);
}

}  // namespace greatx::view
