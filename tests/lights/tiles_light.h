// A light that is its own surface, made of flat tiles, with faults to order: what the suite has to pass, and to catch.
//
// Local space. A tile emits on the side of its normal, or on both: radiance L · tint, in a cone around the normal if
// one is given, times a pattern over uv that samples follow. Positions are uniform over a tile's cell in local space,
// so that densities in render space are divided by the stretch.
#pragma once

#include <cmath>

#include "lights/direction_map.h"
#include "lights/light_base.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr::test {

enum class TileFault {
  None,
  NormalWrong,            // Intersect turns the normal
  UvMirrored,             // Intersect counts u from the other end
  HitTooFar,              // Intersect's distance is off
  StretchForgotten,       // densities are those of local space
  PdfOffByOnePercent,     // of direct sampling, everywhere
  CosineForgotten,        // the density of direct sampling lacks it, everywhere
  LeaksBehind,            // EvaluateSamples does not look at the side
  ZeroWhereItEmits,       // half of it is never sampled, and says so
  PhotonsWithoutTint,     // the photons' radiance lacks the tint
  AllPhotonsWithoutTint,  // and EvaluateSamples lacks it too, where densities of emission are wanted
  SpecularForgotten,      // EvaluateSamples leaves the specular multiplier out
  MultipliersSwapped,     // everywhere
  CameraSeesMultiplier,   // the camera's radiance is multiplied by `diffuse`
  PowerOffByTwo,          // GetPowerEstimate
  PhotonsUnevenly,        // positions of photons crowd at one side
  PhotonsUniform,         // directions of photons are uniform, their density is not
  EmitDensityOff,         // pdfEmit off by a hundredth, everywhere
  DirectionDensityOff,    // pdfEmitDirection off by a hundredth, everywhere
  BoundsTooSmall,         // GetBounds leaves a corner out
  EmissionBoundsTooSmall,
  EstimateIsZero,
  SegmentEndsEarly,
};

struct Tile {
  Point3 corner{0.0f};
  Vector3 a{0.0f}, b{0.0f};
  Normal3 Normal() const { return glm::normalize(glm::cross(a, b)); }
  float Area() const { return glm::length(glm::cross(a, b)); }
};

struct TilesSetup {
  std::vector<Tile> tiles;
  bool twoSided = false;
  float cosCone = 0;           // emits within this of the normal
  std::vector<float> pattern;  // radiance over 4×4 cells of each tile; empty: 1
  float diffuse = 1, specular = 1;
  TileFault fault = TileFault::None;
};

class TilesLight final : public Light, private IntersectableLight {
 public:
  explicit TilesLight(TilesSetup setup) : setup_(std::move(setup)) {
    for (const Tile& tile : setup_.tiles) {
      for (int cell = 0; cell < kCells; ++cell) {
        total_ += CellWeight(tile, cell);
        cumulative_.push_back(total_);
      }
    }
  }

  LightKind Kind() const override { return LightKind::Area; }
  const LightSettings& Settings() const override { return settings_; }
  const IntersectableLight* Surface() const override { return this; }

  float GetIncidentRadianceEstimate(const LightContext&, const Point3&) const override {
    return Is(TileFault::EstimateIsZero) ? 0.0f : 1.0f;
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext&, const Point3&, const Vector3&,
                                                             float length) const override {
    return SegmentEstimate{1, 0, Is(TileFault::SegmentEndsEarly) ? 0.3f * length : length};
  }

