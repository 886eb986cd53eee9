#include "base/setting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace lampyr {
namespace {

using testing::HasSubstr;

const Setting kPart{.name = "some-part", .help = "A part", .fallback = 0.05, .least = 0, .most = 1};
const Setting kCount{.name = "count", .help = "A count", .fallback = int64_t{-1}, .least = 1, .most = 16};
const Setting kSize{.name = "size", .help = "A size", .fallback = int64_t{4} << 30, .least = 1, .unit = "bytes"};
const Setting kWay{.name = "way", .help = "A way", .fallback = std::string("tree"), .choices = {"tree", "power"}};
const Setting kSwitch{.name = "switch", .help = "A switch", .fallback = true, .sceneName = "toggle"};

std::string ErrorOf(const Setting& setting, const std::string& text) {
  try {
    setting.Parse(text);
  } catch (const Error& error) {
    return error.Text();
  }
  return "";
}

TEST(Setting, ParsesItsType) {
  EXPECT_EQ(kPart.Parse("0.5"), SettingValue(0.5));
  EXPECT_EQ(kPart.Parse("1"), SettingValue(1.0));
  EXPECT_EQ(kCount.Parse("7"), SettingValue(int64_t{7}));
  EXPECT_EQ(kSize.Parse("512M"), SettingValue(int64_t{512} << 20));
  EXPECT_EQ(kWay.Parse("power"), SettingValue(std::string("power")));
  EXPECT_EQ(kSwitch.Parse("off"), SettingValue(false));
}

TEST(Setting, SaysWhatWouldBeRight) {
  EXPECT_EQ(ErrorOf(kPart, "1.5"), "\"1.5\" is too large: it must be from 0 to 1");
  EXPECT_EQ(ErrorOf(kPart, "-1"), "\"-1\" is too small: it must be from 0 to 1");
  for (const char* text : {"nan", "inf", "x", "", "0.5x", "1e999"})
    EXPECT_THAT(ErrorOf(kPart, text), HasSubstr("is not a number: it must be from 0 to 1")) << text;
  EXPECT_THAT(ErrorOf(kCount, "2.5"), HasSubstr("is not a whole number: it must be from 1 to 16"));
  EXPECT_THAT(ErrorOf(kCount, "1e300"), HasSubstr("too large"));
  EXPECT_THAT(ErrorOf(kSize, "many"), HasSubstr("is not a size; write 800M or 4G"));
  EXPECT_EQ(ErrorOf(kWay, "tee"), "\"tee\" is not one of: tree, power");
  EXPECT_THAT(ErrorOf(kSwitch, "maybe"), HasSubstr("neither on nor off"));
}

// A setting that a scene does not give has its fallback, in range or not.
TEST(Setting, ItsFallbackIsAlwaysAllowed) {
  EXPECT_EQ(kCount.Check(int64_t{-1}), kCount.fallback);
  EXPECT_THROW(kCount.Check(int64_t{0}), Error);
}

TEST(Setting, IsCalledInScenesAsPbrtCallsThings) {
  EXPECT_EQ(kPart.NameInScenes(), "somepart");
  EXPECT_EQ(kSwitch.NameInScenes(), "toggle");
}

// An identity tells any two values apart, and reads well.
TEST(Setting, IsWrittenExactly) {
  EXPECT_EQ(Setting::ToExactString(0.05), "0.05");
  EXPECT_NE(Setting::ToExactString(0.1 + 0.2), Setting::ToExactString(0.3));
  EXPECT_EQ(Setting::ToExactString(int64_t{4} << 30), "4294967296");
  EXPECT_EQ(Setting::ToExactString(true), "on");
  EXPECT_EQ(kSize.Format(kSize.fallback), "4.0 GiB");
}

TEST(Settings, HoldWhatIsDeclared) {
  Settings settings({&kPart, &kCount, &kPart, &kSwitch});
  EXPECT_EQ(settings.Names(), (std::vector<std::string>{"some-part", "count", "switch"}));
  EXPECT_EQ(settings.Number("some-part"), 0.05);
  settings.Set("some-part", int64_t{1});  // a whole number is a number
  EXPECT_EQ(settings.Number("some-part"), 1);
  EXPECT_THROW(settings.Set("some-part", 2.0), Error);
  EXPECT_THROW(settings.Set("count", 2.5), Error);
  settings.Set("switch", false);
  EXPECT_FALSE(settings.IsOn("switch"));
  try {
    settings.Set("cont", int64_t{1});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.Text(), HasSubstr("there is no setting \"cont\" (did you mean \"count\"?)"));
  }
}

}  // namespace
}  // namespace lampyr
