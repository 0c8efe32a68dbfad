// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/manual/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace greatx::apps {

namespace {

using Names = std::vector<std::string>;

std::string with_spaces(const Names& names) { return fmt::format("{}", fmt::join(names, " ")); }

/// Returns the beginning of a description, which has to fit beside the completions of a terminal.
std::string brief(std::string words) {
  constexpr size_t longest = 76;
  for (char& c : words)
    if (c == '\n') c = ' ';
  if (words.size() <= longest) return words;
  return words.substr(0, words.rfind(' ', longest)) + " ...";
}

/// Returns text in which each of `special` has a backslash before it.
std::string escaped(const std::string& text, std::string_view special) {
  std::string result;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

/// Returns text as an argument of a POSIX shell, in single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// Returns the paths of all commands below the program, each in quotes: 'greatx scene' 'greatx scene city'.
std::string paths_below(const CommandTree& root, std::string_view separator) {
  std::string list;
  for (const CommandTree* command : all_commands(root)) {
    if (command == &root) continue;
    list += list.empty() ? "" : std::string(separator);
    list += quoted(joined(command->path, ' '));
  }
  return list;
}

Names command_names(const CommandTree& tree) {
  Names names;
  for (const CommandTree& command : tree.commands) names.push_back(command.name());
  return names;
}

// bash: one function, in which case statements hold the tree.

std::string bash_values(const CommandTree& root) {
  std::string cases;
  for (const CommandTree* command : all_commands(root))
    for (const CommandArgument& option : command->options) {
      if (!option.takes_value()) continue;
      Names patterns;
      for (const std::string& name : option.names)
        patterns.push_back(quoted(joined(command->path, ' ') + " " + name));
      cases += fmt::format("    {})\n", fmt::join(patterns, " | "));
      if (!option.choices.empty())
        cases += fmt::format("      mapfile -t COMPREPLY < <(compgen -W {} -- \"$current\")\n",
                             quoted(with_spaces(option.choices)));
      if (!option.files) cases += "      _greatx_no_files\n";
      cases += "      return ;;\n";
    }
  return cases;
}

std::string bash_words(const CommandTree& root) {
  std::string cases;
  for (const CommandTree* command : all_commands(root)) {
    Names options;
    for (const CommandArgument& option : command->options)
      options.insert(options.end(), option.names.begin(), option.names.end());
    Names words = command_names(*command);
    bool files = false;
    for (const CommandArgument& positional : command->positionals) {
      words.insert(words.end(), positional.choices.begin(), positional.choices.end());
      files = files || positional.files;
    }
    cases += fmt::format("    {}) options={} words={} files={} ;;\n", quoted(joined(command->path, ' ')),
                         quoted(with_spaces(options)), quoted(with_spaces(words)), files ? "yes" : "");
  }
  return cases;
}

constexpr const char* bash_script = R"(# Completion of greatx for bash, written by `greatx completion bash`.
_greatx_no_files() {{
  compopt +o default +o bashdefault 2>/dev/null || true
}}
_greatx() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  local at=greatx options= words= files= i more
  COMPREPLY=()
  # Bash makes "=" a word of its own, so that --seed=1 is three words.
  if [[ $current == "=" ]]; then
    current=
  elif [[ $previous == "=" ]] && ((COMP_CWORD > 1)); then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$at ${{COMP_WORDS[i]}}" in
      {})
        at+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case "$at $previous" in
{}  esac
  case $at in
{}  esac
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
    _greatx_no_files
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  if [[ -z $files ]]; then
    _greatx_no_files
  elif [[ -n $words ]]; then
    compopt -o filenames 2>/dev/null || true
    mapfile -t more < <(compgen -f -- "$current")
    COMPREPLY+=("${{more[@]}}")
  fi
}}
complete -o bashdefault -o default -F _greatx greatx
)";

// zsh: a function for each command, which describes its arguments to _arguments.

/// Returns ":TEXT:_files" and the like: the message and the action of an argument.
std::string zsh_action(const std::string& message, const CommandArgument& argument) {
  std::string action = " ";
  if (argument.files && !argument.choices.empty())
    action = "_greatx_scenarios";
  else if (argument.files)
    action = "_files";
  else if (!argument.choices.empty())
    action = "(" + with_spaces(argument.choices) + ")";
  return fmt::format(":{}:{}", escaped(message, ":\\"), action);
}

