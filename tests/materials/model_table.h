// The BSDFs that the tests of this folder go through, and the directions they are looked at from.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "materials/bsdf.h"
#include "materials/measured_file.h"
#include "sampling/rng.h"
#include "support/measured_writer.h"

namespace lampyr::testing {

struct TestModel {
  std::string name;
  BsdfModel model;
  float tolerance = 1e-3f;  // relative, of densities recomputed from a rounded direction
  bool lossless = false;    // nothing absorbs (single scattering at microfacets may still lose)
  // a fibre: not symmetric, and without a surface for a comparison of the flux
  bool isHair = false;
  bool isReciprocal = true;  // false: tabulated, and equal in both directions up to the tables' resolution
};

// Hair on a surface, h as given. A fibre's h is what the arriving path sees (tests/materials/hair_test.cpp).
inline TestModel Hair(const std::string& name, const Color& sigmaA, float eta, float betaM, float betaN, float alpha,
                      float h, float tolerance = 2e-3f) {
  HairBsdf hair(sigmaA, eta, betaM, betaN, alpha);
  hair.offset = h;
  return {name, hair, tolerance, sigmaA.IsBlack(), true};
}

// Tables that models point into.
struct ModelTables {
  std::vector<std::shared_ptr<const CoatTable>> coats;
  std::vector<std::shared_ptr<const CoatedMetalTable>> metals;
  std::vector<std::shared_ptr<const CoatedConductorSettings>> settings;
  std::vector<std::shared_ptr<const MeasuredData>> measured;
};

inline MeasuredBsdf MakeMeasuredBsdf(ModelTables& tables, float alphaX, float alphaY) {
  test::MeasuredMetal metal;
  metal.microfacets = TrowbridgeReitz(alphaX, alphaY);
  metal.phiCount = alphaX == alphaY ? 1 : 17;
  metal.side = 24;
  const std::string bytes = test::TensorFile(test::MeasuredFieldsOf(metal));
  tables.measured.push_back(std::make_shared<MeasuredData>(ParseMeasured(std::as_bytes(std::span(bytes)))));
  return {tables.measured.back().get()};
}

inline CoatedDiffuseBsdf MakeCoated(ModelTables& tables, TrowbridgeReitz coat, float eta, const Color& reflectance,
                                    float thickness = 0.01f, int bounces = 5) {
  tables.coats.push_back(
      std::make_shared<CoatTable>(CoatDescription{eta, thickness, {std::sqrt(coat.alphaX * coat.alphaY)}}));
  return {coat, eta, reflectance, bounces, *tables.coats.back()};
}

inline CoatedConductorBsdf MakeCoatedMetal(ModelTables& tables, TrowbridgeReitz coat, TrowbridgeReitz base, float eta,
                                           const Color& metalEta, const Color& metalK, float thickness = 0.01f,
                                           int bounces = 5) {
  const CoatDescription description{eta, thickness, {std::sqrt(coat.alphaX * coat.alphaY)}};
  tables.coats.push_back(std::make_shared<CoatTable>(description));
  tables.metals.push_back(
      std::make_shared<CoatedMetalTable>(description, std::vector<float>{std::sqrt(base.alphaX * base.alphaY)}));
  tables.settings.push_back(std::make_shared<CoatedConductorSettings>(
      CoatedConductorSettings{eta, thickness, bounces, tables.coats.back().get(), tables.metals.back().get()}));
  return {coat, base, metalEta / eta, metalK / eta, *tables.settings.back()};
}

inline std::vector<TestModel> AllModels(ModelTables& tables) {
  const Color copperEta(0.21f, 0.83f, 1.24f), copperK(3.8f, 2.6f, 2.3f), mirrorK(1e3f);
  const auto ggx = [](float x, float y) { return TrowbridgeReitz(x, y); };
  return {
      {"diffuse", DiffuseBsdf{Color(0.8f, 0.5f, 0.1f)}},
      {"diffuse white", DiffuseBsdf{Color(1.0f)}, 1e-3f, true},
      {"diffuse transmission", DiffuseTransmissionBsdf{Color(0.2f, 0.3f, 0.4f), Color(0.6f, 0.1f, 0.2f)}},
      {"diffuse transmission only", DiffuseTransmissionBsdf{Color(0.0f), Color(1.0f)}, 1e-3f, true},
      {"conductor smooth", ConductorBsdf{ggx(0, 0), copperEta, copperK}},
      {"conductor 0.0011", ConductorBsdf{ggx(0.0011f, 0.0011f), copperEta, copperK}, 2e-2f},
      {"conductor 0.05", ConductorBsdf{ggx(0.05f, 0.05f), copperEta, copperK}},
      {"conductor 0.3", ConductorBsdf{ggx(0.3f, 0.3f), copperEta, copperK}},
      {"conductor 1", ConductorBsdf{ggx(1, 1), copperEta, copperK}},
      {"conductor 0.05 x 0.5", ConductorBsdf{ggx(0.05f, 0.5f), copperEta, copperK}},
      {"conductor lossless 0.4", ConductorBsdf{ggx(0.4f, 0.4f), Color(1.0f), mirrorK}, 1e-3f, true},
      {"glass smooth", DielectricBsdf{ggx(0, 0), 1.5f}, 1e-3f, true},
      {"glass eta 1", DielectricBsdf{ggx(0.3f, 0.3f), 1}, 1e-3f, true},
      {"glass 0.01", DielectricBsdf{ggx(0.01f, 0.01f), 1.5f}, 1e-2f, true},
      {"glass 0.1", DielectricBsdf{ggx(0.1f, 0.1f), 1.5f}, 2e-3f, true},
      {"glass 0.5", DielectricBsdf{ggx(0.5f, 0.5f), 1.5f}, 1e-3f, true},
      {"glass 0.1 x 0.4", DielectricBsdf{ggx(0.1f, 0.4f), 1.5f}, 2e-3f, true},
      {"glass eta 1.05", DielectricBsdf{ggx(0.3f, 0.3f), 1.05f}, 5e-3f, true},
      {"diamond 0.2", DielectricBsdf{ggx(0.2f, 0.2f), 2.4f}, 1e-3f, true},
      {"bubble 0.2", DielectricBsdf{ggx(0.2f, 0.2f), 0.75f}, 2e-3f, true},
      {"glass dispersive smooth", DispersiveBsdf{ggx(0, 0), Color(1.4f, 1.5f, 1.8f), 1}},
      {"glass dispersive 0.1", DispersiveBsdf{ggx(0.1f, 0.1f), Color(1.4f, 1.5f, 1.8f), 2}, 1e-2f, true},
      {"glass dispersive 0.5", DispersiveBsdf{ggx(0.5f, 0.5f), Color(0.8f, 1.5f, 1.8f)}, 2e-3f, true},
      {"thin glass", ThinDielectricBsdf{1.5f}, 1e-3f, true},
      {"coated diffuse smooth", MakeCoated(tables, ggx(0, 0), 1.5f, Color(0.4f, 0.2f, 0.2f))},
      {"coated diffuse 0.158", MakeCoated(tables, ggx(0.158f, 0.158f), 1.5f, Color(0.4f, 0.2f, 0.2f))},
      {"coated diffuse 0.387", MakeCoated(tables, ggx(0.387f, 0.387f), 1.5f, Color(0.4f, 0.5f, 0.4f))},
      {"coated diffuse 0.1 x 0.3", MakeCoated(tables, ggx(0.1f, 0.3f), 1.5f, Color(0.9f))},
      {"coated diffuse white", MakeCoated(tables, ggx(0.2f, 0.2f), 1.5f, Color(1.0f), 0, 1000), 1e-3f, true},
      {"coated diffuse black", MakeCoated(tables, ggx(0.2f, 0.2f), 1.5f, Color(0.0f))},
      {"coated metal smooth", MakeCoatedMetal(tables, ggx(0, 0), ggx(0, 0), 1.5f, copperEta, copperK)},
      {"coated metal 0, 0.2", MakeCoatedMetal(tables, ggx(0, 0), ggx(0.2f, 0.2f), 1.5f, copperEta, copperK)},
      {"coated metal 0.2, 0", MakeCoatedMetal(tables, ggx(0.2f, 0.2f), ggx(0, 0), 1.5f, copperEta, copperK)},
      {"coated metal 0.1, 0.3", MakeCoatedMetal(tables, ggx(0.1f, 0.1f), ggx(0.3f, 0.3f), 1.5f, copperEta, copperK)},
      {"coated metal lossless",
       MakeCoatedMetal(tables, ggx(0, 0), ggx(0.3f, 0.3f), 1.5f, Color(1.0f), mirrorK, 0, 1000), 1e-3f, true},
      Hair("hair brown", Color(0.54f, 0.91f, 1.78f), 1.55f, 0.3f, 0.3f, 2, 0.3f),
      Hair("hair white", Color(0.0f), 1.55f, 0.3f, 0.3f, 2, -0.7f),
      Hair("hair smooth", Color(0.1f, 0.2f, 0.4f), 1.55f, 0.08f, 0.1f, 3, 0.5f, 1e-2f),
      Hair("hair smooth along", Color(0.0f), 1.55f, 0.05f, 0.9f, 0, 0.9f, 1e-2f),
      Hair("hair smooth around", Color(0.05f), 1.7f, 0.9f, 0.05f, 5, -0.2f, 1e-2f),
      Hair("hair rough", Color(0.3f, 0.1f, 0), 1.2f, 1, 1, -3, 0),
      Hair("hair black", Color(1e6f), 1.55f, 0.3f, 0.3f, 2, 0.3f),
      Hair("hair at the rim", Color(0.2f), 1.55f, 0.3f, 0.3f, 2, 1),
      Hair("hair eta 1", Color(0.2f, 0, 0), 1, 0.3f, 0.3f, 2, -1),
      Hair("hair eta 0.8", Color(0.2f), 0.8f, 0.3f, 0.3f, 2, 0.6f),
      {"medium isotropic", PhaseBsdf{Color(0.9f, 0.5f, 0.2f), 0}},
      {"medium -0.0005", PhaseBsdf{Color(1.0f), -0.0005f}, 1e-3f, true},
      {"medium 0.6", PhaseBsdf{Color(0.3f, 0.8f, 0.2f), 0.6f}},
      {"medium -0.6", PhaseBsdf{Color(1.0f), -0.6f}, 1e-3f, true},
      {"medium 0.99", PhaseBsdf{Color(1.0f), 0.99f}, 1e-3f, true},
      {"medium -0.99", PhaseBsdf{Color(1.0f), -0.99f}, 1e-3f, true},
      {"measured 0.4", MakeMeasuredBsdf(tables, 0.4f, 0.4f), 5e-3f, false, false, false},
      {"measured 0.1", MakeMeasuredBsdf(tables, 0.1f, 0.1f), 2e-2f, false, false, false},
      {"measured 0.3 x 0.6", MakeMeasuredBsdf(tables, 0.3f, 0.6f), 5e-3f, false, false, false},
  };
}

// Above, oblique, grazing, and from below.
inline std::vector<Vector3> LocalDirections() {
  return {glm::normalize(Vector3(0.02f, 0.01f, 1)), glm::normalize(Vector3(0.5f, -0.4f, 0.6f)),
          glm::normalize(Vector3(-0.9f, 0.3f, 0.15f)), glm::normalize(Vector3(0.3f, 0.5f, -0.7f)),
          glm::normalize(Vector3(-0.2f, -0.9f, -0.3f))};
}

// A frame that is nobody's axes, and a BSDF in it.
inline Frame TestFrame() {
  return Frame::FromNormalAndTangent(glm::normalize(Vector3(0.3f, -0.5f, 0.8f)), {1, 2, 3});
}
inline Bsdf MakeBsdf(const BsdfModel& model) {
  const Frame frame = TestFrame();
  return Bsdf(frame, frame.z, model);
}

}  // namespace lampyr::testing
