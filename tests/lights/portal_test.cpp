// Portals against quadratures that know nothing of them: what comes through a window is what a surface of the same size
// with the sky's radiance would send.
#include <gtest/gtest.h>

#include <numbers>

#include "sampling/rng.h"
#include "sky_fixture.h"
#include "support/chi_squared.h"

namespace lampyr {
namespace {

using test::Build;

constexpr double kPiDouble = std::numbers::pi;

// The window as the test itself knows it: render space, the edges' product points to the sky.
struct Window {
  Point3d corner;
  Vector3d edgeX, edgeY;
  Point3d At(double u, double v) const { return corner + u * edgeX + v * edgeY; }
  Vector3d Product() const { return glm::cross(edgeX, edgeY); }
};

Window PlacedWindow(double width, double height, const Transform& placement) {
  Window w{placement.Point({-0.5 * width, -0.5 * height, 0}), placement.Vector({width, 0, 0}),
           placement.Vector({0, height, 0})};
  if (glm::dot(w.Product(), placement.Normal({0, 0, 1})) < 0) std::swap(w.edgeX, w.edgeY);
  return w;
}

// ∫ over the window seen from P of f(direction) dω, by the middle rule.
double Integrate(const Window& w, const Point3d& P, int n, const std::function<double(const Vector3d&)>& f,
                 double u0 = 0, double u1 = 1, double v0 = 0, double v1 = 1) {
  double sum = 0;
  for (int i = 0; i < n * n; ++i) {
    const Vector3d way = w.At(u0 + (u1 - u0) * (i % n + 0.5) / n, v0 + (v1 - v0) * (i / n + 0.5) / n) - P;
    const double d = glm::length(way), cosine = glm::dot(way, w.Product()) / d;  // times the area
    if (cosine > 0) sum += f(way / d) * cosine / (d * d);
  }
  return sum * (u1 - u0) * (v1 - v0) / (n * n);
}

struct Estimate {
  double mean = 0, error = 0;
};
Estimate SampledIrradiance(const test::BuiltLight& built, const Point3& P, const Normal3& n, int samples = 1 << 15) {
  Rng rng(5);
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    LightContext context = built.context;
    context.u = rng.NextPoint2();
    const auto sample = built.light->GenerateSamples(context, P);
    if (!sample) continue;
    const double value = static_cast<double>(sample->diffuse.g) *
                         static_cast<double>(std::max(glm::dot(n, sample->direction), 0.0f)) /
                         static_cast<double>(sample->pdfDirect.value);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(squares / samples - mean * mean, 0.0) / samples)};
}
// Equal within what chance and `tolerance` of quadrature allow. `what` tells the case.
void ExpectIrradiance(const Estimate& estimate, double expected, double tolerance, const std::string& what = "") {
  EXPECT_NEAR(estimate.mean, expected, 4.5 * estimate.error + tolerance * expected) << what;
  EXPECT_LT(estimate.error, 0.05 * expected) << what;  // or this proves nothing
}

LightHit Escape(const Point3& from, const Vector3& direction) {
  LightHit hit;
  hit.direction = direction;
  hit.position = from;
  return hit;
}

std::vector<Transform> Placements() {
  const Transform turn = Transform::Translate({0.3, -1, 2}) * Transform::Rotate(130, {1, 2, -0.5});
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.6;
  shear[2][1] = -0.4;
  return {Transform(),
          turn,
          turn * Transform::Scale({-1, 1, 1}),
          turn * Transform::Scale({2, 0.5, 1.3}),
          Transform(shear) * turn,
          Transform(shear) * turn * Transform::Scale({1, 1, -1})};
}

// Receivers on the inner side, in the portal's own space.
const Point3d kReceivers[] = {{0, 0, -1}, {0.3, 0.2, -0.05}, {3, -2, -4}, {2, 0.1, -0.2}};

// --- an even sky

