// Lights with images that a test writes itself.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "film/image.h"
#include "light_fixture.h"
#include "textures/texture_library.h"

namespace lampyr::test {

class SkyImageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("sky-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Texel i of the file holds values[i].
  void Write(const std::string& name, int width, int height, const std::function<float(int)>& value) {
    Image image(width, height, {"R", "G", "B"});
    for (int i = 0; i < 3 * width * height; ++i) image.data[static_cast<size_t>(i)] = value(i / 3);
    WriteExr(folder_ / name, image, ExrPrecision::Float);
  }

  std::unique_ptr<BuiltLight> Make(const std::string& type, const std::string& text,
                                   const Transform& placement = Transform()) {
    auto built = std::make_unique<BuiltLight>();
    const SceneDescription scene =
        ParseScene("WorldBegin\nLightSource \"" + type + "\" " + text + "\n", folder_ / "test.pbrt", diagnostics_);
    built->build.placement = placement;
    built->build.transform = {placement.ToAffine(), placement.Inverse().ToAffine()};
    built->build.textures = &textures_;
    built->build.diagnostics = &diagnostics_;
    built->light = MakeLight(*FindLightType(type, false), scene.lights.at(0).light.parameters, built->build);
    built->context.transform = &built->build.transform;
    built->context.scene = {Point3(0.0f), 10};
    built->context.bidirectional = true;
    return built;
  }

  std::string ErrorOf(const std::string& type, const std::string& text) {
    try {
      Make(type, text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_{{}, Transform(), diagnostics_};
};

}  // namespace lampyr::test