  Color GetPowerEstimate(const LightContext& context) const override {
    double power = 0;
    for (const Tile& tile : setup_.tiles) {
      const double stretch = static_cast<double>(Stretch(context, tile.Normal()));
      for (int cell = 0; cell < kCells; ++cell) power += static_cast<double>(CellWeight(tile, cell)) * stretch;
    }
    const double solidAngle = static_cast<double>(kPi * (1 - Sqr(setup_.cosCone)));
    const double sides = setup_.twoSided ? 2 : 1, fault = Is(TileFault::PowerOffByTwo) ? 2 : 1;
    return kTint * static_cast<float>(power * solidAngle * sides * fault);
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    EmissionBounds bounds;
    for (const Point3& corner : Corners()) bounds.box.Add(context.transform->toRender.Point(corner));
    if (Is(TileFault::EmissionBoundsTooSmall)) bounds.box.max = bounds.box.Center();
    bounds.twoSided = setup_.twoSided;
    bounds.energy = GetPowerEstimate(context).Average();
    return bounds;
  }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override;
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override;
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override;
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    const Color emitted = Radiance(context, hit.uv, hit.normal, -hit.direction);
    return emitted * (Is(TileFault::CameraSeesMultiplier) ? setup_.diffuse : 1.0f);
  }
  std::unique_ptr<Light> Edit(const ParameterList&, const LightBuildContext&) const override {
    return std::make_unique<TilesLight>(setup_);
  }

 private:
  static constexpr int kSide = 4, kCells = kSide * kSide;
  static inline const Color kTint{0.9f, 0.6f, 0.3f};

  bool Is(TileFault fault) const { return setup_.fault == fault; }
  std::vector<Point3> Corners() const;
  std::vector<Point3> GetBounds() const override {
    std::vector<Point3> points = Corners();
    if (Is(TileFault::BoundsTooSmall)) {
      for (Point3& p : points) p *= 0.7f;
    }
    return points;
  }
  std::optional<LocalHit> Intersect(const LocalRay& ray) const override;

  float Pattern(int cell) const { return setup_.pattern.empty() ? 1.0f : setup_.pattern[static_cast<size_t>(cell)]; }
  float CellWeight(const Tile& tile, int cell) const { return tile.Area() / kCells * Pattern(cell); }
  static int CellOf(const Point2& uv) {
    const auto index = [](float x) { return std::clamp(static_cast<int>(x * kSide), 0, kSide - 1); };
    return index(uv.y) * kSide + index(uv.x);
  }
  static float Stretch(const LightContext& context, const Normal3& localNormal) {
    return std::abs(glm::determinant(context.transform->toRender.linear)) *
           glm::length(context.transform->toLocal.NormalByInverse(localNormal));
  }
  Normal3 ToRender(const LightContext& context, const Normal3& localNormal) const {
    return glm::normalize(context.transform->toLocal.NormalByInverse(localNormal));
  }

  struct Chosen {
    const Tile* tile;
    Point2 uv;
  };
  Chosen Choose(Point2 u) const;
  // 1/m² in render space.
  PdfArea Density(const LightContext& context, const Point2& uv, const Normal3& normal) const {
    // |M⁻ᵀ n| of the local normal is 1 over |Mᵀ n| of the one in render space.
    const Normal3 local = glm::normalize(context.transform->toRender.NormalByInverse(normal));
    const float stretch = Is(TileFault::StretchForgotten) ? 1.0f : Stretch(context, local);
    return PdfArea(Pattern(CellOf(uv)) / (total_ * stretch) * (Is(TileFault::EmitDensityOff) ? 1.01f : 1.0f));
  }
  PdfSolidAngle DirectDensity(const LightContext& context, const LightHit& hit) const;
  PdfSolidAngle DirectionDensity(float cosine) const {
    if (setup_.twoSided) cosine = std::abs(cosine);
    if (!(cosine > setup_.cosCone)) return PdfSolidAngle(0);
    const float off = Is(TileFault::DirectionDensityOff) ? 1.01f : 1.0f;
    return PdfSolidAngle(off * cosine * kInvPi / (1 - Sqr(setup_.cosCone)) * (setup_.twoSided ? 0.5f : 1.0f));
  }
  Color Radiance(const LightContext&, const Point2& uv, const Normal3& normal, const Vector3& outward) const {
    float cosine = glm::dot(normal, outward);
    if (setup_.twoSided) cosine = std::abs(cosine);
    return cosine > setup_.cosCone ? kTint * Pattern(CellOf(uv)) : Color(0.0f);
  }
  template <class Result>
  void Split(const Color& emitted, Result& result) const {
    const bool swapped = Is(TileFault::MultipliersSwapped);
    result.diffuse = emitted * (swapped ? setup_.specular : setup_.diffuse);
    result.specular = emitted * (swapped ? setup_.diffuse : setup_.specular);
  }

  TilesSetup setup_;
  LightSettings settings_;
  float total_ = 0;
  std::vector<float> cumulative_;
};

