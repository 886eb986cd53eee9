// Lenses of spherical surfaces, and the camera that has one: against the formulas of thin lenses, against straight
// lines where nothing refracts, and backwards.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "camera/camera.h"
#include "camera/exit_pupil.h"
#include "sampling/rng.h"
#include "sampling/sampler.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

// Two thin lenses of glass around a stop.
constexpr const char* kDoublet = "60 3 1.6 24\n -60 4 1 24\n 0 4 0 14\n 60 3 1.6 24\n -60 20 1 24\n";
constexpr const char* kThinLens = "0 0 0 2\n 100 0.01 1.5 2\n -100 90 1 2\n";  // focal length 100 mm
constexpr const char* kStopAlone = "0 20 0 100\n";
// No glass: a ring 25 mm before the film, and the stop 20 mm farther away.
constexpr const char* kBarrel = "0 20 0 12\n 1e9 25 1 10\n";

LensPrescription Lens(const char* text) {
  return ParseLensFile(text, "lens.dat");
}
double StopRadius(const LensPrescription& lens) {
  return lens.Stop().apertureRadius;
}

CameraFrame Frame(int width = 60, int height = 40) {
  CameraFrame frame;
  frame.width = width;
  frame.height = height;
  SetDefaultScreenWindow(frame, static_cast<float>(width) / static_cast<float>(height));
  return frame;
}
std::unique_ptr<Camera> MakeCamera(const char* lens, double apertureDiameter, double focus, double diagonal = 35,
                                   const CameraFrame& frame = Frame(), Aperture aperture = {}) {
  return MakeRealisticCamera(frame, {Lens(lens), apertureDiameter, focus, diagonal, std::move(aperture)});
}

