// Materials from their parameters: defaults, what is constant, mixes, normal and bump maps, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "base/error.h"
#include "materials/material.h"
#include "scene/parameters.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr::testing {
namespace {

using ::testing::HasSubstr;

Parameter Make(ParameterType type, const std::string& name) {
  Parameter parameter;
  parameter.type = type;
  parameter.name = name;
  return parameter;
}
Parameter Float(const std::string& name, double value) {
  Parameter parameter = Make(ParameterType::Float, name);
  parameter.numbers = {value};
  return parameter;
}
Parameter Rgb(const std::string& name, double r, double g, double b) {
  Parameter parameter = Make(ParameterType::Rgb, name);
  parameter.numbers = {r, g, b};
  return parameter;
}
Parameter Spectrum(const std::string& name, const std::string& value) {
  Parameter parameter = Make(ParameterType::Spectrum, name);
  parameter.strings = {value};
  return parameter;
}
Parameter Strings(const std::string& name, std::vector<std::string> values) {
  Parameter parameter = Make(ParameterType::String, name);
  parameter.strings = std::move(values);
  return parameter;
}
Parameter Bool(const std::string& name, bool value) {
  Parameter parameter = Make(ParameterType::Bool, name);
  parameter.bools = {value};
  return parameter;
}

// The float texture "slope": u/2.
TextureDescription Slope() {
  TextureDescription slope;
  slope.name = "slope";
  slope.texture.type = "bilerp";
  slope.texture.parameters =
      ParameterList({}, "Texture \"slope\"", {Float("v00", 0), Float("v01", 0), Float("v10", 0.5), Float("v11", 0.5)});
  return slope;
}

class MakeMaterialTest : public ::testing::Test {
 protected:
  std::shared_ptr<const Material> Create(const std::string& type, std::vector<Parameter> parameters) {
    const MaterialLookup lookup = [this](const std::string& name) {
      const auto found = named_.find(name);
      if (found == named_.end()) throw Error("no material \"" + name + "\"");
      return found->second;
    };
    return MakeMaterial(type, ParameterList({}, "Material \"" + type + "\"", std::move(parameters)), textures_, lookup,
                        diagnostics_);
  }
  Bsdf At(const Material& material, const Vector3& wo = {0, 0, 1}) { return material.GetBsdf(point_, wo); }

  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_{{Slope()}, Transform(), diagnostics_};
  std::map<std::string, std::shared_ptr<const Material>> named_;
  SurfacePoint point_ = [] {
    SurfacePoint point;
    point.dpdu = {2, 0, 0};
    point.dpdv = {0, 3, 0};
    return point;
  }();
};

const Vector3 kUp(0, 0, 1), kTilted(0.6f, 0, 0.8f);

// The part of light from above that is scattered, by one lobe: all of it if there is only one.
Color ScatteredBy(const Bsdf& bsdf) {
  const auto sample = bsdf.Sample(kUp, 0.5f, {0.5f, 0.5f}, TransportMode::Importance);
  return sample ? sample.Weight() : Color(0.0f);
}

TEST_F(MakeMaterialTest, EveryTypeHasDefaults) {
  named_["a"] = Create("diffuse", {});
  named_["b"] = Create("dielectric", {});
  for (const char* type : {"diffuse", "diffusetransmission", "conductor", "dielectric", "thindielectric",
                           "coateddiffuse", "coatedconductor", "hair"}) {
    const auto material = Create(type, {});
    const Bsdf bsdf = At(*material);
    EXPECT_FALSE(ScatteredBy(bsdf).IsBlack()) << type;
    EXPECT_FALSE(material->IsInterface()) << type;
    EXPECT_EQ(bsdf.IsTransmissive(), material->MayTransmit()) << type;
    EXPECT_TRUE(material->HasDelta() || !bsdf.IsDelta()) << type;
  }
  EXPECT_TRUE(diagnostics_.Warnings().empty());
  EXPECT_NEAR(At(*named_["a"]).Evaluate(kUp, kTilted, TransportMode::Radiance).diffuse.g, 0.5f * kInvPi, 1e-6f);
  for (const char* type : {"", "interface", "none"}) EXPECT_TRUE(Create(type, {})->IsInterface()) << type;
}

TEST_F(MakeMaterialTest, GlassHasTheIndexGiven) {
  for (const auto& parameters : {std::vector<Parameter>{Float("eta", 1.5)}, {}, {Spectrum("eta", "glass-BK7")}}) {
    const auto glass = Create("dielectric", parameters);
    const auto sample = At(*glass).Sample(kTilted, kOneMinusEpsilon, {0.5f, 0.5f}, TransportMode::Radiance);
    ASSERT_TRUE(sample && sample.isTransmission);
    EXPECT_NEAR(sample.eta, 1.51f, 0.02f);
    EXPECT_NEAR(-sample.wi.x, 0.6f / sample.eta, 1e-5f);
  }
  EXPECT_THROW(Create("dielectric", {Float("eta", -1)}), Error);
  EXPECT_TRUE(diagnostics_.Warnings().empty());
  Create("dielectric", {Rgb("eta", 1.5, 1.5, 1.5)});
  EXPECT_TRUE(diagnostics_.Warnings().empty());
  Create("dielectric", {Rgb("eta", 1.5, 1.51, 1.52)});
  ASSERT_EQ(diagnostics_.Warnings().size(), 1u);
  EXPECT_THAT(diagnostics_.Warnings()[0], HasSubstr("one index for all colours"));
}

TEST_F(MakeMaterialTest, CopperIsRedAndReflectanceIsMet) {
  const Color copper = ScatteredBy(At(*Create("conductor", {})));
  EXPECT_GT(copper.r, 0.85f);
  EXPECT_LT(copper.b, 0.7f);
  const Color given = ScatteredBy(At(*Create("conductor", {Rgb("reflectance", 0.9, 0.5, 0)})));
  EXPECT_NEAR(given.r, 0.9f, 1e-4f);
  EXPECT_NEAR(given.g, 0.5f, 1e-4f);
  EXPECT_NEAR(given.b, 0, 1e-4f);
  EXPECT_THROW(Create("conductor", {Rgb("reflectance", 1, 1, 1), Spectrum("eta", "metal-Cu-eta")}), Error);
}

TEST_F(MakeMaterialTest, RoughnessIsRemappedUnlessForbidden) {
  const auto density = [&](std::vector<Parameter> parameters) {
    return At(*Create("conductor", std::move(parameters))).Evaluate(kUp, kUp, TransportMode::Radiance).pdfForward.value;
  };
  // At normal incidence the density is D/4 = 1/(4π α²).
  EXPECT_NEAR(density({Float("roughness", 0.25)}), 1 / (4 * kPi * 0.25f), 1e-3f);
  EXPECT_NEAR(density({Float("roughness", 0.25), Bool("remaproughness", false)}), 1 / (4 * kPi * 0.0625f), 1e-3f);
  EXPECT_NEAR(density({Float("uroughness", 0.25), Float("vroughness", 0.04)}), 1 / (4 * kPi * 0.5f * 0.2f), 1e-3f);
  EXPECT_EQ(density({Float("roughness", 1e-7)}), 0);
  EXPECT_THROW(density({Float("roughness", -0.1)}), Error);
}

TEST_F(MakeMaterialTest, MixChoosesByAmount) {
  named_["black"] = Create("diffuse", {Rgb("reflectance", 0, 0, 0)});
  named_["white"] = Create("diffuse", {Rgb("reflectance", 1, 1, 1)});
  for (const double amount : {0.0, 0.3, 1.0}) {
    const auto mix = Create("mix", {Strings("materials", {"black", "white"}), Float("amount", amount)});
    int white = 0;
    constexpr int kPoints = 20000;
    for (int i = 0; i < kPoints; ++i) {
      point_.position = {0.001f * static_cast<float>(i), 1, 2};
      white += ScatteredBy(At(*mix)).g > 0.5f;
      EXPECT_EQ(ScatteredBy(At(*mix)), ScatteredBy(At(*mix)));
    }
    EXPECT_NEAR(white / static_cast<double>(kPoints), amount, 3.5 * std::sqrt(amount * (1 - amount) / kPoints) + 1e-12);
  }
  EXPECT_THROW(Create("mix", {Strings("materials", {"black"})}), Error);
  EXPECT_THROW(Create("mix", {Strings("materials", {"black", "nobody"})}), Error);
}

TEST_F(MakeMaterialTest, DisplacementTiltsTheNormal) {
  Parameter displacement = Make(ParameterType::Texture, "displacement");
  displacement.strings = {"slope"};
  const auto material = Create("diffuse", {displacement});
  point_.uv = {0.3f, 0.4f};
  // dp/du = (2, 0, 1/2): the normal is (-1/2, 0, 2), normalised.
  EXPECT_LT(glm::length(At(*material).ShadingFrame().z - glm::normalize(Vector3(-0.5f, 0, 2))), 1e-3f);
  EXPECT_EQ(At(*material).Ng(), Vector3(0, 0, 1));
  point_.dpdu = point_.dpdv = Vector3(0.0f);  // degenerate: the surface's own normal
  EXPECT_EQ(At(*material).ShadingFrame().z, Vector3(0, 0, 1));
}

TEST_F(MakeMaterialTest, TexturedRoughnessInterpolatesTables) {
  Parameter roughness = Make(ParameterType::Texture, "roughness");
  roughness.strings = {"slope"};
  const auto textured = Create("coateddiffuse", {roughness});
  point_.uv = {0.32f, 0};
  const Color varying = At(*textured).Evaluate(kUp, kTilted, TransportMode::Radiance).diffuse;
  const Color constant =
      At(*Create("coateddiffuse", {Float("roughness", 0.16)})).Evaluate(kUp, kTilted, TransportMode::Radiance).diffuse;
  EXPECT_NEAR(varying.g, constant.g, 0.01f * constant.g);
}

// Absorption of hair, by the first of its parameters that is given, measured by straight transmission.
TEST_F(MakeMaterialTest, HairAbsorbsAsItIsSaid) {
  point_.uv = {0, 0.5f};
  const auto density = [&](std::vector<Parameter> parameters) {
    return At(*Create("hair", std::move(parameters))).Evaluate(kUp, -kTilted, TransportMode::Radiance).specular;
  };
  const Color brown = density({});
  EXPECT_GT(brown.r, 1.5f * brown.b);
  EXPECT_EQ(brown, density({Float("eumelanin", 1.3)}));
  EXPECT_EQ(brown, density({Float("beta_m", 0.3), Float("beta_n", 0.3), Float("alpha", 2), Float("eta", 1.55)}));
  const Color sigma = density({Rgb("sigma_a", 0.5447, 0.9061, 1.781)});
  EXPECT_NEAR(sigma.g, brown.g, 1e-5f * brown.g);
  EXPECT_NEAR(density({Float("eumelanin", 0.3), Float("pheomelanin", 2)}).g,
              density({Rgb("sigma_a", 0.4997, 1.0091, 2.511)}).g, 1e-5f);
  const Color gray = density({Rgb("reflectance", 0.5, 0.5, 0.5)});
  EXPECT_EQ(gray, density({Rgb("color", 0.5, 0.5, 0.5)}));
  EXPECT_NEAR(gray.g, density({Rgb("sigma_a", 0.0138565, 0.0138565, 0.0138565)}).g, 1e-4f);
  EXPECT_TRUE(diagnostics_.Warnings().empty());
  // Other parameters are ignored, with a warning.
  EXPECT_EQ(sigma,
            density({Rgb("sigma_a", 0.5447, 0.9061, 1.781), Rgb("reflectance", 1, 0, 0), Float("eumelanin", 8)}));
  EXPECT_EQ(diagnostics_.Warnings().size(), 2u);
  EXPECT_EQ(gray, density({Rgb("reflectance", 0.5, 0.5, 0.5), Rgb("color", 1, 0, 0), Float("pheomelanin", 8)}));
  EXPECT_EQ(diagnostics_.Warnings().size(), 4u);
  EXPECT_THROW(density({Float("beta_m", 1.5)}), Error);
  EXPECT_THROW(density({Float("beta_n", -0.1)}), Error);
  EXPECT_THROW(density({Float("eta", 0)}), Error);
  EXPECT_THROW(density({Float("eumelanin", -1)}), Error);
  EXPECT_THROW(density({Float("betam", 0.3)}), Error);
}

// The offset is v across, wherever the point is; on curves it is to the side to which v grows.
TEST_F(MakeMaterialTest, HairReflectsToTheSideOfItsOffset) {
  const auto material = Create("hair", {Rgb("sigma_a", 1e6, 1e6, 1e6), Float("beta_m", 0.05), Float("beta_n", 0.05)});
  point_.dpdu = {1, 0, 0};
  point_.uv = {0, 0.75f};
  const auto sideOf = [&] {
    const auto sample = At(*material).Sample(kUp, 0.5f, {0.5f, 0.5f}, TransportMode::Radiance);
    return sample ? sample.wi.y : 0.0f;
  };
  for (const float across : {1.0f, -1.0f}) {
    point_.dpdv = {0, across, 0};
    point_.strand = Strand::None;
    EXPECT_GT(sideOf(), 0.5f);
    for (const Strand strand : {Strand::Ribbon, Strand::Fibre}) {
      point_.strand = strand;
      EXPECT_GT(sideOf() * across, 0.5f);
      EXPECT_EQ(At(*material).IsFibre(), strand == Strand::Fibre);
    }
  }
}

// Ray tracing leaves uv and tangents at 0 where no material asks for them.
TEST_F(MakeMaterialTest, UvAndTangentsAreLookedAtWhereItSaysSo) {
  named_["a"] = Create("diffuse", {});
  named_["b"] = Create("conductor", {Float("roughness", 0.3)});
  const auto slope = [](const std::string& name) {
    Parameter parameter = Make(ParameterType::Texture, name);
    parameter.strings = {"slope"};
    return parameter;
  };
  const Parameter both = Strings("materials", {"a", "b"});
  const struct {
    const char* type;
    std::vector<Parameter> parameters;
    bool needs;
  } cases[] = {{"diffuse", {}, false},
               {"diffuse", {slope("displacement")}, true},
               {"diffusetransmission", {}, false},
               {"conductor", {Float("roughness", 0.4)}, false},
               {"conductor", {slope("roughness")}, true},
               {"conductor", {Float("uroughness", 0.1), Float("vroughness", 0.6)}, true},
               {"dielectric", {Float("roughness", 0.4)}, false},
               {"thindielectric", {}, false},
               {"thindielectric", {slope("displacement")}, true},
               {"coateddiffuse", {Float("roughness", 0.4)}, false},
               {"coatedconductor", {}, false},
               {"hair", {}, true},
               {"mix", {both, Float("amount", 0.5)}, false},
               {"mix", {both, slope("amount")}, true}};
  for (const auto& [type, parameters, needs] : cases) {
    const auto material = Create(type, parameters);
    EXPECT_EQ(material->NeedsParametrization(), needs) << type;
    const auto scattered = [&](const SurfacePoint& point) {
      return material->GetBsdf(point, kTilted).Evaluate(kTilted, {0, 0.28f, 0.96f}, TransportMode::Radiance);
    };
    SurfacePoint parametrized = point_, bare = point_;
    parametrized.uv = {0.9f, 0.2f};
    parametrized.dpdu = {1, 2, 0};
    bare.uv = Point2(0.0f);
    bare.dpdu = bare.dpdv = Vector3(0.0f);
    const BsdfEvaluation with = scattered(parametrized), without = scattered(bare);
    const bool isSame = with.Sum() == without.Sum() && with.pdfForward.value == without.pdfForward.value;
    EXPECT_TRUE(isSame || needs) << type;
  }
}

// At the wavelengths of a pass: colours are upsampled, spectra are themselves, and gray is gray.
TEST_F(MakeMaterialTest, MaterialsAreTunedToWavelengths) {
  const auto wavelengths = std::make_shared<const Wavelengths>(0.3);
  const Vector3 o(0.1f, 0.2f, 0.97f), i(0.15f, -0.1f, 0.98f);
  const auto at = [&](const std::string& type, const std::vector<Parameter>& parameters) {
    const auto tuned = MaterialsAt(wavelengths, {Create(type, parameters)});
    return At(*tuned[0], o).Evaluate(glm::normalize(o), glm::normalize(i), TransportMode::Radiance).Sum();
  };
  const Color gray = at("diffuse", {Rgb("reflectance", 0.4, 0.4, 0.4)});
  EXPECT_EQ(gray, Color(gray.r));
  const Color red = at("diffuse", {Rgb("reflectance", 0.8, 0.1, 0.1)}),
              expected = wavelengths->FromRgb({0.8f, 0.1f, 0.1f});
  for (const auto& [value, of] :
       {std::pair(red.r, expected.r), std::pair(red.g, expected.g), std::pair(red.b, expected.b)})
    EXPECT_NEAR(value, of * kInvPi, 1e-6f);
  named_ = {{"a", Create("diffuse", {Rgb("reflectance", 0.8, 0.1, 0.1)})}, {"b", Create("diffuse", {})}};
  EXPECT_EQ(at("mix", {Strings("materials", {"a", "b"}), Float("amount", 0)}), red);
  // Gold reflects red more than blue: lane 2 has the longest wavelength.
  const Color gold =
      at("conductor", {Spectrum("eta", "metal-Au-eta"), Spectrum("k", "metal-Au-k"), Float("roughness", 0.5)});
  EXPECT_GT(gold.b, 1.5f * gold.r);
  for (const char* type : {"diffusetransmission", "coateddiffuse", "coatedconductor", "hair"}) {
    const Color rgb =
        At(*Create(type, {}), o).Evaluate(glm::normalize(o), glm::normalize(i), TransportMode::Radiance).Sum();
    const Color tuned = at(type, {});
    EXPECT_TRUE(tuned.IsValid()) << type;
    EXPECT_NEAR(tuned.Average(), rgb.Average(), 0.5f * rgb.Average()) << type;
  }
}

TEST_F(MakeMaterialTest, GlassDispersesWhereItsIndexVaries) {
  const auto numbers = [](const std::string& name, std::vector<double> values) {
    Parameter parameter = Make(ParameterType::Float, name);
    parameter.numbers = std::move(values);
    return parameter;
  };
  EXPECT_FALSE(Create("dielectric", {})->Disperses());
  EXPECT_FALSE(Create("dielectric", {Float("eta", 1.7)})->Disperses());
  EXPECT_FALSE(Create("dielectric", {numbers("cauchy", {1.5, 0})})->Disperses());
  EXPECT_TRUE(Create("dielectric", {Spectrum("eta", "glass-BK7")})->Disperses());
  EXPECT_TRUE(Create("dielectric", {numbers("cauchy", {1.5, 0.004})})->Disperses());
  named_ = {{"a", Create("diffuse", {})}, {"b", Create("dielectric", {Spectrum("eta", "glass-F11")})}};
  EXPECT_TRUE(Create("mix", {Strings("materials", {"a", "b"})})->Disperses());
  // As red, green and blue it has the index at the d line of helium.
  const auto sample = At(*Create("dielectric", {numbers("cauchy", {1.5, 0.01})}))
                          .Sample({0.6f, 0, 0.8f}, 0.99f, {0.5f, 0.5f}, TransportMode::Radiance);
  EXPECT_NEAR(sample.eta, 1.5 + 0.01 / (0.58756 * 0.58756), 1e-4);
  for (const std::vector<Parameter>& wrong :
       {std::vector{numbers("cauchy", {1.5})}, std::vector{numbers("cauchy", {1.5, 0, 0, 0})},
        std::vector{numbers("sellmeier", {1, 1, 1})}, std::vector{numbers("cauchy", {-1, 0})},
        std::vector{numbers("sellmeier", {1, 0, 0, 0.25, 0, 0})},
        std::vector{numbers("cauchy", {1.5, 0.004}), Float("eta", 1.5)},
        std::vector{numbers("cauchy", {1.5, 0.004}), numbers("sellmeier", {1, 0, 0, 0.01, 0, 0})}}) {
    EXPECT_THROW(Create("dielectric", wrong), Error) << wrong[0].name << wrong[0].numbers.size();
  }
}

TEST_F(MakeMaterialTest, WrongInputIsNamed) {
  try {
    Create("difuse", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean \"diffuse\""));
  }
  EXPECT_THROW(Create("diffuse", {Rgb("reflectence", 1, 1, 1)}), Error);
  EXPECT_THROW(Create("coateddiffuse", {Float("thickness", -1)}), Error);
  EXPECT_TRUE(diagnostics_.Warnings().empty());
  EXPECT_NEAR(ScatteredBy(At(*Create("subsurface", {Float("scale", 2)}))).g, 0.5f, 1e-6f);
  ASSERT_EQ(diagnostics_.Warnings().size(), 1u);
  EXPECT_THAT(diagnostics_.Warnings()[0], HasSubstr("subsurface"));
  Create("coateddiffuse", {Rgb("albedo", 0.5, 0.5, 0.5)});
  EXPECT_EQ(diagnostics_.Warnings().size(), 2u);
}

}  // namespace
}  // namespace lampyr::testing
