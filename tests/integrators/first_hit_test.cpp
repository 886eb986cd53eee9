// Photons through the lighting services: what lands on a receiver is what next-event estimation finds there, and the
// densities of a firstHit are those that the other techniques report of the same light vertex.
#include <gtest/gtest.h>

#include <cmath>

#include "sampling/rng.h"
#include "support/aimed.h"
#include "support/estimate.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

constexpr float kHalf = 0.5f;  // half side of the receiver, a square at y = 0 that faces +y

const std::string kScene = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
Camera "perspective"
WorldBegin
Shape "trianglemesh" "point3 P" [-.5 0 -.5  -.5 0 .5  .5 0 .5  .5 0 -.5] "integer indices" [0 1 2 0 2 3]
)";

struct NamedLight {
  const char* name;
  std::string text;
};

const std::vector<NamedLight>& Lights() {
  static const std::vector<NamedLight> lights = {
      {"quad", R"(AreaLightSource "diffuse" "rgb L" [3 2 1]
Translate 0.3 1 0.1 Rotate 100 1 0.2 0 Shape "bilinearmesh" "point3 P" [-.5 -.4 0  .5 -.4 0  -.5 .4 0  .5 .4 .1])"},
      {"sphere",
       "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1]\nTranslate 0.2 0.9 0 Shape \"sphere\" \"float radius\" .3"},
      {"instance",
       R"(ObjectBegin "o" AreaLightSource "diffuse" "rgb L" [3 2 1] Shape "disk" "float radius" 0.4 ObjectEnd
Translate 0.1 0.8 0 Rotate 80 1 0 0.3 Scale 1 1.5 1 ObjectInstance "o")"},
      {"point", "LightSource \"point\" \"rgb I\" [3 2 1] \"point3 from\" [0.2 0.9 0.1]"},
      {"spot",
       R"(LightSource "spot" "rgb I" [3 2 1] "point3 from" [0.2 1.5 0.1] "point3 to" [0 0 0] "float coneangle" 40)"},
      {"distant", "LightSource \"distant\" \"rgb L\" [3 2 1] \"point3 from\" [0.4 1 0.2]"},
      {"infinite", "LightSource \"infinite\" \"rgb L\" [0.3 0.2 0.1]"},
      {"two of a kind", R"(LightSource "point" "rgb I" [1 1 1] "point3 from" [0.2 0.9 0.1]
LightSource "distant" "rgb L" [1 2 1] "point3 from" [-0.4 1 0.2])"}};
  return lights;
}

BuiltScene Build(const std::string& light) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(kScene + light, "test.pbrt", diagnostics), {}, true, diagnostics);
}

// The receiver's surface is primitive 0.
SurfacePoint ReceiverAt(const GeometryScene& geometry, const Point3& position) {
  const Ray ray{position + Vector3(0, 0.01f, 0), {0, -1, 0}, kInfinity, 0};
  RayHit hit;
  EXPECT_TRUE(geometry.Intersect(ray, visibility::kAll, hit));
  return geometry.GetSurfacePoint(ray, hit);
}

// Where a photon meets the first surface that it lights.
std::optional<RayHit> FirstHitOf(const GeometryScene& geometry, const EmittedPhoton& photon) {
  RayHit hit;
  const bool isLit = !photon.IsDark() && geometry.Intersect(photon.ray, visibility::kIndirect, hit) &&
                     hit.t >= photon.emission.shinesFrom;
  return isLit ? std::optional(hit) : std::nullopt;
}

// Mean irradiance over the receiver.
Estimate ByPhotons(const BuiltScene& built, const LightingServices& lighting, int count) {
  Rng rng(1);
  Estimate estimate;
  for (int i = 0; i < count; ++i) {
    const float uSelect = rng.NextFloat();
    const Point2 u = rng.NextPoint2();
    const auto photon = lighting.GenerateEmission(uSelect, u, rng.NextPoint2(), 0);
    double flux = 0;
    const auto firstHit = photon ? FirstHitOf(*built.scene.geometry, *photon) : std::nullopt;
    if (firstHit && firstHit->primitive == 0 && photon->ray.direction.y < 0) {
      const EmissionSample& e = photon->emission;
      flux = static_cast<double>(e.diffuse.g * e.emissionCosine / e.pdfEmit.value / e.pdfEmitDirection.value /
                                 photon->emissionSelection.value);
    }
    estimate.Add(flux / static_cast<double>(4 * kHalf * kHalf));
  }
  return estimate;
}

