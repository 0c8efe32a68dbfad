// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/manual/manual_page.h"

#include <fmt/format.h>

namespace greatx::apps {

namespace {

/// Returns text that roff prints as it is. A dash is a minus sign, so that it can be copied into a shell.
std::string roff(const std::string& text) {
  std::string escaped;
  if (text.starts_with('.') || text.starts_with('\'')) escaped = "\\&";
  for (const char c : text) {
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else if (c == '\n')
      escaped += ' ';
    else
      escaped += c;
  }
  return escaped;
}

/// Returns "[-o FILE]", "SCENARIO", "[DIR...]", … for the synopsis of a command.
std::string synopsis_of(const CommandArgument& positional) {
  const std::string name =
      fmt::format("\\fI{}\\fR{}", roff(positional.names[0]), positional.repeats ? "..." : "");
  return positional.required ? name : "[" + name + "]";
}

/// Returns the line that heads an option: names, and its value in italics.
std::string head_of(const CommandArgument& argument, bool positional) {
  std::string head;
  for (const std::string& name : argument.names) {
    if (!head.empty()) head += ", ";
    head += fmt::format("\\f{}{}\\fR", positional ? 'I' : 'B', roff(name));
  }
  if (!positional && argument.takes_value()) head += fmt::format(" \\fI{}\\fR", roff(argument.type));
  return head;
}

void write_argument(std::string& page, const CommandArgument& argument, bool positional) {
  page += fmt::format(".TP\n{}\n{}", head_of(argument, positional), roff(argument.words));
  std::string more;
  const auto add = [&](const std::string& text) {
    more += more.empty() ? "" : "; ";
    more += text;
  };
  if (!argument.choices.empty() && !argument.files) {
    std::string list;
    for (const std::string& choice : argument.choices) list += (list.empty() ? "" : ", ") + choice;
    add("one of " + list);
  }
  if (!argument.range.empty()) add("range: " + argument.range);
  if (!argument.initial.empty()) add("default: " + argument.initial);
  if (argument.repeats) add("may be given several times");
  page += more.empty() ? "\n" : fmt::format(" ({})\n", roff(more));
}

void write_command(std::string& page, const CommandTree& command) {
  page += fmt::format(".SS {}\n{}\n", roff(joined(command.path, ' ')), roff(command.words));
  page += fmt::format(".PP\n\\fB{}\\fR{}", roff(joined(command.path, ' ')),
                      command.options.empty() ? "" : " [\\fIoptions\\fR]");
  for (const CommandArgument& positional : command.positionals) page += " " + synopsis_of(positional);
  if (!command.commands.empty()) page += " \\fIcommand\\fR";
  page += '\n';
  for (const CommandArgument& positional : command.positionals) write_argument(page, positional, true);
  for (const CommandArgument& option : command.options)
    if (option.names.back() != "--help") write_argument(page, option, false);
}

constexpr const char* environment = R"(.SH ENVIRONMENT
.TP
\fBGREATX_DEVICE\fR
Index or part of the name of the Vulkan device, where no option names one.
.TP
\fBGREATX_TRACER\fR
How rays meet triangles: auto, driver or tree.
.TP
\fBGREATX_VALIDATION\fR
If it is 1, commands run under the Vulkan validation layer.
.TP
\fBGREATX_CACHE\fR, \fBGREATX_CACHE_MIB\fR
If the first is off, results of searches are not kept; the second is the largest size of what is kept.
.TP
\fBGREATX_PROGRESS_S\fR
How often, in seconds, progress is reported where the output is no terminal.
.TP
\fBGREATX_DEBUG\fR
If it is set, choices of device, materials and candidates are printed.
.TP
\fBVK_DRIVER_FILES\fR
The description of the only Vulkan driver to be used.
.SH EXIT STATUS
0: success. 1: faulty input or data. 2: the device or the program failed. 130: interrupted.
.SH FILES
.TP
\fI~/.cache/greatx\fR
What searches for paths and calibrations found; \fBgreatx cache\fR shows and empties it.
.TP
\fI~/.config/greatx\fR
Settings of the viewer.
)";

}  // namespace

std::string manual_page(const CommandTree& root, const std::string& version) {
  std::string page = fmt::format(
      ".\\\" Written by `greatx manual`.\n.TH GREATX 1 \"\" \"greatx {}\" \"User Commands\"\n"
      ".SH NAME\ngreatx \\- simulate sensing and communication in one scene on one clock\n"
      ".SH SYNOPSIS\n\\fBgreatx\\fR \\fIcommand\\fR [\\fIoptions\\fR] [\\fIarguments\\fR]\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n",
      version, roff(root.words));
  for (const CommandArgument& option : root.options) write_argument(page, option, false);
  page += ".SH COMMANDS\n";
  for (const CommandTree* command : all_commands(root))
    if (command != &root) write_command(page, *command);
  return page + environment;
}

}  // namespace greatx::apps
