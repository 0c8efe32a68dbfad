// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/help.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/expected.h"
#include "core/text.h"

namespace greatx::apps {

namespace {

constexpr size_t help_columns = 100, left_column = 30;

/// What texts are, by the names of their options.
struct TextValue {
  const char* value;
  const char* options;  ///< with a space before and after each
};
constexpr TextValue text_values[] = {
    {"FILE",
     " animation cfr csv-out glb greatx html json png picture radio-materials receivers script settings "},
    {"DIR", " assets from logs report "},
    {"NAME",
     " account cell channel device knob node only partition precoder quantities receiver rx sensor "
     "transmitter view "},
    {"TX:RX", " link "},
    {"PATH=VALUE", " set "},
    {"WIDTHxHEIGHT", " size "},
    {"SIZE", " memory "},
    {"COUNT", " gpus "},
    {"OPTION", " sbatch "},
    {"LINE", " setup "},
    {"TIME", " merge-time time "},
    {"I/N", " shard "},
};

/// Returns what the text of an option is: "FILE"; a folder if it describes one.
std::string text_value(const CLI::Option& option) {
  if (option.get_lnames().empty()) return "TEXT";
  const std::string& name = option.get_lnames().front();
  if (name == "output") return option.get_description().find("folder") != std::string::npos ? "DIR" : "FILE";
  for (const TextValue& known : text_values)
    if (std::string_view(known.options).find(fmt::format(" {} ", name)) != std::string_view::npos)
      return known.value;
  return "TEXT";
}

/// Breaks a text between words, so that no line is longer than `columns`.
std::vector<std::string> wrapped(const std::string& text, size_t columns) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > columns) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

/// Returns `left` and, in a column to its right or below it, `right`.
std::string two_columns(const std::string& left, const std::string& right) {
  std::string text = "  " + left;
  if (right.empty()) return text + '\n';
  const std::string margin(left_column, ' ');
  if (text.size() + 1 > left_column)
    text += '\n' + margin;
  else
    text.resize(left_column, ' ');
  return fmt::format("{}{}\n", text, fmt::join(wrapped(right, help_columns - left_column), '\n' + margin));
}

/// Returns the type that CLI11 gives an option, without its checks: "UINT" of "UINT:0 to 1024".
std::string bare_type(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

std::string checks_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const size_t colon = type.find(':');
  return colon == std::string::npos ? "" : type.substr(colon + 1);
}

std::string names_of_options(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  return fmt::format("{}", fmt::join(names, ", "));
}

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { label("SUBCOMMAND", "COMMAND"); }

  std::string make_usage(const CLI::App* app, std::string name) const override {
    std::ostringstream text;
    for (const std::string& line : wrapped(CLI::Formatter::make_usage(app, std::move(name)), help_columns))
      text << line << '\n';
    return text.str();
  }
  std::string make_description(const CLI::App* app) const override {
    return fmt::format("{}\n\n", fmt::join(wrapped(app->get_description(), help_columns), "\n"));
  }
  std::string make_footer(const CLI::App* app) const override {
    return fmt::format("{}\n", fmt::join(wrapped(app->get_footer(), help_columns), "\n"));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return two_columns(command->get_name(), command->get_description());
  }
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return two_columns(make_option_name(option, is_positional) + make_option_opts(option),
                       make_option_desc(option));
  }
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    std::string name = CLI::Formatter::make_option_name(option, is_positional);
    // A flag with a value of its own is "--edges{1}".
    if (const size_t brace = name.find('{'); brace != std::string::npos) name.resize(brace);
    return name;
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    if (!option->get_option_text().empty()) return ' ' + option->get_option_text();
    if (option->get_positional()) return option->get_expected_max() > 1 ? " ..." : "";
    const std::string value = value_of(*option);
    if (value.empty()) return range_of(*option).empty() ? "" : "[=N]";  // a flag
    std::string text = ' ' + value;
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) return text + " ...";
    for (int i = 1; i < option->get_expected_min(); ++i) text += ' ' + value;
    return text;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    std::string text = option->get_description();
    const std::set<CLI::Option*> needs = option->get_needs(), excludes = option->get_excludes();
    std::vector<std::string> notes;
    if (option->get_required() && !option->get_positional()) notes.emplace_back("required");
    if (const std::string range = range_of(*option); !range.empty()) notes.push_back(range);
    if (!needs.empty()) notes.push_back("needs " + names_of_options(needs));
    // One of many modes excludes all the others, which the text of each says.
    if (!excludes.empty() && excludes.size() <= 3) notes.push_back("not with " + names_of_options(excludes));
    // A text ends with the default in brackets if there is no value that stands for it.
    const size_t bracket = text.ends_with(']') ? text.rfind(" [") : std::string::npos;
    if (!notes.empty())
      text.insert(std::min(bracket, text.size()), fmt::format(" ({})", fmt::join(notes, "; ")));
    std::string usual = option->get_default_str();
    const bool integer = usual.find_first_not_of("0123456789") == std::string::npos;
    if (const auto value = parse_number(usual); value && integer && *value < 0x1p53)
      usual = integer_words(static_cast<uint64_t>(*value));
    if (!usual.empty()) text += usual.front() == '[' ? ' ' + usual : fmt::format(" [{}]", usual);
    return text;
  }
};

}  // namespace

std::string value_of(const CLI::Option& option) {
  const std::string type = bare_type(option), checks = checks_of(option);
  if (option.get_type_size() == 0 || option.get_expected_max() == 0) return "";
  if (checks.find('|') != std::string::npos) return checks;
  if (type == "UINT" || type == "INT") return "N";
  if (type == "FLOAT") return "X";
  return checks == "FILE" ? checks : type;
}

std::string range_of(const CLI::Option& option) {
  const std::string checks = checks_of(option);
  return checks == "FILE" || checks.find('|') != std::string::npos ? "" : checks;
}

void name_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options(std::function<bool(CLI::Option*)>()))
    if (bare_type(*option) == "TEXT") option->type_name(text_value(*option));
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) name_values(*command);
}

std::shared_ptr<CLI::FormatterBase> help_formatter() { return std::make_shared<HelpFormatter>(); }

}  // namespace greatx::apps