TEST(Portal, IsARectangleOfTheSkysRadiance) {
  const std::vector<Transform> placements = Placements();
  for (const Transform& placement : placements) {
    const auto portal = Build("portal", "\"float width\" 2 \"float height\" 1.5 \"float intensity\" 5", placement);
    const Window window = PlacedWindow(2, 1.5, placement);
    for (const Point3d& local : kReceivers) {
      const Point3d P(Point3(placement.Point(local)));
      // The normal of a receiver that faces the portal, so that no part is cut off.
      const Vector3d n = glm::normalize(window.At(0.5, 0.5) - P);
      const double expected =
          Integrate(window, P, 400, [&](const Vector3d& w) { return 5 * std::max(glm::dot(w, n), 0.0); });
      ExpectIrradiance(SampledIrradiance(*portal, Point3(P), Normal3(n)), expected, 1e-3,
                       std::to_string(local.x) + ", placement " + std::to_string(&placement - placements.data()));
      EXPECT_GT(portal->light->GetIncidentRadianceEstimate(portal->context, Point3(P)), 0);
    }
    const double area = glm::length(window.Product());
    EXPECT_NEAR(static_cast<double>(portal->light->GetPowerEstimate(portal->context).g) / (5 * kPiDouble * area), 1,
                1e-5);
  }
}

TEST(Portal, DensityIntegratesToOneAndIsFollowed) {
  for (const Transform& placement : Placements()) {
    const auto portal = Build("portal", "\"float width\" 2 \"float height\" 1.5", placement);
    const Window window = PlacedWindow(2, 1.5, placement);
    for (const Point3d& local : kReceivers) {
      const Point3 P(placement.Point(local));
      const auto density = [&](const Vector3d& w) {
        const auto e = portal->light->EvaluateSamples(portal->context, Escape(P, Vector3(w)), P);
        return static_cast<double>(e->pdfDirect.value);
      };
      EXPECT_NEAR(Integrate(window, Point3d(P), 300, density), 1, 2e-3);
    }
  }
}

TEST(Portal, NothingFromBehindBesideOrInThePlane) {
  const auto portal = Build("portal", "");  // towards -z from z = 0
  for (const Point3& P : {Point3(0, 0, 1), Point3(0, 0, 0), Point3(2, 0, 0), Point3(5, 5, 3), Point3(0.5f, 0, 0)}) {
    for (const Point2& u : {Point2(0.0f), Point2(0.4f, 0.7f)}) {
      portal->context.u = u;
      EXPECT_FALSE(portal->light->GenerateSamples(portal->context, P));
    }
    for (const Vector3& direction : {Vector3(0, 0, 1), Vector3(0, 0, -1), Vector3(1, 0, 0), Vector3(0.6f, 0, 0.8f)}) {
      const auto e = portal->light->EvaluateSamples(portal->context, Escape(P, direction), P);
      ASSERT_TRUE(e);
      EXPECT_TRUE(e->pdfDirect.IsZero() && e->pdfEmit.IsZero() && e->diffuse.IsBlack());
      EXPECT_TRUE(portal->light->EvaluateEmissionForCamera(portal->context, Escape(P, direction)).IsBlack());
    }
  }
  // From inside: by directions through the window and no others.
  const Point3 P(0, 0, -1);
  const auto seen = [&](const Vector3& way) {
    const LightHit hit = Escape(P, glm::normalize(way));
    const bool camera = !portal->light->EvaluateEmissionForCamera(portal->context, hit).IsBlack();
    const auto e = portal->light->EvaluateSamples(portal->context, hit, P);
    EXPECT_EQ(camera, !e->diffuse.IsBlack());
    EXPECT_EQ(camera, !e->pdfDirect.IsZero());
    return camera;
  };
  EXPECT_TRUE(seen({0.499f, -0.499f, 1}));
  EXPECT_TRUE(seen({0, 0, 1}));
  EXPECT_FALSE(seen({0.501f, 0, 1}));
  EXPECT_FALSE(seen({0, -0.501f, 1}));
  EXPECT_FALSE(seen({0, 0, -1}));
  EXPECT_FALSE(seen({1, 0, 0}));
  const auto hidden = Build("portal", "\"bool cameraVisible\" false");
  EXPECT_TRUE(hidden->light->EvaluateEmissionForCamera(hidden->context, Escape(P, {0, 0, 1})).IsBlack());
}