Estimate ByLightSampling(const BuiltScene& built, int count) {
  const LightingServices& lighting = *built.scene.lighting;
  Rng rng(2);
  Estimate estimate;
  for (int i = 0; i < count; ++i) {
    const Point2 u = rng.NextPoint2();
    const SurfacePoint point =
        ReceiverAt(*built.scene.geometry, {kHalf * (2 * u.x - 1) * 0.999f, 0, kHalf * (2 * u.y - 1) * 0.999f});
    const Receiver receiver{point.position, {0, 1, 0}, false};
    const float uSelect = rng.NextFloat();
    const DirectSample direct = SampleOneLight(lighting, receiver, uSelect, rng.NextPoint2(), 0, false);
    double irradiance = 0;
    if (direct && direct.sample->direction.y > 0) {
      irradiance = static_cast<double>(direct.sample->diffuse.g * direct.sample->direction.y *
                                       lighting.Transmittance(point, direct, 0).g /
                                       (direct.selection * direct.sample->pdfDirect).value);
    }
    estimate.Add(irradiance);
  }
  return estimate;
}

TEST(Photons, LandWhereLightSamplingFindsLight) {
  for (const NamedLight& light : Lights()) {
    const BuiltScene built = Build(light.text);
    const Estimate photons = ByPhotons(built, *built.scene.lighting, 400000), direct = ByLightSampling(built, 100000);
    const double sigma = std::sqrt(photons.Variance() + direct.Variance());
    ASSERT_GT(direct.Mean(), 0.05) << light.name;
    EXPECT_LT(sigma, 0.02 * direct.Mean()) << light.name;
    EXPECT_NEAR(photons.Mean(), direct.Mean(), 4.5 * sigma + 2e-3 * direct.Mean()) << light.name;
    // Aimed at a part of the receiver and past its rim, they bring the same.
    const auto guide = AimAt(*built.scene.lighting, Point3(0.3f, 0, -0.2f), 0.2f);
    const Estimate aimed = ByPhotons(built, built.scene.lighting->With(nullptr, guide.get()), 400000);
    const double either = std::sqrt(aimed.Variance() + direct.Variance());
    EXPECT_LT(either, 0.02 * direct.Mean()) << light.name;
    EXPECT_NEAR(aimed.Mean(), direct.Mean(), 4.5 * either + 2e-3 * direct.Mean()) << light.name << ", aimed";
  }
}

void ExpectSame(float a, float b, const char* what, const char* light) {
  EXPECT_GT(a, 0) << what << " of " << light;
  EXPECT_NEAR(a, b, 2e-3f * std::max(std::abs(a), std::abs(b))) << what << " of " << light;
}

void ExpectSame(const LightEvaluation& firstHit, const LightEvaluation& other, const char* light) {
  ExpectSame(firstHit.diffuse.g, other.diffuse.g, "radiance", light);
  ExpectSame(firstHit.specular.g, other.specular.g, "specular radiance", light);
  ExpectSame(firstHit.pdfDirect.value, other.pdfDirect.value, "pdfDirect", light);
  ExpectSame(firstHit.pdfEmit.value, other.pdfEmit.value, "pdfEmit", light);
  ExpectSame(firstHit.pdfEmitDirection.value, other.pdfEmitDirection.value, "pdfEmitDirection", light);
  ExpectSame(firstHit.solidAngleToArea, other.solidAngleToArea, "solidAngleToArea", light);
}

// The light vertex of a photon again, as a ray from the receiver finds it, or as the only sample of a delta light.
std::optional<FoundLight> FindAgain(const BuiltScene& built, const LightingServices& lighting,
                                    const EmittedPhoton& photon, const SurfacePoint& point, const Receiver& receiver) {
  const LightKind kind = lighting.Lights()[photon.light].light->Kind();
  const Vector3 back = -photon.ray.direction;
  if (kind == LightKind::Infinite) return lighting.EvaluateEscaped(0, receiver, back, 0, true);
  if (kind == LightKind::Area) {
    const Ray ray = SpawnRay(point, back, 0);
    RayHit hit;
    if (!built.scene.geometry->Intersect(ray, visibility::kIndirect, hit)) return std::nullopt;
    const SurfacePoint light = built.scene.geometry->GetSurfacePoint(ray, hit);
    return lighting.EvaluateSamples(receiver, back, glm::distance(light.position, point.position), light, 0, true);
  }
  for (int i = 0; i < 64; ++i) {  // until it is this light's turn
    const float uSelect = (static_cast<float>(i) + 0.5f) / 64;
    const DirectSample direct = SampleOneLight(lighting, receiver, uSelect, Point2(0.5f), 0, true);
    if (!direct || direct.light != photon.light) continue;
    const LightSample& s = *direct.sample;
    EXPECT_GT(glm::dot(s.direction, back), 1 - 1e-5f);
    return FoundLight{
        direct.light,
        direct.selection,
        {s.normal, s.diffuse, s.specular, s.pdfDirect, s.pdfEmit, s.pdfEmitDirection, s.solidAngleToArea}};
  }
  return std::nullopt;
}

