// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/recording.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <iostream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/video/frame_file.h"

namespace greatx::view {

namespace {

/// A tick is shown as long as it lasts in the simulation, within these bounds: shorter ones would flicker,
/// and longer ones look as if the recording had stopped.
constexpr int64_t shortest_ms = 20, longest_ms = 500;
constexpr int64_t jump_ms = 100;  ///< of a tick before a jump back, or to another sequence
constexpr double frame_s = 1.0 / 30.0;
constexpr double result_shown_s = 8.0;

int64_t duration_ms(const ShownTick& tick, const ShownTick& next) {
  const int64_t ns = next.packet.time_ns - tick.packet.time_ns;
  if (next.sequence != tick.sequence || ns <= 0) return jump_ms;
  return std::clamp(ns / 1'000'000, shortest_ms, longest_ms);
}

std::string megabytes(uint64_t bytes) {
  return bytes == 0 ? "" : fmt::format(", {:.1f} MB", 1e-6 * static_cast<double>(bytes));
}

std::string counts(const RecorderStatus& status) {
  std::string text = fmt::format("{} picture{}", status.taken, status.taken == 1 ? "" : "s");
  if (status.left_out > 0) text += fmt::format(", {} left out", status.left_out);
  return text + megabytes(status.bytes);
}

}  // namespace

Recording::~Recording() {
  if (!active()) return;
  // The window closes, so the terminal has to tell what became of it.
  if (!stopping_) recorder_->stop(next_ms_);
  recorder_->wait();
  const RecorderStatus status = recorder_->status();
  if (status.taken > 0 && !status.error.empty()) std::cerr << "greatx: " << printable(status.error) << '\n';
}

void Recording::add_commands(Commands& commands) {
  commands.add({"record",
                "View",
                "Record the window...",
                "F9",
                [this](const std::string& argument) { command(argument, Each::tick); },
                [this] { return active(); },
                {}});
  commands.add({"record.frames",
                "View",
                "Record every frame...",
                "",
                [this](const std::string& argument) { command(argument, Each::frame); },
                [this] { return active() && each_ == Each::frame; },
                {}});
}

void Recording::command(const std::string& argument, Each each) {
  if (argument == "stop" || (argument.empty() && active())) {
    if (!active()) throw_user_error("record stop: nothing is being recorded");
    return stop();
  }
  if (!argument.empty()) return start(folder_ / argument, each);
  dialog_open_ = true;
  dialog_ticks_ = each == Each::tick;
  const std::string name = free_name().string();
  dialog_name_[name.copy(dialog_name_, sizeof dialog_name_ - 1)] = '\0';
}

/// Returns a name that nothing has yet.
std::filesystem::path Recording::free_name() const {
  std::error_code error;
  for (int i = 1; i < 1000; ++i) {
    const std::filesystem::path path = folder_ / fmt::format("recording_{:03}.webp", i);
    if (!std::filesystem::exists(path, error)) return path;
  }
  return folder_ / "recording.webp";
}

void Recording::start(const std::filesystem::path& path, Each each) {
  if (active()) throw_user_error("record: {} is still being recorded", printable(recorder_->path().string()));
  error_.clear();
  result_.clear();
  recorder_ =
      std::make_unique<Recorder>(path, scripted_ ? Recorder::WhenFull::wait : Recorder::WhenFull::leave_out);
  each_ = each;
  stopping_ = false;
  recorded_.reset();
  next_ms_ = 0;
  began_s_ = ImGui::GetTime();
  last_frame_s_ = -1.0;
}

void Recording::stop() {
  if (stopping_) return;
  if (each_ == Each::tick) record_tick();
  stopping_ = true;
  recorder_->stop(next_ms_ + (each_ == Each::tick ? jump_ms : 0));
  if (!scripted_) return;
  recorder_->wait();
  take_end();
  if (!error_.empty()) throw_user_error("{}", error_);
}

/// Records the last frame, which shows `drawn_`, if that is a tick that was not recorded.
void Recording::record_tick() {
  if (drawn_ == nullptr || drawn_ == recorded_) return;
  if (recorded_ != nullptr) next_ms_ += duration_ms(*recorded_, *drawn_);
  recorder_->add(window_.screenshot(), next_ms_);
  recorded_ = drawn_;
}

void Recording::before_tick(const std::shared_ptr<const ShownTick>& tick) {
  if (active() && !stopping_ && each_ == Each::tick && tick != drawn_) record_tick();
  drawn_ = tick;
}

void Recording::frame_drawn() {
  if (!active()) return;
  const double now_s = ImGui::GetTime();
  if (!stopping_ && each_ == Each::frame && now_s - last_frame_s_ > 0.99 * frame_s) {
    last_frame_s_ = now_s;
    const auto start_ms = static_cast<int64_t>(std::llround(1e3 * (now_s - began_s_)));
    recorder_->add(window_.screenshot(), next_ms_ == 0 ? 0 : start_ms);
    next_ms_ = start_ms + static_cast<int64_t>(1e3 * frame_s);
  }
  if (recorder_->status().done) take_end();
}

/// Takes the outcome of a recording that has ended, by the user or by an error.
void Recording::take_end() {
  const RecorderStatus status = recorder_->status();
  error_ = status.error;
  if (!status.note.empty()) error_ = status.note;
  if (status.error.empty()) result_ = fmt::format("{}: {}", recorder_->path().string(), counts(status));
  result_at_s_ = ImGui::GetTime();
  recorder_.reset();
}

std::string Recording::status_text() const {
  if (active()) {
    const RecorderStatus status = recorder_->status();
    if (!stopping_) return "REC " + counts(status);
    return fmt::format("writing {}: {} of {} pictures", printable(recorder_->path().filename().string()),
                       status.written, status.taken);
  }
  return ImGui::GetTime() - result_at_s_ < result_shown_s ? printable(result_) : "";
}

void Recording::draw() {
  if (!dialog_open_) return;
  ImGui::SetNextWindowPos({80.0f, 80.0f}, ImGuiCond_Appearing);
  if (ImGui::Begin("Record", &dialog_open_, ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::SetNextItemWidth(28.0f * ImGui::GetFontSize());
    ImGui::InputText("file", dialog_name_, sizeof dialog_name_);
    ImGui::TextDisabled("%s; a name without an ending becomes a folder of PNG files",
                        io::frame_file_endings().c_str());
    if (!io::writes_video()) ImGui::TextDisabled("Videos: this greatx was built without libavformat.");
    if (ImGui::RadioButton("one picture for each tick", dialog_ticks_)) dialog_ticks_ = true;
    if (ImGui::RadioButton("every frame, 30 a second", !dialog_ticks_)) dialog_ticks_ = false;
    if (ImGui::Button("Record")) {
      dialog_open_ = false;
      try {
        start(dialog_name_, dialog_ticks_ ? Each::tick : Each::frame);
      } catch (const UserError& error) {
        error_ = error.what();
      }
    }
    ImGui::SameLine();
    ImGui::TextDisabled("F9 ends it");
  }
  ImGui::End();
}

}  // namespace greatx::view
