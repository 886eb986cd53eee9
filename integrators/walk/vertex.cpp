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

// Density of a direction by a guide; 0 if its share is.
PdfSolidAngle DensityOf(const MixtureFit& guide, const Point3& position, const Vector3& direction) {
  return guide.share > 0 ? guide.mixture.Density(position, direction) : PdfSolidAngle(0);
}

PdfSolidAngle Mixed(float share, PdfSolidAngle guide, PdfSolidAngle bsdf) {
  return share * guide + (1 - share) * bsdf;
}

float Ratio(PdfSolidAngle guided, PdfSolidAngle bsdf) {
  return std::min(guided.value / std::max(bsdf.value, 1e-30f), kMostGuidance);
}

}  // namespace

PdfSolidAngle Vertex::ReverseGuide(const Vector3& from, TransportMode mode) const {
  return DensityOf(OtherGuide(*guide, mode), point.position, from);
}

void Vertex::Guide(const Vector3& to, TransportMode mode, PdfSolidAngle reverse, BsdfEvaluation& f) const {
  const MixtureFit& own = OwnGuide(*guide, mode);
  f.pdfForward = Mixed(own.share, DensityOf(own, point.position, to), f.pdfForward);
  f.pdfReverse = Mixed(OtherGuide(*guide, mode).share, reverse, f.pdfReverse);
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
    sample.pdfForward = Mixed(own.share, DensityOf(own, point.position, sample.wi), bsdfForward);
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
    sample.pdfForward = sample.isDelta ? (1 - own.share) * bsdfForward
                                       : Mixed(own.share, DensityOf(own, point.position, sample.wi), bsdfForward);
    const float scale = bsdfForward.value / sample.pdfForward.value;
    sample.weightDiffuse *= scale;
    sample.weightSpecular *= scale;
  }
  sample.pdfReverse =
      sample.isDelta ? (1 - other.share) * bsdfReverse : Mixed(other.share, ReverseGuide(mode), bsdfReverse);
  guidance = {Ratio(sample.pdfForward, bsdfForward), Ratio(sample.pdfReverse, bsdfReverse)};
  return sample;
}

}  // namespace lampyr
