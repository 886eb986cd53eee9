#include "base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/progress.h"

namespace lampyr {
namespace {

FileLocation At(int line, int column) {
  return {std::make_shared<const std::string>("a.pbrt"), line, column};
}

TEST(Error, NamesThePlace) {
  EXPECT_STREQ(Error(At(3, 7), "no such shape").what(), "a.pbrt:3:7: error: no such shape");
  EXPECT_STREQ(Error("no file").what(), "error: no file");
  EXPECT_EQ(Error(At(3, 7), "x").Text(), "x");
}

TEST(Diagnostics, ReportsEachWarningOnce) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  diagnostics.Warn(At(1, 2), "first");
  diagnostics.Warn(At(1, 2), "first");
  diagnostics.Warn(At(2, 2), "first");
  EXPECT_EQ(diagnostics.Warnings(),
            (std::vector<std::string>{"a.pbrt:1:2: warning: first", "a.pbrt:2:2: warning: first"}));
}

// Texts that differ in numbers and quoted names are of one kind: three are printed, the rest is counted.
TEST(Diagnostics, PrintsFewOfAKindAndCountsTheRest) {
  testing::internal::CaptureStderr();
  {
    Diagnostics diagnostics;
    for (int line = 1; line <= 40; ++line) diagnostics.Warn(At(line, 1), "TransformBegin is deprecated");
    for (int i = 0; i < 5; ++i)
      diagnostics.Warn(At(50, i), "there is no \"" + std::to_string(i) + "\" of " + std::to_string(i));
    diagnostics.Warn(At(50, 0), "there is no \"0\" of 0");  // said already
    diagnostics.Warn("another");
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "a.pbrt:1:1: warning: TransformBegin is deprecated\n"
            "a.pbrt:50:0: warning: there is no \"0\" of 0\n"
            "a.pbrt:50:1: warning: there is no \"1\" of 1\n"
            "a.pbrt:50:2: warning: there is no \"2\" of 2\n"
            "warning: another\n"
            "warning: 39 more like this: TransformBegin is deprecated\n"
            "warning: 2 more like this: there is no \"0\" of 0\n");
}

TEST(Diagnostics, StrictThrows) {
  Diagnostics diagnostics(Diagnostics::Mode::Strict);
  EXPECT_THROW(diagnostics.Warn(At(1, 2), "odd"), Error);
}

TEST(NearestName, FindsTyposOnly) {
  const std::vector<std::string> known = {"trianglemesh", "plymesh", "sphere", "disk"};
  EXPECT_EQ(NearestName("spehre", known), "sphere");  // a transposition is one mistake
  EXPECT_EQ(NearestName("Sphere", known), "sphere");
  EXPECT_EQ(NearestName("trianglmesh", known), "trianglemesh");
  EXPECT_EQ(NearestName("dsik", known), "disk");
  EXPECT_EQ(NearestName("teapot", known), "");
  const std::string endless(1 << 20, 'a');  // the distance would take hours
  EXPECT_EQ(NearestName(endless, {endless + "b"}), "");
  EXPECT_EQ(DidYouMean("plymehs", known), " (did you mean \"plymesh\"?)");
  EXPECT_EQ(DidYouMean("nurbs", known), "");
  // Names of pbrt-v3, where the one of today is known.
  EXPECT_EQ(DidYouMean("matte", {"conductor", "diffuse"}), " (did you mean \"diffuse\"?)");
  EXPECT_EQ(DidYouMean("matte", {"conductor"}), "");
}

TEST(ParallelFor, CallsEachItemOnceAndPassesOnExceptions) {
  for (const int threads : {1, 2, 4}) {
    std::vector<int> calls(1000, 0);
    ParallelFor(1000, threads, [&](int i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
    EXPECT_THROW(ParallelFor(100, threads,
                             [](int i) {
                               if (i == 57) throw Error("stop");
                             }),
                 Error);
  }
  ParallelFor(0, 2, [](int) { FAIL(); });
}

TEST(FormatPercent, HasTwoDigitsAndNoExponent) {
  EXPECT_EQ(FormatPercent(0), "0 %");
  EXPECT_EQ(FormatPercent(0.00123), "0.12 %");
  EXPECT_EQ(FormatPercent(0.05), "5 %");
  EXPECT_EQ(FormatPercent(0.0996), "10 %");
  EXPECT_EQ(FormatPercent(0.875), "88 %");
  EXPECT_EQ(FormatPercent(1.9), "190 %");
  EXPECT_EQ(FormatPercent(1234.5), "120000 %");
  EXPECT_EQ(FormatPercent(-0.034), "-3.4 %");
  EXPECT_EQ(FormatPercent(1e-9), "0.0000001 %");
  EXPECT_EQ(FormatPercent(std::numeric_limits<double>::infinity()), "unknown");
  EXPECT_EQ(FormatPercent(std::nan("")), "unknown");
}

TEST(FormatDuration, ChoosesUnits) {
  EXPECT_EQ(FormatDuration(0.0374), "37 ms");
  EXPECT_EQ(FormatDuration(0.0996), "0.1 s");
  EXPECT_EQ(FormatDuration(4.23), "4.2 s");
  EXPECT_EQ(FormatDuration(200), "3 min 20 s");
  EXPECT_EQ(FormatDuration(3720), "1 h 02 min");
  EXPECT_EQ(FormatDuration(std::numeric_limits<double>::infinity()), "?");
}

}  // namespace
}  // namespace lampyr