TEST(Portal, ExtremeReceiversLoseNoSample) {
  // Touching, grazing, far and very far; and a portal so small that directions cannot resolve it.
  Rng rng(8);
  for (const char* size : {"1", "1e-6", "1e4"}) {
    const auto portal = Build("portal", std::string("\"float width\" ") + size + " \"float height\" " + size);
    for (const Point3& P : {Point3(0.2f, 0.1f, -1e-6f), Point3(2, 0, -1e-6f), Point3(-3, 5, -1e-3f),
                            Point3(100, 30, -1000), Point3(2e4f, 3e4f, -1e5f), Point3(0.49f, 0.5f, -1e-3f)}) {
      double sum = 0;
      for (int i = 0; i < 500; ++i) {
        portal->context.u = rng.NextPoint2();
        const auto sample = portal->light->GenerateSamples(portal->context, P);
        ASSERT_TRUE(sample) << size << " " << P.x;
        ASSERT_TRUE(sample->pdfDirect.value > 0 && std::isfinite(sample->pdfDirect.value));
        sum += 1 / static_cast<double>(sample->pdfDirect.value);
      }
      // The solid angle by small-angle reasoning, where that applies.
      const double d2 = static_cast<double>(glm::dot(P, P)), side = std::stod(size);
      if (side < 0.01 * std::sqrt(d2)) {
        const double exact = side * side * static_cast<double>(-P.z) / (d2 * std::sqrt(d2));
        EXPECT_NEAR(sum / 500 / exact, 1, 2e-3) << size << " " << P.x;
      }
    }
  }
}

TEST(Portal, GrazingWindowIsStillSampledUniformly) {
  // Almost in the plane, beside a long and narrow window.
  const auto portal = Build("portal", "\"float width\" 10 \"float height\" 0.01");
  const Window window = PlacedWindow(10, 0.01, Transform());
  const Point3 P(6, 0.002f, -0.003f);
  const Vector3d n(-1, 0, 0);
  const double expected =
      Integrate(window, Point3d(P), 2000, [&](const Vector3d& w) { return std::max(glm::dot(w, n), 0.0); });
  ExpectIrradiance(SampledIrradiance(*portal, P, Normal3(n)), expected, 2e-3);
}

TEST(Portal, EstimatesCutSegmentsAtThePlane) {
  const auto portal = Build("portal", "");
  const auto through = portal->light->GetIncidentRadianceEstimate(portal->context, {0, 0, -5}, {0, 0, 1}, 10);
  ASSERT_TRUE(through);
  EXPECT_NEAR(through->minT, 0, 1e-6f);
  EXPECT_NEAR(through->maxT, 5, 0.02f);
  EXPECT_FALSE(portal->light->GetIncidentRadianceEstimate(portal->context, {0, 0, 1}, {0, 0, 1}, 10));
  EXPECT_EQ(portal->light->GetIncidentRadianceEstimate(portal->context, {0, 0, 3}), 0);
}

// --- images

class PortalImages : public test::SkyImageTest {
 protected:
  void SetUp() override {
    SkyImageTest::SetUp();
    Rng rng(7);
    const auto noise = [&](int) { return rng.NextFloat() < 0.2f ? 0.0f : 0.1f + 3 * Sqr(rng.NextFloat()); };
    Write("latlong.exr", 16, 8, noise);
    Write("square.exr", 8, 8, noise);
    Write("bright.exr", 64, 32, [](int i) {
      return i == 840 ? 1e6f : i == 3 ? std::numeric_limits<float>::quiet_NaN() : i == 9 ? -1.0f : 0.5f;
    });
    Write("black.exr", 16, 8, [](int) { return 0.0f; });
  }
};

const char* const kImages[] = {"latlong.exr", "square.exr"};

