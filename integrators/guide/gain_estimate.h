// The ratio of the variances of paths without and with a guide, and how sure it is.
#pragma once

namespace lampyr {

// Each path gives estimates of its second moment without the guide and with it. They are correlated, because both are
// of the same path, so that their difference is less noisy than either: bounds of the ratio g are where
//   Var(unguided) - g · Var(guided)
// differs from 0 by a number of standard deviations of its sum over the paths ([Fieller54]).
class GainEstimate {
 public:
  // Second moments of one path.
  void Add(double unguided, double guided);
  // Σ over the paths of their squared means, which are the same with a guide and without one.
  void SetSquaredMeans(double sum) { squaredMeans_ = sum; }

  // Number of paths of equal second moments, with the guide, whose sum would be as uncertain.
  double EffectiveCount() const;
  double Ratio() const { return Unguided() / Guided(); }
  // Bound of the ratio: a lower one for negative `deviations`, an upper one for positive ones.
  double Bound(double deviations) const;

 private:
  // Sums of the variances. Those of nearly noiseless pictures are differences of what is almost equal.
  double Unguided() const { return Bounded(unguided_); }
  double Guided() const { return Bounded(guided_); }
  double Bounded(double secondMoments) const;
  double StandardDeviation(double gain) const;

  double count_ = 0, unguided_ = 0, guided_ = 0, squaredMeans_ = 0;
  double unguidedSquared_ = 0, guidedSquared_ = 0, product_ = 0;  // Σ u², Σ g², Σ u g
};

}  // namespace lampyr
