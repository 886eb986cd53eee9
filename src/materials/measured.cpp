#include "materials/measured.h"
#include "spectral/wavelengths.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

constexpr double kPiExact = 3.14159265358979323846;

// Spherical coordinates of a unit direction, with θ accurate near the pole.
struct Angles {
  double theta = 0, phi = 0;
};
Angles AnglesOf(const Vector3d& w) {
  const double across = std::sqrt(w.x * w.x + w.y * w.y);
  return {std::atan2(across, w.z), std::atan2(w.y, w.x)};
}

// Position of a half vector, or of a direction of incidence, in a table.
Point2d PlaceOf(double theta, double phi) {
  double turns = (phi + kPiExact) / (2 * kPiExact);
  turns -= std::floor(turns);
  return {std::sqrt(theta * (2 / kPiExact)), turns};
}

// Index of the interval of `nodes` that holds `value`, clamped to the ends, and the weight of its upper node.
struct Interval {
  size_t index = 0;
  float weight = 0;
};
Interval Find(const std::vector<float>& nodes, double value) {
  if (nodes.size() < 2) return {};
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, static_cast<float>(value));
  const size_t index = static_cast<size_t>(above - nodes.begin()) - 1;
  const double low = static_cast<double>(nodes[index]), high = static_cast<double>(nodes[index + 1]);
  return {index, static_cast<float>(std::clamp((value - low) / (high - low), 0.0, 1.0))};
}

// A direction of incidence: its tables, and the position of half vectors relative to it.
class Incidence {
 public:
  Incidence(const MeasuredData& data, const Vector3& direction) : data_(data) {
    Vector3d w(direction);
    // Mirrored into the measured part of the azimuths.
    if (data.symmetry >= 2 && direction.y * data.partY < 0) flipY_ = -1;
    if (data.symmetry == 2) flipX_ = flipY_;
    if (data.symmetry == 4 && direction.x * data.partX < 0) flipX_ = -1;
    w = Mirror(w);
    angles_ = AnglesOf(w);
    const Interval theta = Find(data.theta, angles_.theta);
    const Interval phi = data.isIsotropic ? Interval{} : Find(data.phi, angles_.phi);
    const size_t thetas = data.theta.size();
    for (int p = 0; p < 2; ++p) {
      const float weightPhi = p == 0 ? 1 - phi.weight : phi.weight;
      for (int t = 0; t < 2; ++t) {
        const float weight = weightPhi * (t == 0 ? 1 - theta.weight : theta.weight);
        if (!(weight > 0)) continue;
        const auto next = static_cast<size_t>(blend_.count++);
        blend_.table[next] = (phi.index + static_cast<size_t>(p)) * thetas + theta.index + static_cast<size_t>(t);
        blend_.weight[next] = weight;
      }
    }
  }

  const TableBlend& Blend() const { return blend_; }

  Point2d PlaceOfHalf(const Vector3d& half) const {
    const Angles angles = AnglesOf(Mirror(half));
    return PlaceOf(angles.theta, data_.isIsotropic ? angles.phi - angles_.phi : angles.phi);
  }
  Vector3d HalfAt(const Point2d& place) const {
    const double theta = place.x * place.x * (0.5 * kPiExact);
    const double phi = (2 * place.y - 1) * kPiExact + (data_.isIsotropic ? angles_.phi : 0);
    const double sine = std::sin(theta);
    return Mirror(Vector3d(sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)));
  }
  double ProjectedArea() const {
    return static_cast<double>(data_.projected.Evaluate(PlaceOf(angles_.theta, angles_.phi)));
  }

 private:
  Vector3d Mirror(const Vector3d& w) const { return {flipX_ * w.x, flipY_ * w.y, w.z}; }

  const MeasuredData& data_;
  double flipX_ = 1, flipY_ = 1;
  Angles angles_;
  TableBlend blend_;
};