TEST_F(PortalImages, IrradianceIsThatOfTheDomeThroughTheWindow) {
  for (const char* image : kImages) {
    const std::string file = std::string(" \"string texture:file\" \"") + image + "\"";
    const auto dome = Make("dome", file);  // stands in world space, as the portal's sky does
    const std::vector<Transform> placements = Placements();
    for (const Transform& placement : placements) {
      const auto portal = Make("portal", "\"float width\" 2 \"float height\" 1.5" + file, placement);
      const Window window = PlacedWindow(2, 1.5, placement);
      for (const Point3d& local : kReceivers) {
        const Point3d P(Point3(placement.Point(local)));
        const Vector3d n = glm::normalize(window.At(0.5, 0.5) - P);
        const double expected = Integrate(window, P, 500, [&](const Vector3d& w) {
          const Color seen = dome->light->EvaluateEmissionForCamera(dome->context, Escape(Point3(P), Vector3(w)));
          return static_cast<double>(seen.g) * std::max(glm::dot(w, n), 0.0);
        });
        ExpectIrradiance(SampledIrradiance(*portal, Point3(P), Normal3(n)), expected, 5e-3,
                         std::string(image) + " at " + std::to_string(local.x) + ", placement " +
                             std::to_string(&placement - placements.data()));
      }
    }
  }
}

TEST_F(PortalImages, SamplesFollowTheDensity) {
  constexpr int kCells = 12, kSamples = 40000;
  for (const char* image : kImages) {
    const std::string file = std::string(" \"string texture:file\" \"") + image + "\"";
    for (const Transform& placement : Placements()) {
      const auto portal = Make("portal", "\"float width\" 2 \"float height\" 1.5" + file, placement);
      const Window window = PlacedWindow(2, 1.5, placement);
      const Point3 P(placement.Point(kReceivers[1]));
      const auto density = [&](const Vector3d& w) {
        const auto e = portal->light->EvaluateSamples(portal->context, Escape(P, Vector3(w)), P);
        return e->diffuse.IsBlack() ? 0.0 : static_cast<double>(e->pdfDirect.value);
      };
      std::vector<double> expected, observed(kCells * kCells + 1, 0.0);
      double total = 0;
      for (int i = 0; i < kCells * kCells; ++i) {
        const double u = i % kCells, v = i / kCells;
        expected.push_back(kSamples * Integrate(window, Point3d(P), 40, density, u / kCells, (u + 1) / kCells,
                                                v / kCells, (v + 1) / kCells));
        total += expected.back();
      }
      ASSERT_LT(total, kSamples * 1.01) << image;
      expected.push_back(std::max(kSamples - total, 0.0));
      Rng rng(6);
      for (int i = 0; i < kSamples; ++i) {
        portal->context.u = rng.NextPoint2();
        const auto sample = portal->light->GenerateSamples(portal->context, P);
        if (!sample) {
          ++observed.back();
          continue;
        }
        // Evaluated as another technique would find it, it is the same.
        const auto e = portal->light->EvaluateSamples(portal->context, Escape(P, sample->direction), P);
        ASSERT_EQ(e->pdfDirect, sample->pdfDirect);
        ASSERT_EQ(e->diffuse, sample->diffuse);
        ASSERT_EQ(e->pdfEmit, sample->pdfEmit);
        ASSERT_EQ(e->pdfEmitDirection, sample->pdfEmitDirection);
        const Vector3d w(sample->direction), normal = window.Product();
        const Vector3d at =
            Point3d(P) + w * (glm::dot(window.corner - Point3d(P), normal) / glm::dot(w, normal)) - window.corner;
        const double u = glm::dot(glm::cross(at, window.edgeY), normal) / glm::dot(normal, normal);
        const double v = glm::dot(glm::cross(window.edgeX, at), normal) / glm::dot(normal, normal);
        ASSERT_TRUE(u > -1e-6 && u < 1 + 1e-6 && v > -1e-6 && v < 1 + 1e-6);
        const auto cell = [](double x) { return std::clamp(static_cast<int>(x * kCells), 0, kCells - 1); };
        ++observed[static_cast<size_t>(cell(v) * kCells + cell(u))];
      }
      // The middle rule on cells that a texel's edge cuts is off by a few per mille of 40000: they are allowed for by
      // judging at a share of the samples.
      for (double& count : observed) count /= 8;
      for (double& count : expected) count /= 8;
      EXPECT_GT(testing::ChiSquaredPValue(observed, expected), 1e-4) << image;
    }
  }
}

