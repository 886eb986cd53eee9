#include "lights/types/shaped_factor.h"

namespace lampyr {

KnotFinder::KnotFinder(std::vector<float> knots) : knots_(std::move(knots)) {
  const size_t bins = std::max<size_t>(4 * knots_.size(), 16);
  const float width = knots_.back() - knots_.front();
  binsPerUnit_ = static_cast<float>(bins) / width;
  lastBin_ = static_cast<float>(bins - 1);
  uint32_t interval = 0;
  for (size_t bin = 0; bin < bins; ++bin) {
    // The index of a bin is subject to rounding; starting half a bin earlier is safe.
    const float begin = knots_.front() + (static_cast<float>(bin) - 0.5f) / binsPerUnit_;
    while (interval + 2 < knots_.size() && knots_[interval + 1] <= begin) ++interval;
    first_.push_back(interval);
  }
}

// All but one of the rows of zeros at each end are removed, so that the ends are those of the emission.
ShapedProfile::ShapedProfile(const IesProfile& profile, double angleScale, bool normalize)
    : scale_(static_cast<float>(angleScale)), symmetric_(profile.Phis().size() == 2) {
  // φ = 2π is the last plane, which need not be the first.
  std::vector<double> phis = profile.Phis();
  phis.back() = std::nextafter(phis.back(), 0);
  const auto isDark = [&](double theta) {
    return std::all_of(phis.begin(), phis.end(), [&](double phi) { return profile.Intensity(theta, phi) == 0; });
  };
  std::vector<double> thetas = profile.Thetas();
  while (thetas.size() > 2 && isDark(thetas.back()) && isDark(thetas[thetas.size() - 2])) thetas.pop_back();
  size_t skipped = 0;
  while (skipped + 2 < thetas.size() && isDark(thetas[skipped]) && isDark(thetas[skipped + 1])) ++skipped;
  thetas.erase(thetas.begin(), thetas.begin() + static_cast<std::ptrdiff_t>(skipped));

  double scale = 1;
  if (normalize) scale = profile.Power() > 1e-300 ? 4 * kPiExact / profile.Power() : 0;
  for (const double phi : phis) {
    for (const double theta : thetas) values_.push_back(static_cast<float>(profile.Intensity(theta, phi) * scale));
  }
  const float brightest = *std::max_element(values_.begin(), values_.end());
  for (float& value : values_) value = value > kDark * std::max(brightest, 1.0f) ? value : 0;
  largest_ = brightest > kDark ? brightest : 0;
  std::vector<float> turns;
  for (const double phi : profile.Phis()) turns.push_back(static_cast<float>(phi / (2 * kPiExact)));
  turns_ = KnotFinder(std::move(turns));
  thetas_ = KnotFinder({thetas.begin(), thetas.end()});
  SetLightThetas(thetas);
}

// The scaled angles, within [0, π]. Where the clamp to [0, π] repeats a pole's value, the profile continues to the end.
void ShapedProfile::SetLightThetas(const std::vector<double>& thetas) {
  const double scale = static_cast<double>(scale_);
  const auto toLight = [scale](double theta) {
    if (scale > 0) return theta * scale;
    return scale < 0 ? kPiExact - (kPiExact - theta) * -scale : theta;
  };
  for (const double theta : thetas) {
    const double light = toLight(theta);
    if (light >= 0 && light <= kPiExact) lightThetas_.push_back(light);
  }
  if (toLight(thetas.front()) < 0 || thetas.front() <= 0) lightThetas_.insert(lightThetas_.begin(), 0.0);
  if (toLight(thetas.back()) > kPiExact || thetas.back() >= kPiExact) lightThetas_.push_back(kPiExact);
}

ShapedFactor::ShapedFactor(const ConeSetting& cone, const FocusSetting& focus,
                           std::unique_ptr<const ShapedProfile> profile)
    : focus_(focus), profile_(std::move(profile)) {
  if (cone.inForce) {
    lastTheta_ = cone.angle;
    startTheta_ = cone.angle * (1 - cone.softness);
    coneEnd_ = static_cast<float>(cone.angle);
    const float width = static_cast<float>(cone.angle * cone.softness);
    // Avoids division by an edge of zero width.
    if (width > std::numeric_limits<float>::min()) inverseWidth_ = 1 / width;
    if (!(inverseWidth_ > 0)) startTheta_ = lastTheta_;
  }
  if (profile_) {
    firstTheta_ = profile_->LightThetas().empty() ? kPiExact : profile_->LightThetas().front();
    const double end = profile_->LightThetas().empty() ? 0 : profile_->LightThetas().back();
    lastTheta_ = std::min(lastTheta_, end);
  }
  first_ = firstTheta_ < lastTheta_ ? AxisAngle::Of(firstTheta_).fromAxis : 3;  // 3: nowhere
  last_ = lastTheta_ < kPiExact ? AxisAngle::Of(lastTheta_).fromAxis : 2;
  coneStart_ = startTheta_ < kPiExact ? AxisAngle::Of(startTheta_).fromAxis : 2;
}

float ShapedFactor::Largest() const {
  const float tint = focus_.inForce ? std::max(focus_.tint.Max(), 1.0f) : 1.0f;
  return profile_ ? tint * profile_->Largest() : tint;
}

// Knots at the angles where |cosθ|^exponent is e^-c, from both poles. No lobe, however narrow or weak beside others, is
// lost within a row, down to the value that counts as 0 (e^-69 = 1e-30).
void ShapedFactor::AddFocusKnots(std::vector<double>& knots) const {
  knots.push_back(0.5 * kPiExact);
  for (const double c : {0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 69.0}) {
    const double w = -std::expm1(-c / static_cast<double>(focus_.exponent));
    const double theta = 2 * std::asin(std::sqrt(0.5 * w));
    knots.push_back(theta);
    knots.push_back(kPiExact - theta);
  }
}

std::vector<double> ShapedFactor::ThetaKnots() const {
  std::vector<double> knots = {firstTheta_, startTheta_, lastTheta_};
  if (focus_.inForce) AddFocusKnots(knots);
  if (profile_) knots.insert(knots.end(), profile_->LightThetas().begin(), profile_->LightThetas().end());
  std::erase_if(knots, [&](double theta) { return theta < firstTheta_ || theta > lastTheta_; });
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  if (knots.size() < 2 || !(Largest() > 0)) knots.clear();
  return knots;
}

}  // namespace lampyr
