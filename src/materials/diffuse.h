// Lambertian reflection and transmission: f = ρ/π, sampled by the cosine. Units 1/sr.
#pragma once

#include "materials/scattering.h"
#include "sampling/warp.h"

namespace lampyr {

// Diffuse reflection, on either side.
struct DiffuseBsdf {
  Color reflectance;

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode) const {
    if (!(wo.z * wi.z > 0)) return {};
    return {reflectance * kInvPi, Color(), PdfSolidAngle(std::abs(wi.z) * kInvPi),
            PdfSolidAngle(std::abs(wo.z) * kInvPi)};
  }

  BsdfSample Sample(const Vector3& wo, float, const Point2& u, TransportMode) const {
    BsdfSample sample;
    sample.wi = SampleCosineHemisphere(u);
    sample.pdfForward = PdfSolidAngle(sample.wi.z * kInvPi);
    sample.pdfReverse = PdfSolidAngle(std::abs(wo.z) * kInvPi);
    sample.weightDiffuse = reflectance;
    sample.wi.z = std::copysign(sample.wi.z, wo.z);
    return sample;
  }

  bool IsDelta() const { return false; }
  bool IsTransmissive() const { return false; }
};

// Diffuse reflection and transmission; a lobe is chosen in proportion to the largest component of its colour.
struct DiffuseTransmissionBsdf {
  Color reflectance, transmittance;

  float ReflectionProbability() const {
    const float r = reflectance.Max(), t = transmittance.Max();
    return r + t > 0 ? r / (r + t) : 1.0f;
  }

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode) const {
    const bool reflects = wo.z * wi.z > 0;
    const float probability = reflects ? ReflectionProbability() : 1 - ReflectionProbability();
    return {(reflects ? reflectance : transmittance) * kInvPi, Color(),
            PdfSolidAngle(probability * std::abs(wi.z) * kInvPi), PdfSolidAngle(probability * std::abs(wo.z) * kInvPi)};
  }

  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode) const {
    const float reflection = ReflectionProbability();
    const bool reflects = uLobe < reflection;
    const float probability = reflects ? reflection : 1 - reflection;
    BsdfSample sample;
    if (!(probability > 0)) return sample;
    sample.wi = SampleCosineHemisphere(u);
    sample.pdfForward = PdfSolidAngle(probability * sample.wi.z * kInvPi);
    sample.pdfReverse = PdfSolidAngle(probability * std::abs(wo.z) * kInvPi);
    sample.weightDiffuse = (reflects ? reflectance : transmittance) / probability;
    sample.isTransmission = !reflects;
    if ((wo.z < 0) == reflects) sample.wi.z = -sample.wi.z;
    return sample;
  }

  bool IsDelta() const { return false; }
  bool IsTransmissive() const { return !transmittance.IsBlack(); }
};

}  // namespace lampyr