// Rounding error of a position on a tile: a few roundings of the terms of its sum.
inline Vector3 RoundingAt(const LightContext& context, const Point3& position) {
  const Vector3& translation = context.transform->toRender.translation;
  return 1e-6f * (glm::abs(position) + 2.0f * glm::abs(translation) + Vector3(1.0f));
}

inline std::vector<Point3> TilesLight::Corners() const {
  std::vector<Point3> points;
  for (const Tile& tile : setup_.tiles) {
    for (int i = 0; i < 4; ++i) {
      points.push_back(tile.corner + (i & 1 ? tile.a : Vector3(0.0f)) + (i & 2 ? tile.b : Vector3(0.0f)));
    }
  }
  return points;
}

inline TilesLight::Chosen TilesLight::Choose(Point2 u) const {
  const float target = u.x * total_;
  size_t index = 0;
  while (index + 1 < cumulative_.size() && cumulative_[index] <= target) ++index;
  const float below = index > 0 ? cumulative_[index - 1] : 0.0f;
  const float within = std::clamp((target - below) / (cumulative_[index] - below), 0.0f, 0.999999f);
  const int cell = static_cast<int>(index) % kCells;
  const Point2 uv((static_cast<float>(cell % kSide) + within) / kSide,
                  (static_cast<float>(cell / kSide) + u.y) / kSide);
  return {&setup_.tiles[index / kCells], uv};
}

inline std::optional<LocalHit> TilesLight::Intersect(const LocalRay& ray) const {
  std::optional<LocalHit> nearest;
  for (const Tile& tile : setup_.tiles) {
    const Vector3d a(tile.a), b(tile.b), cross = glm::cross(a, b), n = glm::normalize(cross);
    const double along = glm::dot(ray.direction, n);
    if (along == 0) continue;
    const double t = glm::dot(Point3d(tile.corner) - ray.origin, n) / along;
    if (!(t > ray.tMin && t <= ray.tMax) || (nearest && nearest->t <= t)) continue;
    const Vector3d x = ray.origin + t * ray.direction - Point3d(tile.corner);
    const double squared = glm::dot(cross, cross);
    const double u = glm::dot(glm::cross(x, b), cross) / squared, v = glm::dot(glm::cross(a, x), cross) / squared;
    if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) continue;
    LocalHit hit;
    hit.t = Is(TileFault::HitTooFar) ? 1.02 * t : t;
    hit.position = Point3d(tile.corner) + u * a + v * b;
    hit.normal = Is(TileFault::NormalWrong) ? glm::normalize(n + 0.3 * glm::normalize(a)) : n;
    hit.uv = Point2(Is(TileFault::UvMirrored) ? 1 - u : u, v);
    nearest = hit;
  }
  return nearest;
}

inline PdfSolidAngle TilesLight::DirectDensity(const LightContext& context, const LightHit& hit) const {
  const float cosine = std::abs(glm::dot(hit.normal, hit.direction));
  if (Is(TileFault::ZeroWhereItEmits) && hit.uv.x < 0.5f) return PdfSolidAngle(0);
  const float seen = Is(TileFault::CosineForgotten) ? 1.0f : cosine;
  const PdfSolidAngle pdf = ToSolidAngle(Density(context, hit.uv, hit.normal), Sqr(hit.distance), seen);
  return Is(TileFault::PdfOffByOnePercent) ? pdf * 1.01f : pdf;
}

inline std::optional<LightSample> TilesLight::GenerateSamples(const LightContext& context, const Point3& P) const {
  const Chosen chosen = Choose(context.u);
  std::optional<LightSample> sample(std::in_place);
  sample->position = context.transform->toRender.Point(chosen.tile->corner + chosen.uv.x * chosen.tile->a +
                                                       chosen.uv.y * chosen.tile->b);
  const Vector3 way = sample->position - P;
  sample->distance = glm::length(way);
  sample->direction = way / sample->distance;
  sample->normal = ToRender(context, chosen.tile->Normal());
  sample->positionError = RoundingAt(context, sample->position);
  sample->uvw = Point3(chosen.uv, 0.0f);
  const Color emitted = Radiance(context, chosen.uv, sample->normal, -sample->direction);
  LightHit hit;
  hit.direction = sample->direction;
  hit.distance = sample->distance;
  hit.normal = sample->normal;
  hit.uv = chosen.uv;
  sample->pdfDirect = DirectDensity(context, hit);
  Split(emitted, *sample);
  if (emitted.IsBlack() || sample->pdfDirect.IsZero()) return std::nullopt;
  const float cosine = -glm::dot(sample->normal, sample->direction);
  sample->pdfEmit = Density(context, chosen.uv, sample->normal);
  sample->pdfEmitDirection = DirectionDensity(cosine);
  sample->solidAngleToArea = std::abs(cosine) / Sqr(sample->distance);
  return sample;
}