// Photons land where next-event estimation says that light arrives: their flux through small disks is the irradiance.
TEST_F(PortalImages, PhotonsBringTheIrradiance) {
  for (const char* image : {"", "latlong.exr", "square.exr"}) {
    const std::string file = *image ? std::string(" \"string texture:file\" \"") + image + "\"" : "";
    for (const Transform& placement : Placements()) {
      auto portal = Make("portal", "\"float width\" 2 \"float height\" 1.5" + file, placement);
      const Window window = PlacedWindow(2, 1.5, placement);
      const Vector3d inwards = -glm::normalize(window.Product());
      // A disk behind the window's middle, facing it, and one to its side.
      const Point3d middle = window.At(0.5, 0.5) + 0.8 * inwards;
      portal->context.scene = {Point3(middle), 6};
      constexpr double kRadius = 0.6;
      Rng rng(11);
      double landed = 0, landedSquares = 0, power = 0;
      constexpr int kPhotons = 200000;
      for (int i = 0; i < kPhotons; ++i) {
        portal->context.u = rng.NextPoint2();
        portal->context.uDirection = rng.NextPoint2();
        const auto photon = portal->light->GenerateEmission(portal->context);
        if (!photon) continue;
        const Vector3d d(photon->direction), start(photon->position);
        ASSERT_NEAR(glm::dot(start - middle, -d), 6, 1e-4);
        const double flux =
            static_cast<double>(photon->diffuse.g) /
            (static_cast<double>(photon->pdfEmit.value) * static_cast<double>(photon->pdfEmitDirection.value));
        power += flux;
        const Point3d at = start + d * (glm::dot(middle - start, inwards) / glm::dot(d, inwards));
        if (glm::length(at - middle) < kRadius) landed += flux, landedSquares += flux * flux;
        // The same edge, as EvaluateSamples reports it from behind the window.
        if (i % 50 == 0 && glm::length(at - middle) < kRadius) {
          const Point3 P(at);
          const auto e = portal->light->EvaluateSamples(portal->context, Escape(P, -photon->direction), P);
          if (e->pdfEmit.IsZero()) continue;  // it went through the very edge
          ASSERT_EQ(e->pdfEmit, photon->pdfEmit);
          ASSERT_EQ(e->pdfEmitDirection, photon->pdfEmitDirection);
        }
      }
      // Mean irradiance over the disk.
      double expected = 0;
      Rng where(3);
      constexpr int kPoints = 4000;
      const Vector3d x = glm::normalize(window.edgeX), y = glm::cross(inwards, x);
      for (int i = 0; i < kPoints; ++i) {
        const double r = kRadius * std::sqrt((i + 0.5) / kPoints), phi = 2.399963 * i;
        const Point3 P(middle + r * (std::cos(phi) * x + std::sin(phi) * y));
        portal->context.u = where.NextPoint2();
        for (int j = 0; j < 8; ++j) {
          portal->context.u = where.NextPoint2();
          const auto sample = portal->light->GenerateSamples(portal->context, P);
          if (!sample) continue;
          expected += static_cast<double>(sample->diffuse.g) *
                      std::max(glm::dot(Vector3d(sample->direction), -inwards), 0.0) /
                      static_cast<double>(sample->pdfDirect.value);
        }
      }
      expected *= kPiDouble * kRadius * kRadius / (kPoints * 8);
      const double error = std::sqrt(landedSquares) / kPhotons;
      EXPECT_NEAR(landed / kPhotons, expected, 5 * error + 0.01 * expected) << image;
      EXPECT_NEAR(power / kPhotons / static_cast<double>(portal->light->GetPowerEstimate(portal->context).g), 1, 0.01)
          << image;
    }
  }
}

TEST_F(PortalImages, TheSkyDoesNotTurnWithThePortal) {
  const std::string file = " \"string texture:file\" \"latlong.exr\"";
  const auto dome = Make("dome", file);
  for (const double degrees : {0.0, 90.0, 180.0, 270.0}) {
    const Transform placement = Transform::Rotate(degrees, {1, 0, 0});
    const auto portal = Make("portal", file, placement);
    const Point3 P(placement.Point({0.1, 0.2, -1}));
    const Vector3 direction(glm::normalize(placement.Vector({0.05, -0.1, 1})));
    EXPECT_EQ(portal->light->EvaluateEmissionForCamera(portal->context, Escape(P, direction)),
              dome->light->EvaluateEmissionForCamera(dome->context, Escape(P, direction)));
  }
}