struct Mean {
  double mean = 0, error = 0;  // standard error of independent samples, which those of Sobol stay below
};
template <class Value>
Mean MeanOver(uint32_t count, int seed, const Value& value) {
  Sampler sampler(SamplerKind::Sobol, static_cast<uint64_t>(seed));
  double sum = 0, squares = 0;
  for (uint32_t i = 0; i < count; ++i) {
    sampler.StartPixelSample(0, 0, i);
    const double v = value(sampler);
    sum += v;
    squares += v * v;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}
// The value of a pixel of the camera under a sky of radiance 1, at a film point.
Mean WeightAt(const Camera& camera, const Point2& film, uint32_t count = 1u << 16) {
  return MeanOver(count, 1, [&](Sampler& sampler) {
    return static_cast<double>(camera.GenerateRay(film, sampler.Get2D(), 0).weight);
  });
}

// Where a ray from the film crosses the plane z = `distance` (mm).
Point2d At(const LensSystem& lens, const Point2d& film, const Point2d& rear, double distance) {
  const Point3d from(film.x, film.y, 0), to(rear.x, rear.y, lens.RearZ());
  const auto passed = lens.Trace({from, glm::normalize(to - from)});
  EXPECT_TRUE(passed);
  if (!passed) return {};
  const LensRay& ray = passed->ray;
  return Point2d(ray.origin) + Point2d(ray.direction) * ((distance - ray.origin.z) / ray.direction.z);
}

TEST(Lens, AThinLensFocusesAndMagnifiesByItsFormula) {
  LensSystem lens(Lens(kThinLens), 1);
  const auto thick = lens.Approximation();
  ASSERT_TRUE(thick);
  // 1/f = (n - 1)(1/R1 - 1/R2 + (n - 1) t / (n R1 R2))
  const double f = 1 / (0.5 * (0.02 - 0.5 * 0.01 / (1.5 * 1e4)));
  EXPECT_NEAR(thick->focalLength, f, 1e-9 * f);
  for (const double both : {401.0, 500.0, 1000.0, 1e4, 1e6}) {
    lens.Focus(both);
    const double image = 0.5 * (both - std::sqrt(both * both - 400 * both)), object = both - image;
    EXPECT_NEAR(lens.RearZ(), image, 0.02 + 2e-4 * image) << both;
    // Paraxial rays of a point beside the axis meet, upside down, as much larger as they are farther away.
    for (const Point2d rear : {Point2d(0, 0), Point2d(0.3, 0), Point2d(0, -0.3), Point2d(-0.2, 0.2)}) {
      const Point2d hit = At(lens, {0.1, 0.05}, rear, both), expected = Point2d(-0.1, -0.05) * (object / image);
      EXPECT_LT(glm::length(hit - expected), 2e-3 * glm::length(expected) + 1e-4 * object / image) << both;
    }
  }
}

TEST(Lens, ThickLensesFollowTheirMatrix) {
  // A ball of index n: f = n R / (2 (n - 1)) from its middle, where both principal planes are.
  const LensSystem ball(Lens("0 0 0 2\n 10 20 1.5 4\n -10 10 1 4\n"), 1);
  const auto thick = ball.Approximation();
  ASSERT_TRUE(thick);
  EXPECT_NEAR(thick->focalLength, 15, 1e-12);
  EXPECT_NEAR(thick->frontPrincipal, 20, 1e-12);
  EXPECT_NEAR(thick->rearPrincipal, 20, 1e-12);
  // Nothing refracts: nothing to focus.
  LensSystem stop(Lens(kStopAlone), 1);
  EXPECT_FALSE(stop.Approximation());
  stop.Focus(10000);
  EXPECT_EQ(stop.RearZ(), 20);
}

// Where the lens is focused, a film point's rays come together; elsewhere they are as far apart as the pupil seen from
// there.
TEST(Lens, FocusMakesTheCircleOfConfusionSmall) {
  for (const char* text : {kDoublet, kThinLens}) {
    const double stop = 0.2;
    LensSystem lens(Lens(text), stop);
    const double distance = 2000;
    lens.Focus(distance);
    const ExitPupil pupil(lens, 1);
    const auto bounds = pupil.At(0);
    ASSERT_TRUE(bounds);
    const auto spread = [&](double z) {
      double largest = 0;
      for (int i = 0; i < 32; ++i) {
        const double angle = 2 * kPiDouble * i / 32, radius = 0.95 * bounds->yMax;
        const Point3d to(radius * std::cos(angle), radius * std::sin(angle), lens.RearZ());
        const auto passed = lens.Trace({Point3d(0.0), glm::normalize(to)});
        if (!passed) continue;
        const LensRay& ray = passed->ray;
        const Point2d hit = Point2d(ray.origin) + Point2d(ray.direction) * ((z - ray.origin.z) / ray.direction.z);
        largest = std::max(largest, glm::length(hit));
      }
      return largest;
    };
    const double blurred = spread(0.5 * distance);
    EXPECT_NEAR(blurred, 0.5 * stop, 0.1 * stop) << text;  // half of the pupil's radius
    EXPECT_LT(spread(distance), 0.06 * blurred) << text;
    EXPECT_LT(spread(distance), spread(0.9 * distance)) << text;
    EXPECT_LT(spread(distance), spread(1.1 * distance)) << text;
  }
}

// The lens turned around takes every ray back to where it came from.
TEST(Lens, RaysGoBackTheWayTheyCame) {
  const LensPrescription forward = Lens(kDoublet);
  LensPrescription backward;
  double length = 0;
  const size_t count = forward.surfaces.size();
  for (size_t i = count; i-- > 0;) {
    LensSurface surface = forward.surfaces[i];
    surface.curvatureRadius = surface.IsStop() ? 0 : -surface.curvatureRadius;
    surface.index = i > 0 ? forward.surfaces[i - 1].index : 1;
    surface.thickness = i > 0 ? forward.surfaces[i - 1].thickness : 500;
    length += i > 0 ? surface.thickness : 0;
    backward.surfaces.push_back(surface);
  }
  const LensSystem lens(forward, 7), turned(backward, 7);
  Rng rng(7);
  int passed = 0;
  for (int i = 0; i < 5000; ++i) {
    const Point2 u = rng.NextPoint2(), v = rng.NextPoint2();
    const Point3d from(20 * u.x - 10, 20 * u.y - 10, 0), to(24 * v.x - 12, 24 * v.y - 12, lens.RearZ());
    const Vector3d direction = glm::normalize(to - from);
    const auto there = lens.Trace({from, direction});
    if (!there) continue;
    ++passed;
    // Space is mirrored so that the ray comes back towards +z: the turned lens's rear vertex at 500 is the front one.
    const double front = lens.RearZ() + length;
    Point3d origin = there->ray.origin;
    origin.z = 500 + front - origin.z;
    const Vector3d way(-there->ray.direction.x, -there->ray.direction.y, there->ray.direction.z);
    const auto back = turned.Trace({origin - way * (origin.z / way.z), way});
    ASSERT_TRUE(back);
    const Vector3d end(-back->ray.direction.x, -back->ray.direction.y, back->ray.direction.z);
    EXPECT_LT(glm::length(end - direction), 1e-11);
    const double toFilm = (500 + front - back->ray.origin.z) / back->ray.direction.z;
    EXPECT_LT(glm::length(back->ray.origin + toFilm * back->ray.direction - Point3d(from.x, from.y, 500 + front)),
              1e-9);
  }
  EXPECT_GT(passed, 500);
}

// All that passes does so within the bounds, for stops of all sizes.
TEST(Lens, ExitPupilsHoldAllRaysThatPass) {
  for (const char* text : {kDoublet, kThinLens, kBarrel, kStopAlone}) {
    for (const double stop : {1.0, 0.1, 1e-2}) {
      const LensPrescription prescription = Lens(text);
      LensSystem lens(prescription, stop * StopRadius(prescription));
      lens.Focus(1500);
      const double filmRadius = 25;
      const ExitPupil pupil(lens, filmRadius);
      const double reach = lens.RearReach(filmRadius);
      Rng rng(3);
      int passed = 0, outside = 0;
      for (int i = 0; i < 400000; ++i) {
        const Point2 u = rng.NextPoint2();
        const double radius = filmRadius * static_cast<double>(rng.NextFloat());
        const double x = reach * (2 * static_cast<double>(u.x) - 1), y = reach * (2 * static_cast<double>(u.y) - 1);
        const Vector3d way(x - radius, y, lens.RearZ());
        if (!lens.Trace({{radius, 0, 0}, glm::normalize(way)})) continue;
        ++passed;
        const auto bounds = pupil.At(radius);
        outside += !bounds || x < bounds->xMin || x > bounds->xMax || std::abs(y) > bounds->yMax ? 1 : 0;
      }
      EXPECT_EQ(outside, 0) << text << " of " << passed;
      EXPECT_GT(passed, 400000 * 1e-3 * stop * stop) << text;
      // And they are not much larger: half of what is drawn on the axis passes (a disk has π/4 of its square).
      const auto middle = pupil.At(0);
      ASSERT_TRUE(middle);
      const Mean hit = MeanOver(4096, 2, [&](Sampler& sampler) {
        const Point2 u = sampler.Get2D();
        const double x = middle->xMin + static_cast<double>(u.x) * (middle->xMax - middle->xMin);
        const double y = middle->yMax * (2 * static_cast<double>(u.y) - 1);
        return lens.Trace({Point3d(0.0), glm::normalize(Vector3d(x, y, lens.RearZ()))}) ? 1.0 : 0.0;
      });
      EXPECT_GT(hit.mean, stop > 0.01 ? 0.5 : 0.05) << text << " " << stop;
    }
  }
}

// Behind a stop alone a constant sky is measured as π times the form factor of the stop's disk; for a small stop this
// is the law of cos⁴.
TEST(RealisticCamera, ASkyBehindAStopFollowsTheFormFactorOfADisk) {
  for (const double diameter : {0.01, 1.0, 30.0, 90.0}) {
    const auto camera = MakeCamera(kStopAlone, diameter, 10, 50);
    const double r = 0.5 * diameter, z = 20;
    for (const Point2 film : {Point2(30, 20), Point2(45, 20), Point2(3, 5), Point2(59.5f, 39.5f)}) {
      const double perPixel = 50 / std::hypot(60.0, 40.0);
      const double rho2 = perPixel * perPixel * static_cast<double>(Sqr(film.x - 30) + Sqr(film.y - 20)),
                   all = rho2 + z * z + r * r;
      const double expected = 0.5 * kPiDouble * (1 - (all - 2 * r * r) / std::sqrt(all * all - 4 * rho2 * r * r));
      const Mean measured = WeightAt(*camera, film);
      EXPECT_LT(measured.error, 0.01 * expected);
      EXPECT_NEAR(measured.mean, expected, 4 * measured.error) << diameter << " " << film.x;
      if (diameter > 0.5) continue;
      const double cosine2 = z * z / (z * z + rho2);
      EXPECT_NEAR(measured.mean, kPiDouble * r * r / (z * z) * cosine2 * cosine2, 0.02 * expected);
    }
  }
}

// A ring before the stop: what is measured is the part of the stop that a film point sees through the ring.
TEST(RealisticCamera, ARingVignettesWhatIsBesideTheAxis) {
  const auto camera = MakeCamera(kBarrel, 12, 10, 60);
  const double perPixel = 60 / std::hypot(60.0, 40.0);
  double before = 1;
  for (const float beside : {0.0f, 5.0f, 10.0f, 14.0f, 17.0f}) {
    const double x = perPixel * static_cast<double>(beside);
    const Mean expected = MeanOver(1u << 16, 5, [&](Sampler& sampler) {
      const Point2d onStop = 6.0 * Point2d(SampleConcentricDisk(sampler.Get2D()));
      const Vector3d way(onStop.x - x, onStop.y, 45);
      const Point2d onRing = Point2d(x, 0) + Point2d(way) * (25.0 / 45);
      if (glm::length(onRing) > 5) return 0.0;
      const double cosine2 = 45 * 45 / glm::dot(way, way);
      return kPiDouble * 36 / (45 * 45) * cosine2 * cosine2;
    });
    const Mean measured = WeightAt(*camera, {30 + beside, 20});
    EXPECT_NEAR(measured.mean, expected.mean, 4 * (measured.error + expected.error)) << beside;
    EXPECT_LT(measured.mean, before);
    before = measured.mean;
  }
  EXPECT_GT(before, 0);
  // Farther out there is nothing, and all rays are valid all the same.
  for (int i = 0; i < 100; ++i) {
    Rng rng(static_cast<uint64_t>(i));
    const CameraRay ray = camera->GenerateRay({59, 20}, rng.NextPoint2(), 0.5f);
    EXPECT_EQ(ray.weight, 0);
    EXPECT_TRUE(IsFinite(ray.ray.origin));
    EXPECT_NEAR(glm::length(ray.ray.direction), 1, 1e-6);
  }
}

// What glass does to a constant sky is the same as if all of the rear element were sampled, and on the axis π sin² of
// the cone of light.
TEST(RealisticCamera, ASkyIsMeasuredAsWithoutPupilBounds) {
  const auto camera = MakeCamera(kDoublet, 9, 2);
  LensSystem lens(Lens(kDoublet), 4.5);
  lens.Focus(2000);
  const double perPixel = 35 / std::hypot(60.0, 40.0);
  for (const float beside : {0.0f, 8.0f, 16.0f, 24.0f}) {
    const double x = perPixel * static_cast<double>(beside), reach = lens.RearReach(x);
    const Mean expected = MeanOver(1u << 18, 6, [&](Sampler& sampler) {
      const Point2d p = reach * (2.0 * Point2d(sampler.Get2D()) - 1.0);
      const Vector3d way = glm::normalize(Vector3d(p.x - x, p.y, lens.RearZ()));
      if (!lens.Trace({{x, 0, 0}, way})) return 0.0;
      return std::pow(way.z, 4) * 4 * reach * reach / (lens.RearZ() * lens.RearZ());
    });
    const Mean measured = WeightAt(*camera, {30 + beside, 20});
    EXPECT_GT(expected.mean, 0);
    EXPECT_NEAR(measured.mean, expected.mean, 4 * (measured.error + expected.error)) << beside;
  }
  double low = 0, high = lens.RearReach(0);
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (lens.Trace({Point3d(0.0), glm::normalize(Vector3d(middle, 0, lens.RearZ()))}) ? low : high) = middle;
  }
  const double sine2 = low * low / (low * low + lens.RearZ() * lens.RearZ());
  const Mean middle = WeightAt(*camera, {30, 20});
  EXPECT_NEAR(middle.mean, kPiDouble * sine2, 4 * middle.error);
}

