// Scattering at a vertex where walks are guided: the density of a direction is α · guide + (1 - α) · BSDF (guide/).
#include "integrators/walk/vertex.h"

namespace lampyr {

namespace {

// Bound of the ratio of densities, which only Russian roulette and learning read: the BSDF's own may be 0.
constexpr float kMostGuidance = 1e6f;

// The guides of walks of a mode, and of those of the other one.
const MixtureFit& OwnGuide(const GuideRegion& region, TransportMode mode) {
  return mode == TransportMode::Radiance ? region.radiance : region.importance;
}
const MixtureFit& OtherGuide(const GuideRegion& region, TransportMode mode) {
  return mode == TransportMode::Radiance ? region.importance : region.radiance;
}

PdfSolidAngle Mixed(const MixtureFit& guide, const Point3& position, const Vector3& direction, PdfSolidAngle bsdf) {
  if (!(guide.share > 0)) return bsdf;
  return guide.share * guide.mixture.Density(position, direction) + (1 - guide.share) * bsdf;
}

float Ratio(PdfSolidAngle guided, PdfSolidAngle bsdf) {
  return std::min(guided.value / std::max(bsdf.value, 1e-30f), kMostGuidance);
}

}  // namespace

void Vertex::Guide(const Vector3& from, const Vector3& to, TransportMode mode, BsdfEvaluation& f) const {
  f.pdfForward = Mixed(OwnGuide(*guide, mode), point.position, to, f.pdfForward);
  f.pdfReverse = Mixed(OtherGuide(*guide, mode), point.position, from, f.pdfReverse);
}

BsdfSample Vertex::SampleGuided(float uLobe, const Point2& u, TransportMode mode, Guidance& guidance) const {
  const MixtureFit& own = OwnGuide(*guide, mode);
  const MixtureFit& other = OtherGuide(*guide, mode);
  BsdfSample sample;
  PdfSolidAngle bsdfForward, bsdfReverse;
  guidance = {};
  if (uLobe < own.share) {
    sample.wi = own.mixture.Sample(point.position, uLobe / own.share, u);
    const BsdfEvaluation f = bsdf.Evaluate(toPrevious, sample.wi, mode);
    if (f.Sum().IsBlack()) return sample;
    bsdfForward = f.pdfForward;
    bsdfReverse = f.pdfReverse;
    sample.pdfForward = Mixed(own, point.position, sample.wi, bsdfForward);
    const float scale = bsdf.ScatteringCosine(sample.wi) / sample.pdfForward.value;
    sample.weightDiffuse = f.diffuse * scale;
    sample.weightSpecular = f.specular * scale;
    const Normal3& Ns = bsdf.ShadingFrame().z;
    sample.isTransmission = !IsInMedium() && glm::dot(sample.wi, Ns) * glm::dot(toPrevious, Ns) < 0;
  } else {
    const float rest = std::min((uLobe - own.share) / (1 - own.share), kOneMinusEpsilon);
    sample = bsdf.Sample(toPrevious, rest, u, mode);
    if (!sample) return sample;
    bsdfForward = sample.pdfForward;
    bsdfReverse = sample.pdfReverse;
    sample.pdfForward =
        sample.isDelta ? (1 - own.share) * bsdfForward : Mixed(own, point.position, sample.wi, bsdfForward);
    const float scale = bsdfForward.value / sample.pdfForward.value;
    sample.weightDiffuse *= scale;
    sample.weightSpecular *= scale;
  }
  sample.pdfReverse =
      sample.isDelta ? (1 - other.share) * bsdfReverse : Mixed(other, point.position, toPrevious, bsdfReverse);
  guidance = {Ratio(sample.pdfForward, bsdfForward), Ratio(sample.pdfReverse, bsdfReverse)};
  return sample;
}

}  // namespace lampyr
