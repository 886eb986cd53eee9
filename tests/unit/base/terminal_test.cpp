// Text for narrow terminals: wrapping, indentation, and the line of progress.
#include "base/terminal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/progress.h"

namespace lampyr {
namespace {

using testing::ElementsAre;

TEST(Terminal, WrapsAtSpaces) {
  EXPECT_THAT(WrapText("", 10), ElementsAre(""));
  EXPECT_THAT(WrapText("one two three", 7), ElementsAre("one two", "three"));
  EXPECT_THAT(WrapText("one two three", 6), ElementsAre("one", "two", "three"));
  EXPECT_THAT(WrapText("a longerthanallcolumns b", 5), ElementsAre("a", "longerthanallcolumns", "b"));
  EXPECT_THAT(WrapText("5 °  6 °", 3), ElementsAre("5 °", "6 °"));
}

TEST(Terminal, IndentsWhatIsWrapped) {
  EXPECT_EQ(Indented("key ", "one two three four", 17), "key one two three\n    four\n");
  EXPECT_EQ(Indented("° ", "a", 80), "° a\n");
}

TEST(Terminal, ColumnsOfTheEnvironmentAreTaken) {
  setenv("COLUMNS", "57", 1);
  EXPECT_EQ(TerminalColumns(-1, 100), 57);
  setenv("COLUMNS", "3", 1);
  EXPECT_EQ(TerminalColumns(-1, 100), 20);
  unsetenv("COLUMNS");
  EXPECT_EQ(TerminalColumns(-1, 100), 100);
}

// The bar gives way first, then the end of the note; the percentage and the time left are always there.
TEST(Progress, LineFitsTheColumns) {
  const std::string note = "1048576 spp, error 0.12 %";
  EXPECT_EQ(ProgressLine(0.5, "3 min 20 s", note, 100),
            "[###############...............]  50 %, 3 min 20 s left, " + note);
  for (int columns = 20; columns < 120; ++columns) {
    const std::string line = ProgressLine(0.5, "3 min 20 s", note, columns);
    EXPECT_LT(ColumnsOf(line), columns) << line;
    EXPECT_NE(line.find("50 %"), std::string::npos) << line;
    if (columns >= 40) {
      EXPECT_NE(line.find("3 min 20 s left"), std::string::npos) << line;
    }
  }
  EXPECT_NE(ProgressLine(0.5, "20 s", "64 spp, error 2.1 %", 40).find("64 spp, error 2.1 %"), std::string::npos);
}

}  // namespace
}  // namespace lampyr
