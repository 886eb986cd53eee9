// Measured materials: files whose content is known against the model that they tabulate, the warps of the square, the
// symmetries of the azimuth, and damaged files.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "materials/bsdf.h"
#include "materials/measured_file.h"
#include "sampling/rng.h"
#include "support/measured_writer.h"
#include "support/temporary_folder.h"

namespace lampyr::testing {
namespace {

using test::MeasuredField;
using test::MeasuredFieldsOf;
using test::MeasuredMetal;
using test::TensorFile;

class Measured : public ::testing::Test {
 protected:
  MeasuredData Read(const std::string& bytes) {
    const std::filesystem::path file = folder_.Path() / "metal.bsdf";
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return ReadMeasured(file, FileLocation{std::make_shared<const std::string>("scene.pbrt"), 3, 7});
  }
  std::string MessageOf(const std::string& bytes) {
    try {
      Read(bytes);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

// Mean of |measured - model| over that of the model, over pairs of directions, and the largest deviation of the
// densities from what sampling visible normals has.
struct Deviation {
  double value = 0, density = 0;
};
Deviation DeviationOf(const MeasuredData& data, const MeasuredMetal& metal, TransportMode mode) {
  const MeasuredBsdf measured{&data};
  const ConductorBsdf model{metal.microfacets, Color(1.0f), Color(1e3f)};  // reflects all at a microfacet
  Rng rng(5);
  double difference = 0, sum = 0, densityDifference = 0, densitySum = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto towards = [&] {
      // cosθ from 0.15: beyond, linear interpolation between angles of incidence is coarse.
      const float z = 0.15f + 0.85f * rng.NextFloat();
      const double phi = 6.283185307179586 * static_cast<double>(rng.NextFloat());
      const double sine = std::sqrt(1 - static_cast<double>(z) * static_cast<double>(z));
      return Vector3(Vector3d(sine * std::cos(phi), sine * std::sin(phi), static_cast<double>(z)));
    };
    const Vector3 wo = towards(), wi = towards();
    const BsdfEvaluation a = measured.Evaluate(wo, wi, mode), b = model.Evaluate(wo, wi, mode);
    const Color expected = b.specular * metal.reflectance;
    const Color error = a.specular - expected;
    difference += static_cast<double>(std::abs(error.r) + std::abs(error.g) + std::abs(error.b));
    sum += static_cast<double>(expected.r + expected.g + expected.b);
    densityDifference += std::abs(static_cast<double>(a.pdfForward.value - b.pdfForward.value));
    densitySum += static_cast<double>(b.pdfForward.value);
  }
  return {difference / sum, densityDifference / densitySum};
}

MeasuredMetal Brushed(int symmetry, double firstPhi) {
  MeasuredMetal metal;
  metal.microfacets = TrowbridgeReitz(0.25f, 0.6f);
  metal.symmetry = symmetry;
  metal.phiCount = 1 + 24 / symmetry;
  metal.firstPhi = firstPhi;
  return metal;
}

TEST_F(Measured, IsTheMaterialThatWasMeasured) {
  const MeasuredMetal metal;
  const MeasuredData data = Read(TensorFile(MeasuredFieldsOf(metal)));
  EXPECT_FALSE(data.IsAnisotropic());
  for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
    const Deviation deviation = DeviationOf(data, metal, mode);
    EXPECT_LT(deviation.value, 0.02);
    EXPECT_LT(deviation.density, 0.02);
  }
}

TEST_F(Measured, AzimuthsOfAnisotropicOnesAreCompletedBySymmetry) {
  constexpr double kPiExact = 3.14159265358979323846;
  const struct {
    int symmetry;
    double firstPhi;
  } parts[] = {{1, -kPiExact}, {2, -kPiExact}, {2, 0}, {4, -kPiExact}, {4, 0}};
  for (const auto& part : parts) {
    const MeasuredMetal metal = Brushed(part.symmetry, part.firstPhi);
    const MeasuredData data = Read(TensorFile(MeasuredFieldsOf(metal)));
    EXPECT_TRUE(data.IsAnisotropic());
    EXPECT_EQ(data.symmetry, part.symmetry);
    const Deviation deviation = DeviationOf(data, metal, TransportMode::Radiance);
    EXPECT_LT(deviation.value, 0.04) << part.symmetry << " from " << part.firstPhi;
    EXPECT_LT(deviation.density, 0.04) << part.symmetry << " from " << part.firstPhi;
  }
}

// A turn may leave out the azimuth at one of its ends, which is that at the other.
TEST_F(Measured, TurnsAreClosed) {
  constexpr double kPiExact = 3.14159265358979323846;
  MeasuredMetal metal = Brushed(1, -kPiExact);
  metal.microfacets = TrowbridgeReitz(0.3f, 0.5f);
  metal.phiCount = 9;
  const std::vector<MeasuredField> all = MeasuredFieldsOf(metal);
  const MeasuredData whole = Read(TensorFile(all));
  for (const bool isFirstLeftOut : {false, true}) {
    std::vector<MeasuredField> fields = all;
    for (MeasuredField& field : fields) {
      if (field.name != "phi_i" && field.shape.size() < 4) continue;
      const auto each = static_cast<std::ptrdiff_t>(field.values.size() / field.shape[0]);
      const auto from = isFirstLeftOut ? field.values.begin() : field.values.end() - each;
      field.values.erase(from, from + each);
      --field.shape[0];
    }
    const MeasuredData data = Read(TensorFile(fields));
    EXPECT_EQ(data.symmetry, 1);
    ASSERT_EQ(data.phi.size(), whole.phi.size());
    // Azimuths of the step that was left out, and all others.
    for (int i = 0; i < 64; ++i) {
      const double phi = 2 * kPiExact * (i + 0.5) / 64 - kPiExact;
      const Vector3 wo(Vector3d(0.6 * std::cos(phi), 0.6 * std::sin(phi), 0.8)), wi(0.1f, 0.2f, std::sqrt(0.95f));
      const BsdfEvaluation a = MeasuredBsdf{&data}.Evaluate(wo, wi, TransportMode::Radiance),
                           b = MeasuredBsdf{&whole}.Evaluate(wo, wi, TransportMode::Radiance);
      EXPECT_NEAR(a.specular.g, b.specular.g, 1e-3f * b.specular.g) << phi;
      EXPECT_NEAR(a.pdfForward.value, b.pdfForward.value, 1e-3f * b.pdfForward.value) << phi;
    }
  }
}

// Mirroring cannot complete parts of a turn that lie askew.
TEST_F(Measured, AzimuthsAskewAreErrors) {
  constexpr double kPiExact = 3.14159265358979323846;
  const auto messageOf = [&](int symmetry, double first, size_t count) {
    MeasuredMetal metal = Brushed(symmetry, first);
    metal.thetaCount = 3;
    metal.side = 4;
    std::vector<MeasuredField> fields = MeasuredFieldsOf(metal);
    for (MeasuredField& field : fields) {
      if (field.name != "phi_i" && field.shape.size() < 4) continue;
      field.values.resize(field.values.size() / field.shape[0] * count);
      field.shape[0] = count;
    }
    return MessageOf(TensorFile(fields));
  };
  EXPECT_EQ(messageOf(2, 0, 13), "");
  for (const std::string& message : {messageOf(2, -0.5 * kPiExact, 13), messageOf(4, -0.25 * kPiExact, 7),
                                     messageOf(1, -kPiExact, 19), messageOf(2, 0, 11)})
    EXPECT_NE(message.find("its azimuths run from"), std::string::npos) << message;
}

TEST_F(Measured, SpectraBecomeColours) {
  MeasuredMetal metal;
  metal.asSpectra = true;
  metal.reflectance = Color(0.6f);
  const MeasuredData data = Read(TensorFile(MeasuredFieldsOf(metal)));
  EXPECT_LT(DeviationOf(data, metal, TransportMode::Radiance).value, 0.02);
}

TEST_F(Measured, WavelengthsAreVisibleNanometres) {
  MeasuredMetal metal;
  metal.asSpectra = true;
  metal.thetaCount = 3;
  metal.side = 4;
  const auto messageWith = [&](float scale) {
    std::vector<MeasuredField> fields = MeasuredFieldsOf(metal);
    for (float& wavelength : fields.back().values) wavelength *= scale;
    return MessageOf(TensorFile(fields));
  };
  EXPECT_EQ(messageWith(1), "");
  EXPECT_NE(messageWith(1e-3f).find("Are these micrometres?"), std::string::npos);
  EXPECT_NE(messageWith(0.3f).find("none that is visible"), std::string::npos);
  EXPECT_NE(messageWith(3).find("none that is visible"), std::string::npos);
}

// The density of a warp is one, sampling follows it, and Invert undoes Sample; also between tables.
TEST_F(Measured, WarpsAreInverted) {
  constexpr size_t kWidth = 7, kHeight = 5, kTables = 4;
  Rng rng(3);
  std::vector<float> values;
  for (size_t i = 0; i < kWidth * kHeight * kTables; ++i)
    values.push_back(rng.NextFloat() < 0.3f ? 0.0f : 1e3f * rng.NextFloat());
  const MeasuredWarp warp(values, kWidth, kHeight);
  TableBlend blend;
  blend.count = 4;
  blend.table = {0, 1, 2, 3};
  blend.weight = {0.1f, 0.2f, 0.3f, 0.4f};
  constexpr int kGrid = 240;
  double sum = 0;
  for (int i = 0; i < kGrid * kGrid; ++i)
    sum += warp.Density(blend, {(i % kGrid + 0.5) / kGrid, (std::floor(i / kGrid) + 0.5) / kGrid});
  EXPECT_NEAR(sum / (kGrid * kGrid), 1, 1e-3);
  constexpr int kBins = 6;
  std::vector<double> counts(kBins * kBins), expected(kBins * kBins);
  constexpr int kSamples = 400000;
  for (int i = 0; i < kSamples; ++i) {
    const Point2d u(rng.NextFloat(), rng.NextFloat());
    const Point2d sample = warp.Sample(blend, u);
    const double density = warp.Density(blend, sample);
    const Point2d back = warp.Invert(blend, sample);
    if (density > 1e-2) {
      EXPECT_NEAR(back.x, u.x, 1e-6);
      EXPECT_NEAR(back.y, u.y, 1e-6);
    }
    const auto binOf = [](double x) { return std::min(static_cast<int>(x * kBins), kBins - 1); };
    ++counts[static_cast<size_t>(binOf(sample.y) * kBins + binOf(sample.x))];
  }
  double chiSquared = 0;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const int x = i % kGrid, y = i / kGrid, perBin = kGrid / kBins;
    expected[static_cast<size_t>(y / perBin * kBins + x / perBin)] +=
        kSamples * warp.Density(blend, {(x + 0.5) / kGrid, (y + 0.5) / kGrid}) / (kGrid * kGrid);
  }
  for (size_t i = 0; i < counts.size(); ++i)
    chiSquared += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  EXPECT_LT(chiSquared, 75);  // 35 degrees of freedom, p = 1e-4
}

TEST_F(Measured, DamagedFilesAreErrors) {
  MeasuredMetal small;
  small.thetaCount = 3;
  small.side = 4;
  const std::vector<MeasuredField> fields = MeasuredFieldsOf(small);
  const std::string whole = TensorFile(fields);
  EXPECT_EQ(MessageOf(whole), "");
  for (const size_t length : {size_t{0}, size_t{5}, size_t{14}, size_t{17}, size_t{20}, size_t{31}, size_t{60},
                              size_t{200}, whole.size() / 2, whole.size() - 1}) {
    const std::string message = MessageOf(whole.substr(0, length));
    EXPECT_EQ(message.rfind("scene.pbrt:3:7: error: ", 0), 0u) << length << ": " << message;
    EXPECT_NE(message.find("cannot be used as a measured material"), std::string::npos) << message;
  }
  for (size_t i = 0; i < fields.size(); ++i) {
    std::vector<MeasuredField> damaged = fields;
    damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(MessageOf(TensorFile(damaged)).find("\"" + fields[i].name + "\""), std::string::npos) << fields[i].name;
    for (const float wrong : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      damaged = fields;
      damaged[i].values[damaged[i].values.size() - 1] = wrong;
      const bool isAzimuth = fields[i].name == "phi_i" && wrong == -1.0f;
      EXPECT_EQ(MessageOf(TensorFile(damaged)).empty(), isAzimuth) << fields[i].name << " " << wrong;
    }
    damaged = fields;
    damaged[i].shape[0] = ~uint64_t{0};
    EXPECT_NE(MessageOf(TensorFile(damaged)), "") << fields[i].name;
  }
  std::vector<MeasuredField> named = fields;
  named[2].name = std::string("n\033[31md\0f", 9);
  named[2].shape[0] = ~uint64_t{0};
  EXPECT_NE(MessageOf(TensorFile(named)).find("its field \"n?[31md?f\" is larger"), std::string::npos);
  std::vector<MeasuredField> empty = fields;
  empty[0].shape[0] = 0;
  EXPECT_NE(MessageOf(TensorFile(empty)).find("\"theta_i\" holds no 32-bit numbers"), std::string::npos);
  std::vector<MeasuredField> fewer = fields;
  fewer[0].shape[0] = 2;
  EXPECT_NE(MessageOf(TensorFile(fewer)).find("does not fit"), std::string::npos);
  std::vector<MeasuredField> dark = fields;
  for (float& value : dark[4].values) value = 0;
  EXPECT_NE(MessageOf(TensorFile(dark)).find("0 everywhere"), std::string::npos);
}

}  // namespace
}  // namespace lampyr::testing
