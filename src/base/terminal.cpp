#include "base/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace lampyr {

namespace {

constexpr int kFewestColumns = 20;

}  // namespace

int TerminalColumns(int fd, int otherwise) {
  winsize size{};
  int columns = otherwise;
  if (isatty(fd) != 0 && ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    columns = size.ws_col;
  } else if (const char* given = std::getenv("COLUMNS"); given && std::atoi(given) > 0) {
    columns = std::atoi(given);
  }
  return std::max(columns, kFewestColumns);
}

int ColumnsOf(const std::string& text) {
  // Counts all bytes except UTF-8 continuation bytes.
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::vector<std::string> WrapText(const std::string& text, int columns) {
  std::vector<std::string> lines(1);
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    std::string& line = lines.back();
    if (line.empty()) {
      line = word;
    } else if (ColumnsOf(line) + 1 + ColumnsOf(word) <= columns) {
      line += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

std::string Indented(const std::string& first, const std::string& text, int columns) {
  constexpr int kFewestForText = 12;
  const int indent = ColumnsOf(first);
  std::string result = first;
  bool isFirst = true;
  for (const std::string& line : WrapText(text, std::max(columns - indent, kFewestForText))) {
    if (!isFirst) result += std::string(static_cast<size_t>(indent), ' ');
    isFirst = false;
    result += line + "\n";
  }
  return result;
}

}  // namespace lampyr
