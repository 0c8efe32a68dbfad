// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/script_runner.h"

#include "core/error.h"

namespace greatx::view {

bool ScriptRunner::run(const ScriptStep& step, const ScriptHost& host) {
  using Kind = ScriptStep::Kind;
  switch (step.kind) {
    case Kind::wait_ready:
      return host.ready();
    case Kind::wait_scene:
      return host.content().picture != nullptr || host.run().status().phase == RunStatus::Phase::failed;
    case Kind::wait_picture:
      return host.settled();
    case Kind::wait_tick:
      // A run that plays may have gone past it.
      return host.tick() == step.number || (host.tick() > step.number && host.run().status().playing);
    case Kind::wait_frames:
      return frames_ >= step.number;
    case Kind::input:
      if (frames_ == 0)
        for (const InputEvent& event : step.events) host.inject(event);
      return frames_ > static_cast<int64_t>(step.events.size());  // one event a frame
    case Kind::act:
      host.act(step.text, step.argument);
      return true;
    case Kind::screenshot:
      host.screenshot(step.text);
      return true;
    case Kind::print:
      host.print(step.text);
      return true;
    case Kind::quit:
      return false;
  }
  return true;
}

bool ScriptRunner::advance(const ScriptHost& host) {
  while (next_ < steps_.size()) {
    const ScriptStep& step = steps_[next_];
    if (step.kind == ScriptStep::Kind::quit) return false;
    if (!run(step, host)) {
      if (++frames_ > most_frames)
        throw_user_error("the script's line {} waits in vain: {} frames have passed", step.line, most_frames);
      return true;
    }
    ++next_;
    frames_ = 0;
  }
  return false;
}

}  // namespace greatx::view
