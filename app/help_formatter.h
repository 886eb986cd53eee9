// The text of --help, wrapped to the terminal. Only command_line.cpp includes it: CLI11's headers are heavy.
#pragma once

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <string>

#include "base/terminal.h"

namespace lampyr {

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool isPositional) const override {
    const std::string name = "  " + make_option_name(option, isPositional) + make_option_opts(option);
    return Row(name, make_option_desc(option));
  }

  // "-o, --output"; of a switch that is on by default, "--no-merge, --merge".
  std::string make_option_name(const CLI::Option* option, bool isPositional) const override {
    std::string names = CLI::Formatter::make_option_name(option, isPositional);
    for (size_t at; (at = names.find("{false}")) != std::string::npos;) names.erase(at, 7);
    for (size_t at = 0; (at = names.find(',', at)) != std::string::npos; at += 2) names.insert(at + 1, " ");
    return names;
  }

  // The kind of value without its range; a value out of range is reported when it is given.
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string kind = option->get_type_name();
    kind = kind.substr(0, kind.find(':'));
    if (option->get_type_size() == 0 || kind.empty()) return "";
    return " " + get_label(kind);
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return Row("  " + command->get_name(), command->get_description());
  }

 private:
  static std::string Row(const std::string& name, const std::string& text) {
    constexpr int kUsualColumns = 100, kTextColumn = 28, kNarrow = 70, kIndent = 6;
    const int columns = TerminalColumns(STDOUT_FILENO, kUsualColumns);
    const int column = columns < kNarrow ? kIndent : kTextColumn;
    const auto spaces = [](int count) { return std::string(static_cast<size_t>(std::max(count, 0)), ' '); };
    const int width = ColumnsOf(name);
    if (width + 2 > column) return name + "\n" + Indented(spaces(column), text, columns);
    return Indented(name + spaces(column - width), text, columns);
  }
};

}  // namespace lampyr