inline std::optional<LightEvaluation> TilesLight::EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                                  const Point3&) const {
  const float cosine = -glm::dot(hit.normal, hit.direction);
  const float side = Is(TileFault::LeaksBehind) ? std::abs(cosine) : cosine;
  Color emitted = Radiance(context, hit.uv, side == cosine ? hit.normal : -hit.normal, -hit.direction);
  if (emitted.IsBlack()) return std::nullopt;
  if (Is(TileFault::AllPhotonsWithoutTint) && context.bidirectional) emitted = Color(Pattern(CellOf(hit.uv)));
  std::optional<LightEvaluation> evaluation(std::in_place);
  evaluation->normal = hit.normal;
  Split(emitted, *evaluation);
  if (Is(TileFault::SpecularForgotten)) evaluation->specular = emitted;
  evaluation->pdfDirect = DirectDensity(context, hit);
  evaluation->pdfEmit = Density(context, hit.uv, hit.normal);
  evaluation->pdfEmitDirection = DirectionDensity(side);
  evaluation->solidAngleToArea = std::abs(cosine) / Sqr(hit.distance);
  return evaluation;
}

inline std::optional<EmissionSample> TilesLight::GenerateEmission(const LightContext& context) const {
  Point2 u = context.u;
  if (Is(TileFault::PhotonsUnevenly)) u.x = std::pow(u.x, 1.2f);
  const Chosen chosen = Choose(u);
  EmissionSample photon;
  photon.position = context.transform->toRender.Point(chosen.tile->corner + chosen.uv.x * chosen.tile->a +
                                                      chosen.uv.y * chosen.tile->b);
  photon.positionError = RoundingAt(context, photon.position);
  photon.normal = ToRender(context, chosen.tile->Normal());
  photon.uvw = Point3(chosen.uv, 0.0f);
  float turns = context.uDirection.y;
  bool backwards = false;
  if (setup_.twoSided) {
    backwards = turns >= 0.5f;
    turns = 2 * turns - (backwards ? 1.0f : 0.0f);
  }
  // sin² uniform up to the cone: the cosine law within it.
  const float sine2 = context.uDirection.x * (1 - Sqr(setup_.cosCone));
  const float cosine = Is(TileFault::PhotonsUniform) ? 1 - context.uDirection.x * (1 - setup_.cosCone)
                                                     : std::sqrt(std::max(1 - sine2, 0.0f));
  const float sine = std::sqrt(std::max(1 - Sqr(cosine), 0.0f)), phi = 2 * kPi * turns;
  const Frame frame = Frame::FromNormal(photon.normal);
  photon.direction =
      sine * std::cos(phi) * frame.x + sine * std::sin(phi) * frame.y + (backwards ? -cosine : cosine) * photon.normal;
  photon.direction = glm::normalize(photon.direction);
  const float actual = glm::dot(photon.direction, photon.normal);
  photon.emissionCosine = std::abs(actual);
  photon.pdfEmit = Density(context, chosen.uv, photon.normal);
  photon.pdfEmitDirection = DirectionDensity(actual);
  Color emitted = Radiance(context, chosen.uv, photon.normal, photon.direction);
  if (emitted.IsBlack() || photon.pdfEmitDirection.IsZero()) return std::nullopt;
  if (Is(TileFault::PhotonsWithoutTint) || Is(TileFault::AllPhotonsWithoutTint))
    emitted = Color(Pattern(CellOf(chosen.uv)));
  Split(emitted, photon);
  return photon;
}

}  // namespace lampyr::test
