// Layout of text for the width of a terminal.
#pragma once

#include <string>
#include <vector>

namespace lampyr {

// Columns of the terminal that file descriptor `fd` refers to; if it is not a terminal, the environment variable
// COLUMNS; if that is not set, `otherwise`. At least 20.
int TerminalColumns(int fd, int otherwise);

// Columns of UTF-8 text: one for each code point.
int ColumnsOf(const std::string& text);

// Lines of at most `columns` columns, broken at spaces; a word longer than that has a line of its own. At least one
// line.
std::vector<std::string> WrapText(const std::string& text, int columns);

// `first` followed by `text`, wrapped; further lines are indented by the width of `first`. Ends with a newline.
std::string Indented(const std::string& first, const std::string& text, int columns);

}  // namespace lampyr
