#include "integrators/guide/gain_estimate.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

constexpr double kMostGain = 1e4;

// The gain in [from, to] at which `isBelow` turns from true to false, by bisection.
template <class IsBelow>
double Bisect(double from, double to, const IsBelow& isBelow) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (from + to);
    (isBelow(middle) ? from : to) = middle;
  }
  return from;
}

}  // namespace

void GainEstimate::Add(double unguided, double guided) {
  ++count_;
  unguided_ += unguided;
  guided_ += guided;
  unguidedSquared_ += unguided * unguided;
  guidedSquared_ += guided * guided;
  product_ += unguided * guided;
}

double GainEstimate::Bounded(double secondMoments) const {
  return std::max(secondMoments - squaredMeans_, 1e-3 * guided_);
}

double GainEstimate::EffectiveCount() const {
  return guidedSquared_ > 0 ? guided_ * guided_ / guidedSquared_ : 0;
}

double GainEstimate::StandardDeviation(double gain) const {
  const double sum = unguided_ - gain * guided_;
  const double squares = unguidedSquared_ - 2 * gain * product_ + gain * gain * guidedSquared_;
  return std::sqrt(std::max(squares - sum * sum / count_, 0.0));
}

double GainEstimate::Bound(double deviations) const {
  const auto isBelow = [&](double gain) {
    return Unguided() - gain * Guided() > -deviations * StandardDeviation(gain);
  };
  return deviations < 0 ? Bisect(0, Ratio(), isBelow) : Bisect(Ratio(), kMostGain, isBelow);
}

}  // namespace lampyr
