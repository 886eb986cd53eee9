#include "suite/direction_source.h"

#include <glm/matrix.hpp>

namespace lampyr::suite {

namespace {

LightContext ContextFor(const SuiteSubject& subject, const float (&x)[4]) {
  LightContext context = subject.context;
  context.u = {x[0], x[1]};
  context.uDirection = {x[2], x[3]};
  return context;
}

}  // namespace

DirectionSource DirectionsFrom(const SuiteSubject& subject, const FixedStart& start, float distance) {
  const Light& light = *subject.light;
  DirectionSource source;
  source.draw = [&light, start](const float(&x)[4]) -> std::optional<Vector3> {
    const auto photon = light.GenerateEmission(start.Draw({x[0], x[1]}));
    if (!photon || photon->pdfEmitDirection.IsZero()) return std::nullopt;  // a position without a direction
    return photon->direction;
  };
  source.density = [&light, context = subject.context, hit = HitOf(start.photon, distance),
                    distance](const Vector3d& direction) mutable {
    hit.direction = -Vector3(direction);
    const auto e = light.EvaluateSamples(context, hit, hit.position + distance * Vector3(direction));
    return e ? Value(e->pdfEmitDirection) : 0.0;
  };
  return source;
}

DirectionSource DirectionsOfPoint(const SuiteSubject& subject, const Point3& position) {
  const Light& light = *subject.light;
  DirectionSource source;
  source.draw = [&light, &subject](const float(&x)[4]) -> std::optional<Vector3> {
    const auto photon = light.GenerateEmission(ContextFor(subject, x));
    if (!photon) return std::nullopt;
    return photon->direction;
  };
  source.density = [&light, context = subject.context, position](const Vector3d& outward) {
    const auto sample = light.GenerateSamples(context, position + context.scene.radius * Vector3(outward));
    return sample ? Value(sample->pdfEmitDirection) : 0.0;
  };
  return source;
}

DirectionSource DirectionsFromInfinity(const SuiteSubject& subject, int photons, Rng& rng) {
  const Light& light = *subject.light;
  const Point3d center(subject.context.scene.center);
  const auto radius = static_cast<double>(subject.context.scene.radius);
  std::vector<std::pair<Vector3d, Vector3d>> lines;  // origin, in radii from the centre, and direction
  glm::dmat3 sum(1e-12);
  Vector3d right(0.0);
  for (int i = 0; i < photons; ++i) {
    const auto photon = light.GenerateEmission(RandomContext(subject, rng));
    if (!photon) continue;
    const Vector3d d = glm::normalize(Vector3d(photon->direction)),
                   from = (Point3d(photon->position) - center) / radius;
    if (lines.size() < 16) lines.emplace_back(from, d);
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(d, d);
    sum += across;
    right += across * from;
  }
  std::vector<Vector3d> anchors{glm::inverse(sum) * right, Vector3d(0.0)};
  for (const auto& [from, d] : lines) anchors.push_back(from + d * glm::dot(anchors[0] - from, d));
  DirectionSource source;
  source.draw = [&light, &subject](const float(&x)[4]) -> std::optional<Vector3> {
    const auto photon = light.GenerateEmission(ContextFor(subject, x));
    if (!photon) return std::nullopt;
    return -photon->direction;
  };
  source.density = [&light, context = subject.context, center, radius, anchors](const Vector3d& toLight) {
    for (const Vector3d& anchor : anchors) {
      const Vector3d end = anchor - toLight * (1 + glm::dot(anchor, toLight));
      LightHit hit;
      hit.direction = glm::normalize(Vector3(toLight));
      hit.position = Point3(center + radius * end);
      const auto e = light.EvaluateSamples(context, hit, hit.position);
      if (e && !IsBlack(*e) && !e->pdfEmit.IsZero()) return Value(e->pdfEmitDirection);
    }
    return 0.0;
  };
  return source;
}

}  // namespace lampyr::suite