TEST_F(PortalImages, MovedDuringTheShutter) {
  // Placed elsewhere than it was made for: turned, and only moved.
  const std::string file = "\"string texture:file\" \"latlong.exr\"";
  const auto dome = Make("dome", file);
  const auto portal = Make("portal", file);
  for (const Transform& moved : {Transform::Translate({1, 2, 3}), Transform::Rotate(70, {1, 1, 0})}) {
    const LightTransform now{moved.ToAffine(), moved.Inverse().ToAffine()};
    portal->context.transform = &now;
    const Window window = PlacedWindow(1, 1, moved);
    const Point3d P(Point3(moved.Point({0.1, 0.3, -0.4})));
    const Vector3d n = glm::normalize(window.At(0.5, 0.5) - P);
    const double expected = Integrate(window, P, 600, [&](const Vector3d& w) {
      const Color seen = dome->light->EvaluateEmissionForCamera(dome->context, Escape(Point3(P), Vector3(w)));
      return static_cast<double>(seen.g) * std::max(glm::dot(w, n), 0.0);
    });
    ExpectIrradiance(SampledIrradiance(*portal, Point3(P), Normal3(n)), expected, 5e-3);
    EXPECT_TRUE(portal->light->GenerateEmission(portal->context));
    EXPECT_GT(portal->light->GetPowerEstimate(portal->context).g, 0);
  }
}

TEST_F(PortalImages, OneBrightTexelIsFound) {
  const auto portal = Make("portal", "\"string texture:file\" \"bright.exr\" \"float width\" 40 \"float height\" 40",
                           Transform::Rotate(-90, {1, 0, 0}));  // the sky above
  const Point3 P(1, -1, 2);
  // Texel 840 of 64 × 32 is column 8 of row 13; its 1e6 on a floor, ∫ cosθ dω exactly; the rest is 0.5 · π or less.
  const double low = 13 * kPiDouble / 32, high = 14 * kPiDouble / 32;
  const double texel = 1e6 * 2 * kPiDouble / 64 * 0.5 * (std::pow(std::sin(high), 2) - std::pow(std::sin(low), 2));
  const Estimate estimate = SampledIrradiance(*portal, P, Normal3(0, 1, 0));
  EXPECT_LT(estimate.error, 0.01 * texel);
  EXPECT_NEAR(estimate.mean, texel, 4.5 * estimate.error + 2);
  Rng rng(4);
  int bright = 0;
  for (int i = 0; i < 4000; ++i) {
    portal->context.u = rng.NextPoint2();
    const auto sample = portal->light->GenerateSamples(portal->context, P);
    if (!sample) continue;
    // Nothing that shines so brightly is found by chance: its weight stays near the texel's 1e6 · 9.6e-3 sr.
    EXPECT_LT(sample->diffuse.g / sample->pdfDirect.value, 20 * 9600.0f);
    bright += sample->diffuse.g > 1 ? 1 : 0;
  }
  EXPECT_GT(bright, 1200);
}

TEST_F(PortalImages, BlackSky) {
  const auto portal = Make("portal", "\"string texture:file\" \"black.exr\"");
  EXPECT_FALSE(portal->light->GenerateSamples(portal->context, Point3(0, 0, -1)));
  EXPECT_FALSE(portal->light->GenerateEmission(portal->context));
  EXPECT_TRUE(portal->light->GetPowerEstimate(portal->context).IsBlack());
  EXPECT_FALSE(portal->light->GetIncidentRadianceEstimate(portal->context, {0, 0, -5}, {0, 0, 1}, 10));
}

// --- pbrt-v4's: "infinite" with a portal