class FirstHits : public testing::TestWithParam<bool> {};  // aimed

TEST_P(FirstHits, HaveTheDensitiesOfTheOtherTechniques) {
  for (const NamedLight& light : Lights()) {
    const BuiltScene built = Build(light.text);
    const auto guide = AimAt(*built.scene.lighting, Point3(0.3f, 0, -0.2f), 0.2f);
    const LightingServices lighting = built.scene.lighting->With(nullptr, GetParam() ? guide.get() : nullptr);
    Rng rng(3);
    int compared = 0, missed = 0;
    for (int i = 0; i < 20000 && compared < 300; ++i) {
      const float uSelect = rng.NextFloat();
      const Point2 u = rng.NextPoint2();
      const auto photon = lighting.GenerateEmission(uSelect, u, rng.NextPoint2(), 0);
      const auto hit = photon ? FirstHitOf(*built.scene.geometry, *photon) : std::nullopt;
      if (!hit || hit->primitive != 0) continue;
      const SurfacePoint point = built.scene.geometry->GetSurfacePoint(photon->ray, *hit);
      // On the side that the photon meets: behind a receiver there is no density.
      const Normal3 normal = glm::dot(point.Ns, photon->ray.direction) > 0 ? -point.Ns : point.Ns;
      const Receiver receiver{point.position, normal, false};
      const auto firstHit = lighting.EvaluateFirstHit(*photon, receiver);
      ASSERT_TRUE(firstHit) << light.name;
      const auto again = FindAgain(built, lighting, *photon, point, receiver);
      if (!again || again->light != firstHit->light) {  // the rim of a light, missed by a rounding
        ++missed;
        continue;
      }
      ++compared;
      EXPECT_EQ(firstHit->selection.value, again->selection.value) << light.name;
      // A grazing photon's cosine has few digits.
      if (std::abs(photon->emission.emissionCosine) > 0.05f && std::abs(photon->ray.direction.y) > 0.05f) {
        ExpectSame(firstHit->evaluation, again->evaluation, light.name);
      }
    }
    EXPECT_GE(compared, 300) << light.name;
    EXPECT_LE(missed, 2) << light.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Photons, FirstHits, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Aimed" : "Unaimed"; });

// A shadow ray stops short of the sample, also where the light is turned and far from the origin.
TEST(LightSampling, InstancesFarAwayDoNotShadeThemselves) {
  const std::string far =
      "AttributeBegin Translate -500 -500 -500 Shape \"sphere\" AttributeEnd\n"
      "AttributeBegin Translate 500 500 500 Shape \"sphere\" AttributeEnd\n"
      "ObjectBegin \"o\" AreaLightSource \"diffuse\" Shape \"sphere\" \"float radius\" 0.5 ObjectEnd\n";
  for (const bool moves : {false, true}) {
    const BuiltScene built =
        Build(far + (moves ? "ActiveTransform EndTime Translate 0 20 0\nActiveTransform All\n" : "") +
              "Translate 400 1 0 Rotate 77 1 1 0 ObjectInstance \"o\"");
    const LightingServices& lighting = *built.scene.lighting;
    Rng rng(4);
    int samples = 0, occluded = 0;
    for (int i = 0; i < 100000; ++i) {
      const float time = moves ? rng.NextFloat() : 0.0f;
      const Point3 center(400, 1 + (moves ? 20 * time : 0.0f), 0);
      const Point2 u = rng.NextPoint2();
      const Point3 position = center + 4.0f * Vector3(2 * u.x - 1, 2 * u.y - 1, 2 * rng.NextFloat() - 1);
      if (glm::distance(position, center) < 0.9f) continue;
      const DirectSample direct =
          SampleOneLight(lighting, {position, {0, 1, 0}, false}, 0.5f, rng.NextPoint2(), time, false);
      if (!direct) continue;
      SurfacePoint point;
      point.position = position;
      point.Ng = point.Ns = direct.sample->direction;
      ++samples;
      occluded += lighting.Transmittance(point, direct, time).IsBlack();
    }
    EXPECT_GT(samples, 90000) << moves;
    EXPECT_EQ(occluded, 0) << moves;
  }
}

}  // namespace
}  // namespace lampyr::test
