// Copies of a scene's text with changed parameters: all else stays as it is.
#include "scene/scene_copy.h"

#include <gtest/gtest.h>

#include "scene/scene_description.h"
#include "support/temporary_folder.h"

namespace lampyr {
namespace {

Parameter Numbers(const std::string& name, ParameterType type, std::vector<double> numbers) {
  Parameter parameter;
  parameter.name = name;
  parameter.type = type;
  parameter.numbers = std::move(numbers);
  return parameter;
}

class SceneCopy : public testing::Test {
 protected:
  StatementChange Change(const std::string& file, int line, int column, std::vector<Parameter> parameters) {
    return {{std::make_shared<const std::string>((folder_ / file).string()), line, column}, std::move(parameters)};
  }
  TemporaryFolder folder_;
};

TEST_F(SceneCopy, ReplacesAndAddsParameters) {
  WriteBytes(
      folder_ / "a.pbrt",
      "WorldBegin # \"float scale\" 1\r\n"
      "LightSource \"point\" \"float  scale\" [ 2 ] # scale\r\n  \"string name\" \"a \\\"b\\\" c\" \"rgb I\" [1 2\n3]\n"
      "LightSource \"point\"\nTranslate 1 2 3");
  const auto copies = CopyScene(
      folder_ / "a.pbrt",
      {Change("a.pbrt", 2, 1,
              {Numbers("scale", ParameterType::Float, {0.1}), Numbers("I", ParameterType::Rgb, {1, 0.5, 1e-7})}),
       Change("a.pbrt", 5, 1, {Numbers("intensity", ParameterType::Float, {3})})},
      ".new");
  ASSERT_EQ(copies.size(), 1u);
  EXPECT_EQ(copies[0].path, folder_ / "a.new.pbrt");
  EXPECT_EQ(
      copies[0].text,
      "WorldBegin # \"float scale\" 1\r\n"
      "LightSource \"point\" \"float scale\" 0.1 # scale\r\n  \"string name\" \"a \\\"b\\\" c\" \"rgb I\" [ 1 0.5 "
      "1e-07 ]\n"
      "LightSource \"point\" \"float intensity\" 3\nTranslate 1 2 3");
}

TEST_F(SceneCopy, AFileOfTwoNamesHasOneCopy) {
  WriteBytes(folder_ / "lights.pbrt", "LightSource \"point\"\n");
  std::filesystem::create_symlink(folder_ / "lights.pbrt", folder_ / "same.pbrt");
  WriteBytes(folder_ / "a.pbrt", "WorldBegin Include \"lights.pbrt\" Include \"same.pbrt\"\n");
  const auto copies = CopyScene(folder_ / "a.pbrt",
                                {Change("lights.pbrt", 1, 1, {Numbers("scale", ParameterType::Float, {2})})}, ".new");
  ASSERT_EQ(copies.size(), 2u);
  for (const CopiedFile& copy : copies) WriteBytes(copy.path, copy.text);
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  EXPECT_EQ(ReadScene(folder_ / "a.new.pbrt", diagnostics).lights.size(), 2u);
}

TEST_F(SceneCopy, CopiesIncludedFilesWithChangesAlone) {
  std::filesystem::create_directories(folder_ / "parts");
  WriteBytes(folder_ / "a.pbrt", "WorldBegin\nInclude \"parts/one.pbrt\"\nInclude \"parts/two.pbrt\"\n");
  WriteBytes(folder_ / "parts/one.pbrt", "Import \"three.pbrt\"\n");
  WriteBytes(folder_ / "parts/two.pbrt", "Shape \"sphere\"\n");
  WriteBytes(folder_ / "parts/three.pbrt", "\n  LightSource \"point\"\n");
  const auto copies = CopyScene(
      folder_ / "a.pbrt", {Change("parts/three.pbrt", 2, 3, {Numbers("scale", ParameterType::Float, {2})})}, ".x");
  ASSERT_EQ(copies.size(), 3u);
  EXPECT_EQ(copies[0].path, folder_ / "parts/three.x.pbrt");
  EXPECT_EQ(copies[0].text, "\n  LightSource \"point\" \"float scale\" 2\n");
  EXPECT_EQ(copies[1].text, "Import \"three.x.pbrt\"\n");
  EXPECT_EQ(copies[2].text, "WorldBegin\nInclude \"parts/one.x.pbrt\"\nInclude \"parts/two.pbrt\"\n");
}

TEST_F(SceneCopy, TellsThatTheFileHasChanged) {
  WriteBytes(folder_ / "a.pbrt", "WorldBegin\nShape \"sphere\"\n");
  const auto change = Change("a.pbrt", 3, 1, {Numbers("scale", ParameterType::Float, {2})});
  EXPECT_THROW(CopyScene(folder_ / "a.pbrt", {change}, ".x"), Error);
}

TEST_F(SceneCopy, NamesAreThoseOfTheScene) {
  EXPECT_EQ(PathOfCopy("b/a.pbrt", ".desk"), "b/a.desk.pbrt");
  EXPECT_EQ(PathOfCopy("a.pbrt.gz", ".desk-2"), "a.desk-2.pbrt");
  EXPECT_EQ(PathOfCopy("a", ".desk"), "a.desk.pbrt");
}

}  // namespace
}  // namespace lampyr