TEST_F(PortalImages, InfiniteTakesFourCornersInWorldSpace) {
  // The sky where (p3 - p0) × (p1 - p0) points to: +z here. The light's transform turns the sky and not the corners.
  const std::string portal =
      " \"point3 portal\" [ -1 -0.5 0  -1 0.5 0  1 0.5 0  1 -0.5 0 ] \"string filename\" \"square.exr\"";
  const Transform turned = Transform::Rotate(40, {0, 1, 0});
  const auto sky = Make("infinite", "\"string filename\" \"square.exr\"", turned);
  const auto window = Make("infinite", portal, turned);
  const Point3 P(0.2f, 0.1f, -0.7f);
  for (const Vector3& way : {Vector3(0, 0, 1), Vector3(0.7f, -0.5f, 0.7f), Vector3(-1.1f, 0.3f, 0.7f)}) {
    const LightHit hit = Escape(P, glm::normalize(way));
    EXPECT_EQ(window->light->EvaluateEmissionForCamera(window->context, hit),
              sky->light->EvaluateEmissionForCamera(sky->context, hit));
  }
  for (const Vector3& way : {Vector3(0, 0, -1), Vector3(0.9f, 0, 0.7f), Vector3(0, 0.5f, 0.7f)}) {
    EXPECT_TRUE(window->light->EvaluateEmissionForCamera(window->context, Escape(P, glm::normalize(way))).IsBlack());
  }
  const Window shape{{-1, -0.5, 0}, {2, 0, 0}, {0, 1, 0}};
  const double expected = Integrate(shape, Point3d(P), 1000, [&](const Vector3d& w) {
    const Color seen = sky->light->EvaluateEmissionForCamera(sky->context, Escape(P, Vector3(w)));
    return static_cast<double>(seen.g) * std::max(w.z, 0.0);
  });
  ExpectIrradiance(SampledIrradiance(*window, P, Normal3(0, 0, 1)), expected, 5e-3);
  // The other way around: the sky on the other side.
  const auto reversed = Make("infinite",
                             "\"point3 portal\" [ -1 0.5 0  -1 -0.5 0  1 -0.5 0  1 0.5 0 ] \"string filename\" "
                             "\"square.exr\"",
                             turned);
  EXPECT_TRUE(reversed->light->EvaluateEmissionForCamera(reversed->context, Escape(P, {0, 0, 1})).IsBlack());
  EXPECT_FALSE(reversed->light->GenerateSamples(reversed->context, P));
}

TEST_F(PortalImages, InfiniteWithAnEvenSky) {
  const auto window =
      Make("infinite", "\"rgb L\" [ 2 3 4 ] \"point3 portal\" [ -0.5 -0.5 0  -0.5 0.5 0  0.5 0.5 0  0.5 -0.5 0 ]");
  const auto portal = Make("portal", "\"rgb color\" [ 2 3 4 ]");
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    window->context.u = portal->context.u = rng.NextPoint2();
    const auto a = window->light->GenerateSamples(window->context, {0.3f, 1, -2});
    const auto b = portal->light->GenerateSamples(portal->context, {0.3f, 1, -2});
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->direction, b->direction);
    EXPECT_EQ(a->diffuse, b->diffuse);
    EXPECT_EQ(a->pdfDirect, b->pdfDirect);
  }
}

TEST_F(PortalImages, WhatIsNoRectangleIsSaid) {
  const auto error = [&](const std::string& corners) {
    return ErrorOf("infinite", "\"string filename\" \"square.exr\" \"point3 portal\" [ " + corners + " ]");
  };
  EXPECT_NE(error("0 0 0  1 0 0  1 1 0").find("4 corners"), std::string::npos);
  EXPECT_NE(error("0 0 0  1 0 0  1.5 1 0  0 1 0").find("not a rectangle"), std::string::npos);
  EXPECT_NE(error("0 0 0  1 0 0  1.5 1 0  0.5 1 0").find("not a rectangle"), std::string::npos);
  EXPECT_NE(error("0 0 0  1 1 0  1 0 0  0 1 0").find("not a rectangle"), std::string::npos);
  EXPECT_NE(error("0 0 0  1 0 0  1 1 0.5  0 1 0").find("not a rectangle"), std::string::npos);
  EXPECT_NE(error("0 0 0  0 0 0  1 1 0  0 1 0").find("same point"), std::string::npos);
  // The tolerance of pbrt-v4: a thousandth.
  EXPECT_EQ(error("0 0 0  1 0 0  1.0004 1 0  0 1 0"), "");
}

}  // namespace
}  // namespace lampyr
