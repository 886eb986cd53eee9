// Lights that read images and profiles of the test's own, and intensities and powers of points.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "film/image.h"
#include "light_fixture.h"
#include "sampling/warp.h"
#include "textures/texture_library.h"

namespace lampyr::test {

// A light that may read images; they lie in a folder of the test's own.
class PointLightTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("lampyr-") + ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name() +
               "-" + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // An image of `texel(x, y)`; returns the parameter that names it.
  std::string Write(int width, int height, const std::function<Color(int, int)>& texel) {
    Image image(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Color c = texel(x, y);
        image.At(x, y, 0) = c.r;
        image.At(x, y, 1) = c.g;
        image.At(x, y, 2) = c.b;
      }
    }
    const std::filesystem::path file = folder_ / (std::to_string(files_++) + ".exr");
    WriteExr(file, image, ExrPrecision::Float);
    return "\"string filename\" \"" + file.string() + "\" ";
  }

  // A text file of the test's folder; returns its full name, quoted.
  std::string WriteText(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return "\"" + (folder_ / name).string() + "\" ";
  }

  std::unique_ptr<BuiltLight> Make(const std::string& type, const std::string& parameters,
                                   const Transform& placement = Transform()) {
    auto built = std::make_unique<BuiltLight>();
    built->build.placement = placement;
    built->build.transform = {placement.ToAffine(), placement.Inverse().ToAffine()};
    built->build.textures = &textures_;
    built->build.diagnostics = &diagnostics_;
    built->light = MakeLight(*FindLightType(type, false), Parse(type, parameters, false), built->build);
    built->context.transform = &built->build.transform;
    built->context.scene = {Point3(0.0f), 10};
    built->context.bidirectional = true;
    return built;
  }

  std::filesystem::path folder_;
  int files_ = 0;
  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_{{}, Transform(), diagnostics_};
};

// Intensity in the direction of P: what arrives there times the squared distance. Black where nothing does.
inline Color IntensityTo(const BuiltLight& built, const Point3& P) {
  const auto sample = built.light->GenerateSamples(built.context, P);
  return sample ? sample->diffuse * Sqr(sample->distance) : Color(0.0f);
}

inline void ExpectColor(const Color& color, const Color& expected, float relative) {
  EXPECT_NEAR(color.r, expected.r, relative * (expected.r + 1e-6f));
  EXPECT_NEAR(color.g, expected.g, relative * (expected.g + 1e-6f));
  EXPECT_NEAR(color.b, expected.b, relative * (expected.b + 1e-6f));
}

// ∫ I dω by a lattice over the sphere, in which no structure of the lights can hide.
inline Color PowerByQuadrature(const BuiltLight& built, int points = 1 << 20) {
  const Point3 from = built.build.transform.toRender.translation;
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < points; ++i) {
    const double golden = 0.6180339887498949 * i;
    const Point2 u(static_cast<float>((i + 0.5) / points), static_cast<float>(golden - std::floor(golden)));
    const Color intensity = IntensityTo(built, from + SampleUniformSphere(u));
    sum[0] += static_cast<double>(intensity.r);
    sum[1] += static_cast<double>(intensity.g);
    sum[2] += static_cast<double>(intensity.b);
  }
  const double element = 4 * M_PI / points;
  return {static_cast<float>(sum[0] * element), static_cast<float>(sum[1] * element),
          static_cast<float>(sum[2] * element)};
}

}  // namespace lampyr::test
