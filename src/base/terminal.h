// Layout of text for the width of a terminal.
#pragma once

#include <string>
#include <vector>

namespace lampyr {

// Columns of the terminal that file descriptor `fd` leads to; else those of the environment variable COLUMNS; else
// `otherwise`. At least 20.
int TerminalColumns(int fd, int otherwise);

// Columns that UTF-8 text takes: one for each code point.
int ColumnsOf(const std::string& text);

// Lines of at most `columns` columns, broken at spaces; a longer word has a line of its own. At least one line.
std::vector<std::string> WrapText(const std::string& text, int columns);

// `text` wrapped behind `first`; further lines are indented by as many columns as `first` has. Ends with a newline.
std::string Indented(const std::string& first, const std::string& text, int columns);

}  // namespace lampyr