// Solid angle of reflected directions per unit of the square of half vectors: dω_h = sinθ dθ dφ with θ = u² π/2, and
// dω = 4 (w·h) dω_h.
double SolidAnglePerSquare(double u, double cosine) {
  const double theta = u * u * (0.5 * kPiExact);
  return 2 * kPiExact * kPiExact * u * std::sin(theta) * 4 * cosine;
}

// f · cosine of the outgoing direction, [Dupuy18 eq. 1]. `warped`: the half vector's position before the warp.
Color Reflected(const MeasuredData& data, const Incidence& incidence, const Point2d& place, const Point2d& warped) {
  const double area = incidence.ProjectedArea();
  if (!(area > 0)) return Color(0.0f);
  constexpr double kLargest = 1e20;  // Far above any measurement: keeps products in the range of float.
  const double scale = std::min(static_cast<double>(data.normals.Evaluate(place)) / (4 * area), kLargest);
  return data.reflectance.Evaluate(incidence.Blend(), warped) * static_cast<float>(scale);
}

struct Look {
  Color reflected;
  double density = 0;  // of sampling the half vector's direction from `incidence`, 1/sr
};
Look LookFrom(const MeasuredData& data, const Vector3& direction, const Vector3d& half, double cosine,
              bool wantsValue) {
  const Incidence incidence(data, direction);
  const Point2d place = incidence.PlaceOfHalf(half);
  const double measure = SolidAnglePerSquare(place.x, cosine);
  const Point2d warped = data.visible.Invert(incidence.Blend(), place);
  Look look;
  if (measure > 0) {
    look.density =
        data.visible.Density(incidence.Blend(), place) * data.luminance.Density(incidence.Blend(), warped) / measure;
  }
  if (wantsValue) look.reflected = Reflected(data, incidence, place, warped);
  return look;
}

}  // namespace

BsdfEvaluation MeasuredBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const {
  if (!(wo.z * wi.z > 0)) return {};
  const Vector3 o = wo.z < 0 ? -wo : wo, i = wo.z < 0 ? -wi : wi;
  const Vector3d sum = Vector3d(o) + Vector3d(i);
  const Vector3d half = sum / glm::length(sum);
  const double cosine = glm::dot(half, Vector3d(o));
  if (!(cosine > 0)) return {};
  const bool fromCamera = mode == TransportMode::Radiance;
  const Look forward = LookFrom(*data, o, half, cosine, fromCamera);
  const Look reverse = LookFrom(*data, i, half, cosine, !fromCamera);
  BsdfEvaluation result;
  result.specular = fromCamera ? forward.reflected / i.z : reverse.reflected / o.z;
  if (wavelengths) result.specular = wavelengths->FromRgb(result.specular);
  result.pdfForward = PdfSolidAngle(static_cast<float>(forward.density));
  result.pdfReverse = PdfSolidAngle(static_cast<float>(reverse.density));
  return result;
}

BsdfSample MeasuredBsdf::Sample(const Vector3& wo, float, const Point2& u, TransportMode mode) const {
  BsdfSample sample;
  const Vector3 o = wo.z < 0 ? -wo : wo;
  const Incidence incidence(*data, o);
  const Point2d onLuminance = data->luminance.Sample(incidence.Blend(), Point2d(u.x, u.y));
  const Point2d onNormals = data->visible.Sample(incidence.Blend(), onLuminance);
  const Vector3d half = incidence.HalfAt(onNormals), towards(o);
  const double cosine = glm::dot(half, towards);
  const Vector3d reflected = 2 * cosine * half - towards;
  if (!(cosine > 0) || !(reflected.z > 0)) return sample;
  const Vector3 i(reflected / glm::length(reflected));
  if (!(i.z > 0)) return sample;
  // The densities of the direction as rounded.
  const BsdfEvaluation value = Evaluate(o, i, mode);
  if (!(value.pdfForward.value > 0)) return sample;
  sample.wi = wo.z < 0 ? -i : i;
  sample.weightSpecular = value.specular * (i.z / value.pdfForward.value);
  sample.pdfForward = value.pdfForward;
  sample.pdfReverse = value.pdfReverse;
  return sample;
}

}  // namespace lampyr