std::string zsh_option(const CommandArgument& option) {
  const bool value = option.takes_value();
  const std::string words = fmt::format("[{}]", escaped(brief(option.words), "[]\\:"));
  const std::string rest = words + (value ? zsh_action(option.type, option) : "");
  // Names of one option exclude each other, unless it may be given several times.
  const std::string excluded = option.repeats ? "*" : fmt::format("({})", with_spaces(option.names));
  std::string specs;
  for (const std::string& name : option.names) {
    const char* mark = !value ? "" : name.starts_with("--") ? "=" : "+";
    specs += fmt::format(" \\\n    {}", quoted(fmt::format("{}{}{}{}", excluded, name, mark, rest)));
  }
  return specs;
}

std::string zsh_function(const CommandTree& command) {
  std::string text = fmt::format("_{}() {{\n", joined(command.path, '_'));
  const bool nested = !command.commands.empty();
  if (nested) text += "  local curcontext=\"$curcontext\" state line\n  local -a commands\n";
  text += nested ? "  _arguments -C -S" : "  _arguments -S";
  for (const CommandArgument& option : command.options) text += zsh_option(option);
  for (const CommandArgument& positional : command.positionals)
    text += fmt::format(" \\\n    {}", quoted((positional.repeats ? "*" : ":") +
                                              zsh_action(positional.names[0], positional)));
  if (!nested) return text + "\n}\n";
  text +=
      " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n    command)\n      "
      "commands=(";
  for (const CommandTree& below : command.commands)
    text += fmt::format("\n        {}", quoted(below.name() + ":" + escaped(brief(below.words), ":\\")));
  text += ")\n      _describe command commands ;;\n    argument)\n      case $line[1] in\n";
  for (const CommandTree& below : command.commands)
    text += fmt::format("        {}) _{} ;;\n", below.name(), joined(below.path, '_'));
  return text + "      esac ;;\n  esac\n}\n";
}

Names scenarios_of(const CommandTree& root) {
  for (const CommandTree* command : all_commands(root))
    for (const CommandArgument& positional : command->positionals)
      if (positional.files && !positional.choices.empty()) return positional.choices;
  return {};
}

// fish: a line for each option and each command, with the command to which it belongs as its condition.

std::string fish_quoted(const std::string& text) { return "'" + escaped(text, "'\\") + "'"; }

std::string fish_lines(const CommandTree& command) {
  const std::string head = fmt::format("complete -c greatx -n '__greatx_at {}'", joined(command.path, ' '));
  std::string lines;
  for (const CommandTree& below : command.commands)
    lines += fmt::format("{} -a {} -d {}\n", head, below.name(), fish_quoted(brief(below.words)));
  for (const CommandArgument& option : command.options) {
    lines += head;
    for (const std::string& name : option.names)
      lines += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (option.takes_value()) lines += option.files ? " -r -F" : " -x";
    if (!option.choices.empty()) lines += " -a " + fish_quoted(with_spaces(option.choices));
    lines += " -d " + fish_quoted(brief(option.words)) + "\n";
  }
  for (const CommandArgument& positional : command.positionals) {
    if (positional.files) lines += head + " -F\n";
    if (!positional.choices.empty())
      lines += fmt::format("{} -a {}\n", head, fish_quoted(with_spaces(positional.choices)));
  }
  return lines;
}

constexpr const char* fish_script = R"(# Completion of greatx for fish, written by `greatx completion fish`.
function __greatx_at
    set -l words (commandline -opc)
    set -l at greatx
    for word in $words[2..-1]
        switch "$at $word"
            case {}
                set at "$at $word"
        end
    end
    test "$at" = "$argv"
end
complete -c greatx -f
)";

}  // namespace

std::string bash_completion(const CommandTree& root) {
  return fmt::format(bash_script, paths_below(root, " | "), bash_values(root), bash_words(root));
}

std::string zsh_completion(const CommandTree& root) {
  std::string script =
      "#compdef greatx\n# Completion of greatx for zsh, written by `greatx completion zsh`.\n";
  script += fmt::format(
      "_greatx_scenarios() {{\n  _alternative 'scenarios:scenario:({})' 'files:file:_files'\n}}\n",
      with_spaces(scenarios_of(root)));
  for (const CommandTree* command : all_commands(root)) script += zsh_function(*command);
  return script +
         "if [[ $funcstack[1] == _greatx ]]; then\n  _greatx \"$@\"\nelse\n  compdef _greatx greatx\nfi\n";
}

std::string fish_completion(const CommandTree& root) {
  std::string script = fmt::format(fish_script, paths_below(root, " "));
  for (const CommandTree* command : all_commands(root)) script += fish_lines(*command);
  return script;
}

}  // namespace greatx::apps
