#include "materials/hair.h"

#include <cmath>

#include "materials/fresnel.h"
#include "sampling/warp.h"

namespace lampyr {

namespace {

constexpr float kMostAbsorption = 1e9f;
constexpr float kSmallestCosine = 1e-9f;

float ClampTo(float x, float low, float high) {
  return std::min(std::max(low, x), high);
}  // NaN: low

Color AtMost(const Color& c, float most) {
  return {ClampTo(c.r, 0, most), ClampTo(c.g, 0, most), ClampTo(c.b, 0, most)};
}

float CosTheta(const Vector3& w) {
  return std::sqrt(w.y * w.y + w.z * w.z);
}

// Attenuation A_p of the four lobes in one channel. F: Fresnel reflectance of the wall; T: transmittance of the fibre.
void Attenuate(float F, float T, float attenuation[HairBsdf::kLobes]) {
  attenuation[0] = F;
  attenuation[1] = Sqr(1 - F) * T;
  attenuation[2] = attenuation[1] * T * F;
  const float stays = 1 - T * F;
  attenuation[3] = stays > 0 ? attenuation[2] * T * F / stays : 0.0f;
}

// Samples the logistic distribution of scale s, trimmed to [-π,π]. The ends of the range of u map to the parts of the
// tails that float can represent, and not to the ends of the interval, where a narrow lobe has no density.
float SampleTrimmedLogistic(float u, float s) {
  const float y = ClampTo(std::tanh(0.5f * kPi / s) * (2 * u - 1), -kOneMinusEpsilon, kOneMinusEpsilon);
  return ClampTo(s * (std::log1p(y) - std::log1p(-y)), -kPi, kPi);
}

}  // namespace

// All factors of S that depend on only one of the two directions.
struct HairBsdf::Lobes {
  float sinTheta[kLobes], cosTheta[kLobes];  // of the direction, tilted per lobe
  float exit[3];                             // φi - φo at the centre of R, TT, TRT
  Color attenuation[kLobes];
  float probability[kLobes];  // of sampling; all 0 if nothing is scattered
  float cosPhi, sinPhi;

