// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/script/script.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/budget.h"
#include "core/input_file.h"
#include "core/text.h"
#include "core/vec.h"

namespace greatx::view {

namespace {

using Kind = InputEvent::Kind;

constexpr double most_pixels = 16384.0;
constexpr double most_number = 1e12;

struct NamedKey {
  std::string_view name;
  int code;
};
// GLFW's codes of the keys that are no letters or digits (glfw3.h).
constexpr NamedKey named_keys[] = {{"space", 32},      {"comma", 44},     {"minus", 45},  {"period", 46},
                                   {"plus", 61},       {"escape", 256},   {"enter", 257}, {"tab", 258},
                                   {"right", 262},     {"left", 263},     {"down", 264},  {"up", 265},
                                   {"pageup", 266},    {"pagedown", 267}, {"home", 268},  {"end", 269},
                                   {"backspace", 259}, {"delete", 261},   {"shift", 340}};

/// One line of the script as words.
class Line {
 public:
  Line(const std::string& text, SourceLocation where) : where_(std::move(where)) {
    std::istringstream stream(text.substr(0, text.find('#')));
    for (std::string word; stream >> word;) words_.push_back(word);
  }
  bool empty() const { return words_.empty(); }
  const std::string& action() const { return words_[0]; }
  size_t arguments() const { return words_.size() - 1; }
  const SourceLocation& where() const { return where_; }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw_user_error_at(where_, "{}: expected {}, found {}", action(), expected, found);
  }
  const std::string& word(size_t i, const char* expected) const {
    if (i >= words_.size()) fail(expected, "nothing");
    return words_[i];
  }
  double number(size_t i, const char* expected, double least, double most) const {
    const std::string& text = word(i, expected);
    const auto value = parse_number(text);
    if (!value || *value < least || *value > most)
      fail(fmt::format("{} from {:g} to {:g}", expected, least, most), fmt::format("'{}'", printable(text)));
    return *value;
  }
  int64_t integer(size_t i, const char* expected) const {
    const double value = number(i, expected, 0.0, most_number);
    if (value != std::floor(value)) fail(expected, fmt::format("'{}'", printable(words_[i])));
    return static_cast<int64_t>(value);
  }
  double pixel(size_t i) const { return number(i, "a pixel", 0.0, most_pixels); }
  /// Throws if there are more words than `count` arguments.
  void end(size_t count) const {
    if (arguments() > count)
      fail(fmt::format("{} arguments at most", count), fmt::format("'{}'", printable(words_[count + 1])));
  }
  /// The words from `i` on, joined by spaces.
  std::string rest(size_t i) const {
    std::string text;
    for (; i < words_.size(); ++i) text += (text.empty() ? "" : " ") + words_[i];
    return text;
  }