TEST(RealisticCamera, TheImageIsTheRightWayUpAndTheSameRayIsTheSame) {
  CameraFrame frame = Frame();
  frame.cameraToRender = Transform::Translate({3, -2, 5}) * Transform::Rotate(50, {1, 2, 0.5});
  const auto camera = MakeCamera(kDoublet, 1, 5, 35, frame);
  const Transform toCamera = frame.cameraToRender.Inverse();
  LensSystem lens(Lens(kDoublet), 0.5);
  lens.Focus(5000);
  const double distance = lens.Approximation()->rearPrincipal, perPixel = 35 / std::hypot(60.0, 40.0);
  for (const Point2 film : {Point2(30, 20), Point2(10, 20), Point2(30, 5), Point2(50, 30)}) {
    const CameraRay ray = camera->GenerateRay(film, {0.5f, 0.5f}, 0.25f),
                    again = camera->GenerateRay(film, {0.5f, 0.5f}, 0.25f);
    EXPECT_EQ(ray.ray.direction, again.ray.direction);
    EXPECT_EQ(ray.ray.origin, again.ray.origin);
    EXPECT_EQ(ray.weight, again.weight);
    EXPECT_EQ(ray.ray.time, 0.25f);
    EXPECT_GT(ray.weight, 0);
    // Where the ray meets the plane of focus is what a pinhole there sees of it: x to the right, y up.
    const Point3d origin = toCamera.Point(Point3d(ray.ray.origin));
    const Vector3d way = toCamera.Vector(Vector3d(ray.ray.direction));
    EXPECT_GT(origin.z, 0.02);
    const Point3d hit = origin + way * ((5 - origin.z) / way.z);
    const double scale = (5 - 0.001 * lens.Approximation()->frontPrincipal) / distance * perPixel;
    EXPECT_NEAR(hit.x, static_cast<double>(film.x - 30) * scale, 0.03 + 0.05 * std::abs(hit.x)) << film.x;
    EXPECT_NEAR(hit.y, static_cast<double>(20 - film.y) * scale, 0.03 + 0.05 * std::abs(hit.y)) << film.y;
  }
}