  // Chooses a lobe by u, and rescales u for reuse.
  int Choose(float& u) const;
};

int HairBsdf::Lobes::Choose(float& u) const {
  int lobe = 0, last = 0;
  for (int p = 0; p < kLobes; ++p) {
    if (probability[p] > 0) last = p;
  }
  for (; lobe < last && u >= probability[lobe]; ++lobe) u -= probability[lobe];
  u = std::min(std::max(u, 0.0f) / probability[lobe], kOneMinusEpsilon);
  return lobe;
}

HairBsdf::HairBsdf(const Color& sigmaA, float eta, float betaM, float betaN, float alpha)
    : sigmaA_(AtMost(sigmaA, kMostAbsorption)), eta_(eta) {
  const float m = ClampTo(betaM, kLeastBeta, 1), n = ClampTo(betaN, kLeastBeta, 1);
  const float v = Sqr(0.726f * m + 0.812f * m * m + 3.7f * std::pow(m, 20.0f));
  constexpr float kWidths[3] = {1, 0.25f, 4};
  for (int p = 0; p < 3; ++p) {
    along_[p].variance = kWidths[p] * v;
    along_[p].norm = -1 / (along_[p].variance * std::expm1(-2 / along_[p].variance));
  }
  constexpr float kSqrtPiOver8 = 0.626657069f;
  scale_ = kSqrtPiOver8 * (0.265f * n + 1.194f * n * n + 5.372f * std::pow(n, 22.0f));
  scaleNorm_ = 1 / (scale_ * std::tanh(0.5f * kPi / scale_));
  constexpr float kTilts[3] = {-2, 1, 4};
  for (int p = 0; p < 3; ++p) {
    const float angle = kTilts[p] * alpha * (kPi / 180);
    tilt_[p] = {std::cos(angle), std::sin(angle)};
  }
}

float HairBsdf::ScatteringCosine(const Vector3& w) const {
  return std::max(isFibre ? CosTheta(w) : std::abs(w.z), kSmallestCosine);
}

// exp(-sinθi sinθo / v) I0(cosθi cosθo / v) / (2v sinh(1/v)). The exponents, up to about 1e5 for smooth fibres, are
// combined before rounding.
float HairBsdf::Longitudinal::Density(float sinO, float cosO, float sinI, float cosI) const {
  const float exponent = (Sqr(sinO + sinI) + Sqr(cosO - cosI)) / (2 * variance);
  return norm * std::exp(-exponent) * ScaledBesselI0(cosO * cosI / variance);
}

HairBsdf::Lobes HairBsdf::LobesFrom(const Vector3& w, float h) const {
  Lobes lobes;
  const float sinTheta = w.x, cosTheta = CosTheta(w);
  lobes.cosPhi = cosTheta > 0 ? w.y / cosTheta : 0.0f;
  lobes.sinPhi = cosTheta > 0 ? w.z / cosTheta : 1.0f;
  for (int p = 0; p < kLobes; ++p) {
    const Vector2 tilt = p < 3 ? tilt_[p] : Vector2(1, 0);
    lobes.sinTheta[p] = sinTheta * tilt.x + cosTheta * tilt.y;
    lobes.cosTheta[p] = std::abs(cosTheta * tilt.x - sinTheta * tilt.y);
  }
  // Inside: η² - sin²θ = (η cosθt)², and cosθo sinγo = η cosθt sinγt.
  const float inside = SafeSqrt((eta_ - 1) * (eta_ + 1) + cosTheta * cosTheta);
  const float sinGammaT = ClampTo(inside > 0 ? h * cosTheta / inside : h, -1, 1);
  const float gammaO = std::asin(h), gammaT = std::asin(sinGammaT);
  for (int p = 0; p < 3; ++p) {
    lobes.exit[p] = 2 * static_cast<float>(p) * gammaT - 2 * gammaO + static_cast<float>(p) * kPi;
  }
  const float F = FresnelDielectric(std::min(cosTheta * SafeSqrt((1 - h) * (1 + h)), 1.0f), eta_);
  constexpr float kSmallestInside = 1e-4f;
  const float way = 2 * SafeSqrt((1 - sinGammaT) * (1 + sinGammaT)) / std::max(inside / eta_, kSmallestInside);
  float red[kLobes], green[kLobes], blue[kLobes], sum = 0;
  Attenuate(F, std::exp(-sigmaA_.r * way), red);
  Attenuate(F, std::exp(-sigmaA_.g * way), green);
  Attenuate(F, std::exp(-sigmaA_.b * way), blue);
  for (int p = 0; p < kLobes; ++p) {
    lobes.attenuation[p] = {red[p], green[p], blue[p]};
    sum += lobes.probability[p] = lobes.attenuation[p].Average();
  }
  for (float& probability : lobes.probability) probability = sum > 0 ? probability / sum : 0.0f;
  return lobes;
}

BsdfEvaluation HairBsdf::Scatter(const Vector3& wo, const Vector3& wi, const Lobes& fromWo, TransportMode mode) const {
  const Lobes fromWi = LobesFrom(wi, -OffsetFrom(mode));
  const float turn = std::atan2(fromWo.cosPhi * fromWi.sinPhi - fromWo.sinPhi * fromWi.cosPhi,
                                fromWo.cosPhi * fromWi.cosPhi + fromWo.sinPhi * fromWi.sinPhi);
  struct Sum {
    Color scattered;
    float pdf = 0;
  };
  const auto sum = [this](const Lobes& from, const Vector3& to, float phi) {
    Sum result;
    const float cosTheta = CosTheta(to);
    for (int p = 0; p < kLobes; ++p) {
      float density = 0.5f * kInvPi;
      if (p < 3) {
        const float e = std::exp(-std::abs(std::remainder(phi - from.exit[p], 2 * kPi)) / scale_);
        density = scaleNorm_ * e / Sqr(1 + e);
      }
      density *= along_[std::min(p, 2)].Density(from.sinTheta[p], from.cosTheta[p], to.x, cosTheta);
      result.scattered += density * from.attenuation[p];
      result.pdf += density * from.probability[p];
    }
    return result;
  };
  const Sum forward = sum(fromWo, wi, turn), reverse = sum(fromWi, wo, -turn);
  BsdfEvaluation result;
  result.specular = mode == TransportMode::Radiance ? forward.scattered / ScatteringCosine(wi)
                                                    : reverse.scattered / ScatteringCosine(wo);
  result.pdfForward = PdfSolidAngle(forward.pdf);
  result.pdfReverse = PdfSolidAngle(reverse.pdf);
  return result;
}

BsdfEvaluation HairBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const {
  return Scatter(wo, wi, LobesFrom(wo, OffsetFrom(mode)), mode);
}

BsdfSample HairBsdf::Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const {
  BsdfSample sample;
  const Lobes lobes = LobesFrom(wo, OffsetFrom(mode));
  float uAround = uLobe;
  const int p = lobes.Choose(uAround);
  if (!(lobes.probability[p] > 0)) return sample;
  // M_p is the marginal in θ of a von Mises-Fisher distribution around the tilted -θ, which is sampled by 1 - cos of
  // the angle to its axis and the azimuth around the axis.
  const float v = along_[std::min(p, 2)].variance;
  const float away = std::min(-v * std::log1p(std::max((1 - u.x) * std::expm1(-2 / v), -kOneMinusEpsilon)), 2.0f);
  const float cosine = 1 - away, sine = SafeSqrt(away * (2 - away));
  const Vector2 around = CosSinTurns(uAround);
  const float sinTheta = -cosine * lobes.sinTheta[p] + sine * around.x * lobes.cosTheta[p];
  const float inPlane = cosine * lobes.cosTheta[p] + sine * around.x * lobes.sinTheta[p];
  const float cosTheta = std::sqrt(Sqr(inPlane) + Sqr(sine * around.y));
  const float phi = p < 3 ? lobes.exit[p] + SampleTrimmedLogistic(u.y, scale_) : 2 * kPi * u.y;
  const float c = std::cos(phi), s = std::sin(phi);
  sample.wi = glm::normalize(Vector3(sinTheta, cosTheta * (lobes.cosPhi * c - lobes.sinPhi * s),
                                     cosTheta * (lobes.sinPhi * c + lobes.cosPhi * s)));
  const BsdfEvaluation value = Scatter(wo, sample.wi, lobes, mode);
  if (!(value.pdfForward.value > 0)) return sample;
  sample.weightSpecular = value.specular * (ScatteringCosine(sample.wi) / value.pdfForward.value);
  sample.pdfForward = value.pdfForward;
  sample.pdfReverse = value.pdfReverse;
  sample.isTransmission = wo.z * sample.wi.z < 0;
  return sample;
}

// [Abramowitz64 §9.8.1, §9.8.2].
float ScaledBesselI0(float x) {
  if (x < 3.75f) {
    const float t = Sqr(x / 3.75f);
    const float I0 =
        1 +
        t * (3.5156229f + t * (3.0899424f + t * (1.2067492f + t * (0.2659732f + t * (0.0360768f + t * 0.0045813f)))));
    return std::exp(-x) * I0;
  }
  const float t = 3.75f / x;
  float sum = 0;
  for (const float coefficient : {0.00392377f, -0.01647633f, 0.02635537f, -0.02057706f, 0.00916281f, -0.00157565f,
                                  0.00225319f, 0.01328592f, 0.39894228f}) {
    sum = sum * t + coefficient;
  }
  return sum / std::sqrt(x);
}

Color HairAbsorption(const Color& reflectance, float betaN) {
  const float b = ClampTo(betaN, HairBsdf::kLeastBeta, 1);
  const float slope = 5.969f + b * (-0.215f + b * (2.532f + b * (-10.73f + b * (5.574f + b * 0.245f))));
  // Clamped: the absorption of a black block would be infinite.
  const auto absorption = [slope](float c) { return Sqr(std::log(ClampTo(c, 1e-30f, 1)) / slope); };
  return {absorption(reflectance.r), absorption(reflectance.g), absorption(reflectance.b)};
}

Color HairAbsorption(float eumelanin, float pheomelanin) {
  constexpr float kMost = 1e6f;
  return ClampTo(eumelanin, 0, kMost) * Color(0.419f, 0.697f, 1.37f) +
         ClampTo(pheomelanin, 0, kMost) * Color(0.187f, 0.4f, 1.05f);
}

}  // namespace lampyr