 private:
  SourceLocation where_;
  std::vector<std::string> words_;
};

int button_of(const Line& line, size_t i) {
  if (line.arguments() < i) return 0;
  const std::string& name = line.word(i, "a button");
  if (name == "left") return 0;
  if (name == "right") return 1;
  if (name == "middle") return 2;
  line.fail("left, right or middle", fmt::format("'{}'", printable(name)));
}

InputEvent mouse(Kind kind, double x, double y, int button = 0) {
  InputEvent event;
  event.kind = kind;
  event.x = x;
  event.y = y;
  event.button = button;
  return event;
}

ScriptStep input(std::vector<InputEvent> events) {
  ScriptStep step;
  step.kind = ScriptStep::Kind::input;
  step.events = std::move(events);
  return step;
}

ScriptStep drag(const Line& line) {
  constexpr int parts = 8;  // as a hand would: in steps
  const dvec2 from(line.pixel(1), line.pixel(2)), to(line.pixel(3), line.pixel(4));
  const int button = button_of(line, 5);
  line.end(5);
  std::vector<InputEvent> events{mouse(Kind::move, from.x, from.y),
                                 mouse(Kind::press, from.x, from.y, button)};
  for (int i = 1; i <= parts; ++i) {
    const dvec2 at = from + (to - from) * (static_cast<double>(i) / parts);
    events.push_back(mouse(Kind::move, at.x, at.y));
  }
  events.push_back(mouse(Kind::release, to.x, to.y, button));
  return input(std::move(events));
}

ScriptStep click(const Line& line) {
  const double x = line.pixel(1), y = line.pixel(2);
  const int button = button_of(line, 3);
  line.end(3);
  return input(
      {mouse(Kind::move, x, y), mouse(Kind::press, x, y, button), mouse(Kind::release, x, y, button)});
}

ScriptStep key(const Line& line) {
  std::string name = line.word(1, "a key");
  line.end(1);
  InputEvent down;
  down.kind = Kind::key_down;
  for (size_t plus; (plus = name.find('+')) != std::string::npos && plus + 1 < name.size();) {
    const std::string modifier = name.substr(0, plus);
    if (modifier == "ctrl") {
      down.control = true;
    } else if (modifier == "shift") {
      down.shift = true;
    } else if (modifier == "alt") {
      down.alt = true;
    } else {
      line.fail("ctrl, shift or alt before '+'", fmt::format("'{}'", printable(modifier)));
    }
    name.erase(0, plus + 1);
  }
  down.key = key_of(name);
  if (down.key == 0)
    line.fail(
        "a letter, a digit, F1 to F12, space, enter, escape, tab, an arrow, home, end, pageup or pagedown",
        fmt::format("'{}'", printable(name)));
  InputEvent up = down;
  up.kind = Kind::key_up;
  return input({down, up});
}

ScriptStep wait(const Line& line) {
  ScriptStep step;
  constexpr const char* expected = "ready, scene, picture, tick N or frames N";
  const std::string& what = line.word(1, expected);
  if (what == "ready" || what == "scene") {
    step.kind = what == "ready" ? ScriptStep::Kind::wait_ready : ScriptStep::Kind::wait_scene;
    line.end(1);
  } else if (what == "picture") {
    step.kind = ScriptStep::Kind::wait_picture;
    line.end(1);
  } else if (what == "tick" || what == "frames") {
    step.kind = what == "tick" ? ScriptStep::Kind::wait_tick : ScriptStep::Kind::wait_frames;
    step.number = line.integer(2, "a whole number");
    line.end(2);
  } else {
    line.fail(expected, fmt::format("'{}'", printable(what)));
  }
  return step;
}

ScriptStep scale(const Line& line) {
  InputEvent event;
  event.kind = Kind::scale;
  event.x = line.number(1, "a scale", 0.5, 4.0);
  line.end(1);
  return input({event});
}

ScriptStep window(const Line& line, Kind kind) {
  InputEvent event;
  event.kind = kind;
  if (kind == Kind::resize) {
    event.x = line.number(1, "a width", 64.0, most_pixels);
    event.y = line.number(2, "a height", 64.0, most_pixels);
  }
  line.end(kind == Kind::resize ? 2 : 0);
  return input({event});
}

ScriptStep with_text(const Line& line, ScriptStep::Kind kind, const char* expected) {
  ScriptStep step;
  step.kind = kind;
  step.text = line.word(1, expected);
  step.argument = line.rest(2);
  if (kind != ScriptStep::Kind::act) line.end(1);
  return step;
}

ScriptStep typed(const Line& line) {
  InputEvent event;
  event.kind = Kind::text;
  line.word(1, "a text");
  event.text = line.rest(1);
  return input({event});
}

ScriptStep moved(const Line& line) {
  line.end(2);
  return input({mouse(Kind::move, line.pixel(1), line.pixel(2))});
}

ScriptStep wheel(const Line& line) {
  line.end(3);
  InputEvent turn;
  turn.kind = Kind::wheel;
  turn.y = line.number(3, "turns of the wheel", -100.0, 100.0);
  return input({mouse(Kind::move, line.pixel(1), line.pixel(2)), turn});
}

ScriptStep quit(const Line& line) {
  line.end(0);
  return {};
}

struct Action {
  std::string_view name;
  ScriptStep (*parse)(const Line& line);
};
constexpr Action actions[] = {
    {"wait", wait},
    {"key", key},
    {"text", typed},
    {"move", moved},
    {"click", click},
    {"drag", drag},
    {"wheel", wheel},
    {"resize", [](const Line& line) { return window(line, Kind::resize); }},
    {"scale", scale},
    {"minimize", [](const Line& line) { return window(line, Kind::minimize); }},
    {"restore", [](const Line& line) { return window(line, Kind::restore); }},
    {"do", [](const Line& line) { return with_text(line, ScriptStep::Kind::act, "a command of the menus"); }},
    {"screenshot",
     [](const Line& line) { return with_text(line, ScriptStep::Kind::screenshot, "a file's name (.png)"); }},
    {"print",
     [](const Line& line) { return with_text(line, ScriptStep::Kind::print, "the name of a fact"); }},
    {"quit", quit},
};

}  // namespace

int key_of(const std::string& name) {
  for (const NamedKey& key : named_keys)
    if (key.name == name) return key.code;
  if (name.size() == 1) {
    const char c = name[0];
    if (c >= '0' && c <= '9') return c;
    if (c >= 'a' && c <= 'z') return c - 'a' + 'A';
    if (c >= 'A' && c <= 'Z') return c;
  }
  if (name.size() >= 2 && name.size() <= 3 && name[0] == 'F') {
    const auto number = parse_number(name.substr(1));
    if (number && *number >= 1.0 && *number <= 12.0 && *number == std::floor(*number))
      return 290 + static_cast<int>(*number) - 1;
  }
  return 0;
}

std::vector<ScriptStep> parse_script(const std::string& text, const std::string& name) {
  std::vector<ScriptStep> steps;
  std::istringstream lines(text);
  int number = 0;
  for (std::string words; std::getline(lines, words);) {
    const Line line(words, {name, ++number});
    if (line.empty()) continue;
    const auto* const action = std::ranges::find(actions, line.action(), &Action::name);
    if (action == std::end(actions)) {
      std::vector<std::string> names;
      for (const Action& known : actions) names.emplace_back(known.name);
      throw_user_error_at(line.where(), "expected an action ({}), found '{}'{}", fmt::join(names, ", "),
                          printable(line.action()), suggestion(line.action(), names));
    }
    steps.push_back(action->parse(line));
    steps.back().line = number;
  }
  return steps;
}

std::vector<ScriptStep> load_script(const std::filesystem::path& file) {
  return parse_script(InputFile(file, "a script of the viewer", budget::yaml_file).text(), file.string());
}

}  // namespace greatx::view
