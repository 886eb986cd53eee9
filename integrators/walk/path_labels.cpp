#include "integrators/walk/path_labels.h"

#include <algorithm>

#include "integrators/walk/vertex.h"

namespace lampyr {

namespace {

float ShareOf(float part, float other) {
  return part == 0 ? 0.0f : other == 0 ? 1.0f : part / (part + other);
}
Color ShareOf(const Color& part, const Color& other) {
  return {ShareOf(part.r, other.r), ShareOf(part.g, other.g), ShareOf(part.b, other.b)};
}

PathEvent WithTransmission(PathEvent reflection) {
  constexpr auto kReflections = static_cast<unsigned>(PathEvent::DiffuseTransmission);
  return static_cast<PathEvent>(static_cast<unsigned>(reflection) + kReflections);
}

}  // namespace

void PathLabels::Add(uint32_t state, const Color& share) {
  const auto same =
      std::find_if(all_.begin(), all_.end(), [&](const PathLabel& label) { return label.state == state; });
  if (same == all_.end()) {
    all_.push_back({state, share});
  } else {
    same->share += share;
  }
}

ScatteringParts PartsOf(const Vertex& vertex, const Vector3& direction, bool isDelta, const Color& diffuse,
                        const Color& specular) {
  ScatteringParts parts{.diffuse = diffuse, .specular = specular};
  if (vertex.IsInMedium()) {
    parts.ofDiffuse = parts.ofSpecular = PathEvent::Volume;
    return parts;
  }
  parts.ofSpecular = isDelta ? PathEvent::SpecularReflection : PathEvent::GlossyReflection;
  const Normal3& Ns = vertex.bsdf.ShadingFrame().z;
  if (!vertex.bsdf.IsFibre() && glm::dot(vertex.toPrevious, Ns) * glm::dot(direction, Ns) < 0) {
    parts.ofDiffuse = WithTransmission(parts.ofDiffuse);
    parts.ofSpecular = WithTransmission(parts.ofSpecular);
  }
  return parts;
}

void LabelsAfter(const OutputPlan& plan, TransportMode mode, std::span<const PathLabel> arrived,
                 const ScatteringParts& event, PathLabels& after) {
  after.Clear();
  const auto add = [&](PathEvent kind, const Color& share) {
    if (share.IsBlack()) return;
    for (const PathLabel& label : arrived) {
      const uint32_t state = mode == TransportMode::Radiance ? plan.AfterFromCamera(label.state, kind)
                                                             : plan.AfterFromLight(label.state, kind);
      after.Add(state, label.share * share);
    }
  };
  add(event.ofDiffuse, ShareOf(event.diffuse, event.specular));
  add(event.ofSpecular, ShareOf(event.specular, event.diffuse));
}

std::span<const LayerShare> SharesOf(const OutputPlan& plan, std::span<const PathLabel> camera,
                                     std::span<const PathLabel> light) {
  thread_local std::vector<LayerShare> shares;
  shares.clear();
  for (const PathLabel& a : camera) {
    for (const PathLabel& b : light) {
      for (const uint32_t layer : plan.LayersOf(a.state, b.state)) shares.push_back({layer, a.share * b.share});
    }
  }
  return shares;
}

}  // namespace lampyr