TEST(RealisticCamera, HasNoDensitiesButFootprints) {
  const auto camera = MakeCamera(kDoublet, 1, 5);
  EXPECT_FALSE(camera->ConnectsLightPaths());
  EXPECT_FALSE(camera->HasPinhole());
  const auto along = [&](const Point2& film) {
    return Vector3d(camera->GenerateRay(film, {0.5f, 0.5f}, 0).ray.direction);
  };
  for (const Point2 film : {Point2(30, 20), Point2(40, 10)}) {
    const Ray ray = camera->GenerateRay(film, {0.5f, 0.5f}, 0).ray;
    EXPECT_FALSE(camera->EvaluateRay(ray, nullptr));
    EXPECT_FALSE(camera->Connect(ray.origin + 3.0f * ray.direction, {0.5f, 0.5f}));
    const Vector3d dx = 0.5 * (along(film + Point2(1, 0)) - along(film - Point2(1, 0))),
                   dy = 0.5 * (along(film + Point2(0, 1)) - along(film - Point2(0, 1)));
    EXPECT_NEAR(camera->PixelSolidAngle(ray) / glm::length(glm::cross(dx, dy)), 1, 0.1) << film.x;
  }
}

TEST(RealisticCamera, ExtremesAreFiniteOrRefused) {
  for (const double diagonal : {1e-9, 35.0, 1e12}) {
    for (const double aperture : {1e-4, 1.0, 1e9}) {
      for (const double focus : {0.2, 10.0, 1e9}) {
        const auto camera = MakeCamera(kDoublet, aperture, focus, diagonal);
        Rng rng(9);
        int lit = 0;
        for (int i = 0; i < 200; ++i) {
          const Point2 u = rng.NextPoint2();
          const CameraRay ray = camera->GenerateRay({70 * u.x - 5, 50 * u.y - 5}, rng.NextPoint2(), 0);
          ASSERT_TRUE(IsFinite(ray.ray.origin) && IsFinite(ray.ray.direction));
          ASSERT_NEAR(glm::length(ray.ray.direction), 1, 1e-6);
          ASSERT_TRUE(ray.weight >= 0 && ray.weight < 10);
          lit += ray.weight > 0 ? 1 : 0;
        }
        // A film as large as a town has next to nothing of the image circle.
        EXPECT_TRUE(lit > 0 || diagonal > 100) << diagonal << " " << aperture << " " << focus;
      }
    }
  }
  const auto error = [](const char* lens, double aperture, double focus, double diagonal) -> std::string {
    try {
      MakeCamera(lens, aperture, focus, diagonal);
    } catch (const Error& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_NE(error(kDoublet, 1, 0.05, 35).find("has to be at least"), std::string::npos);
  EXPECT_NE(error("0 1 0 9\n -50 1 1.5 9\n 50 30 1 9\n", 1, 10, 35).find("spreads light"), std::string::npos);
  EXPECT_NE(error("0 0 0 9\n", 1, 10, 35).find("touches the film"), std::string::npos);
  EXPECT_NE(error(kDoublet, 0, 10, 35).find("aperture"), std::string::npos);
  EXPECT_NE(error(kDoublet, 1, -10, 35).find("focus distance"), std::string::npos);
  EXPECT_NE(error(kDoublet, 1, 10, 0).find("diagonal"), std::string::npos);
  // The distance that the message asks for is enough.
  const std::string near = error(kDoublet, 1, 0.05, 35);
  const double least = std::stod(near.substr(near.find("at least") + 9));
  EXPECT_EQ(error(kDoublet, 1, 1.0001e-3 * least, 35), "none");
  EXPECT_NE(error(kDoublet, 1, 0.999e-3 * least, 35), "none");
}

TEST(Aperture, AllShapesPassAsMuchAsTheDisk) {
  ApertureImage image{5, 4, std::vector<float>(20, 0.0f)};
  for (const size_t texel : {6u, 7u, 8u, 11u, 12u}) image.values[texel] = 0.25f * static_cast<float>(texel);
  std::vector<std::pair<std::string, Aperture>> shapes = {{"disk", {}}, {"image", Aperture::OfImage(image)}};
  for (const std::string& name : Aperture::Names()) shapes.emplace_back(name, Aperture::Named(name));
  for (const auto& [name, shape] : shapes) {
    const Mean area = MeanOver(1u << 18, 4, [&, s = &shape](Sampler& sampler) {
      const Point2d p = 2.0 * Point2d(sampler.Get2D()) - 1.0;
      const double passed = s->Transmission(p);
      EXPECT_TRUE(passed >= 0 && (passed == 0 || glm::length(p) <= s->Extent())) << p.x << " " << p.y;
      return 4 * passed;
    });
    EXPECT_NEAR(area.mean, kPiDouble, 4 * area.error) << name;
    // A sky does not tell them apart.
    const auto camera = MakeCamera(kStopAlone, 0.5, 10, 35, Frame(), shape);
    const Mean measured = WeightAt(*camera, {30, 20}, 1u << 17);
    const double disk = kPiDouble * 0.0625 / 400;
    EXPECT_LT(measured.error, 0.02 * disk) << name;
    EXPECT_NEAR(measured.mean, disk, 4 * measured.error + 1e-3 * disk) << name;
  }
  EXPECT_THROW(Aperture::Named("pentagram"), Error);
  EXPECT_THROW(Aperture::OfImage({2, 1, {0.0f, -1.0f}}), Error);
  EXPECT_GT(Aperture::Named("pentagon").Transmission({0, -0.79}), 0);  // a corner points down
  EXPECT_EQ(Aperture::Named("pentagon").Transmission({0, 0.79}), 0);
  EXPECT_GT(Aperture::OfImage({1, 2, {1.0f, 0.0f}}).Transmission({0, 0.5}), 0);  // the first row is at the top
}

}  // namespace
}  // namespace lampyr
