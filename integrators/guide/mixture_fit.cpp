#include "integrators/guide/mixture_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/frame.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr size_t kLobes = DirectionMixture::kLobes;
// Iterations after each doubling of the lobes.
constexpr int kIterations = 4;
// Strides of the subsets of events that are evaluated: until there are all lobes, and then until the last iteration.
constexpr size_t kStride = 3, kStrideOfAll = 2;
// Effective number of uniformly distributed events that each lobe is mixed with: few events do not make a narrow lobe.
constexpr double kPriorEvents = 0.3;
// A region whose events have a smaller effective number is not guided.
constexpr double kFewestEvents = 12;
// Most of the weight of a region that one event may have.
constexpr double kLargestPart = 0.1;
// Factor on the most likely share. The most likely share is too large: it weighs directions by their radiance, and not
// by the larger variance of those that only scattering finds ([Rath20]). relMSE of `path` at 256 samples with factors of
// 0.55, 0.7, 0.85 and 1: in scenes/door 1.06, 1, 0.93, 0.94; in lamp –, 1, 0.90, 0.90.
constexpr double kOfLikeliest = 0.85;
// A guide with a smaller share is dropped: it would not repay its evaluation.
constexpr double kLeastShare = 0.02;

// A lobe while it is fitted, as seen from the center of the region.
struct Lobe {
  Vector3d mean{0.0, 0.0, 1.0};  // unit
  double nearness = 0;           // 1 / distance of the target; 0: at infinity
  double kappa = 1, weight = 0;
};

// Sums over the events, weighted by the responsibilities of the lobes. Stored by lobe, so that a compiler vectorises
// them.
struct LobeSums {
  using Lanes = DirectionMixture::Lanes;
  alignas(32) Lanes weight{}, squares{}, nearness{};
  alignas(32) Lanes x{}, y{}, z{};                       // of the direction
  alignas(32) Lanes xx{}, yy{}, zz{}, xy{}, xz{}, yz{};  // its moments

  void Add(const Vector3& d, float near, const Lanes& parts) {
    for (size_t k = 0; k < kLobes; ++k) {
      weight[k] += parts[k];
      squares[k] += parts[k] * parts[k];
      nearness[k] += parts[k] * near;
      x[k] += parts[k] * d.x;
      y[k] += parts[k] * d.y;
      z[k] += parts[k] * d.z;
    }
  }
  void AddMoments(const Vector3& d, const Lanes& parts) {
    for (size_t k = 0; k < kLobes; ++k) {
      xx[k] += parts[k] * d.x * d.x;
      yy[k] += parts[k] * d.y * d.y;
      zz[k] += parts[k] * d.z * d.z;
      xy[k] += parts[k] * d.x * d.y;
      xz[k] += parts[k] * d.x * d.z;
      yz[k] += parts[k] * d.y * d.z;
    }
  }
  Vector3d Direction(size_t k) const { return Vector3d(Vector3(x[k], y[k], z[k])); }
  double SecondMoment(size_t k, const Vector3& a, const Vector3& b) const {
    return static_cast<double>(a.x * b.x * xx[k] + a.y * b.y * yy[k] + a.z * b.z * zz[k] +
                               (a.x * b.y + a.y * b.x) * xy[k] + (a.x * b.z + a.z * b.x) * xz[k] +
                               (a.y * b.z + a.z * b.y) * yz[k]);
  }
};

// κ of the von Mises-Fisher distribution whose mean vector has the length r ([Banerjee05]).
double KappaOf(double r) {
  const double kappa = r * (3 - r * r) / std::max(1 - r * r, 1e-9);
  return std::clamp(kappa, static_cast<double>(DirectionMixture::kLeastKappa),
                    static_cast<double>(DirectionMixture::kMostKappa));
}

class Fit {
 public:
  Fit(std::span<const GuideEvent> events, const Point3& center) : events_(events), center_(center) {
    double sum = 0, squares = 0;
    for (const GuideEvent& event : events) sum += static_cast<double>(event.weight);
    const double most = kLargestPart * sum;
    weights_.reserve(events.size());
    fromCenter_.reserve(events.size());
    for (const GuideEvent& event : events) {
      // Relative to their mean, for sums in float.
      const double weight =
          std::min(static_cast<double>(event.weight), most) / sum * static_cast<double>(events.size());
      weights_.push_back(sum > 0 ? static_cast<float>(weight) : 0.0f);
      total_ += static_cast<double>(weights_.back());
      squares += static_cast<double>(weights_.back()) * static_cast<double>(weights_.back());
      Vector3d way(event.direction);
      double near = 0;
      if (std::isfinite(event.distance)) {
        const Vector3d target = Vector3d(event.position) + static_cast<double>(event.distance) * way - Vector3d(center);
        const double distance = glm::length(target);
        if (distance > 0) {
          way = target / distance;
          near = 1 / distance;
        }
      }
      fromCenter_.push_back({Vector3(way), static_cast<float>(near)});
    }
    count_ = squares > 0 ? total_ * total_ / squares : 0;
  }

  MixtureFit Run() {
    if (!(count_ >= kFewestEvents)) return {};
    lobes_.assign(1, Lobe{.kappa = 0, .weight = 1});
    Expect(1, true);
    Maximize();
    for (size_t lobes = 2; lobes <= kLobes; lobes *= 2) {
      Split();
      const bool isLast = lobes == kLobes;
      for (int i = 1; i <= kIterations; ++i) {
        Expect(!isLast ? kStride : i < kIterations ? kStrideOfAll : 1, !isLast && i == kIterations);
        Maximize();
      }
    }
    const double share = std::min(kOfLikeliest * share_, static_cast<double>(kMostShare));
    MixtureFit fit{Mixture(), static_cast<float>(share)};
    if (share < kLeastShare || !fit.mixture.IsValid()) return {};
    return fit;
  }

 private:
  struct FromCenter {
    Vector3 direction;
    float nearness;
  };

  // About one event in `stride`. Not each `stride`-th: the events of a path follow each other, first bounces and second
  // ones in turns. `withMoments`: the lobes are split next.
  void Expect(size_t stride, bool withMoments) {
    sums_ = LobeSums();
    const DirectionMixture mixture = Mixture();
    const bool isFirst = lobes_.size() == 1;  // not placed yet: uniform
    const auto share = static_cast<float>(share_);
    double guided = 0, total = 0;
    for (size_t i = 0; i < events_.size(); ++i) {
      if (stride > 1 && MixBits(i) % stride != 0) continue;
      const GuideEvent& event = events_[i];
      total += static_cast<double>(weights_[i]);
      if (!(event.unguided > 0) || !(weights_[i] > 0)) continue;  // a delta, which no lobe samples
      alignas(32) DirectionMixture::Lanes parts;
      if (isFirst) {
        parts.fill(0.25f * kInvPi);
      } else {
        mixture.Densities(event.position, event.direction, parts);
      }
      float sum = 0;
      for (size_t k = 0; k < kLobes; ++k) {
        parts[k] *= share * mixture.weight[k];
        sum += parts[k];
      }
      const float all = sum + (1 - share) * event.unguided;
      if (!(all > 0)) continue;
      const float scale = weights_[i] / all;
      for (size_t k = 0; k < kLobes; ++k) parts[k] *= scale;
      guided += static_cast<double>(sum * scale);
      sums_.Add(fromCenter_[i].direction, fromCenter_[i].nearness, parts);
      if (withMoments) sums_.AddMoments(fromCenter_[i].direction, parts);
    }
    if (!isFirst && total > 0) share_ = std::clamp(guided / total, 1e-4, 0.98);
  }

  void Maximize() {
    double all = 0;
    for (size_t k = 0; k < lobes_.size(); ++k) all += static_cast<double>(sums_.weight[k]);
    for (size_t k = 0; k < lobes_.size(); ++k) {
      const auto weight = static_cast<double>(sums_.weight[k]);
      Lobe& lobe = lobes_[k];
      lobe.weight = all > 0 ? weight / all : 0.0;
      const Vector3d direction = sums_.Direction(k);
      const double length = glm::length(direction);
      if (!(weight > 0) || !(length > 1e-6 * weight)) {
        lobe.weight = 0;
        continue;
      }
      lobe.mean = direction / length;
      lobe.nearness = static_cast<double>(sums_.nearness[k]) / weight;
      const double count = weight * weight / static_cast<double>(sums_.squares[k]);
      lobe.kappa = KappaOf(length / weight * count / (count + kPriorEvents));
    }
  }

  // Each lobe becomes two, apart by a deviation along the direction in which its events differ most.
  void Split() {
    std::vector<Lobe> halves;
    for (size_t k = 0; k < lobes_.size(); ++k) {
      const Lobe& lobe = lobes_[k];
      const Frame frame = Frame::FromNormal(Normal3(Vector3(lobe.mean)));
      const auto weight = static_cast<double>(sums_.weight[k]);
      const double perWeight = weight > 0 ? 1 / weight : 0;
      const double xx = sums_.SecondMoment(k, frame.x, frame.x) * perWeight,
                   yy = sums_.SecondMoment(k, frame.y, frame.y) * perWeight,
                   xy = sums_.SecondMoment(k, frame.x, frame.y) * perWeight;
      const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
      const double c = std::cos(angle), s = std::sin(angle);
      const double variance = std::max(c * c * xx + 2 * c * s * xy + s * s * yy, 0.0);
      const Vector3d step = std::min(std::sqrt(variance), 0.7) * (c * Vector3d(frame.x) + s * Vector3d(frame.y));
      for (const double sign : {-1.0, 1.0}) {
        Lobe half = lobe;
        half.mean = glm::normalize(lobe.mean + sign * step);
        half.kappa = std::min(1.5 * lobe.kappa, static_cast<double>(DirectionMixture::kMostKappa));
        half.weight = 0.5 * lobe.weight;
        halves.push_back(half);
      }
    }
    lobes_ = std::move(halves);
  }

  DirectionMixture Mixture() const {
    DirectionMixture mixture;
    for (size_t k = 0; k < kLobes; ++k) {
      if (k >= lobes_.size() || !(lobes_[k].weight > 0)) {
        mixture.SetTarget(k, Point3(0.0f, 0.0f, 1.0f), true);
        continue;
      }
      const Lobe& lobe = lobes_[k];
      mixture.weight[k] = static_cast<float>(lobe.weight);
      const double distance = 1 / lobe.nearness;
      const bool isDirection = !(lobe.nearness > 0) || !(distance < 1e15);
      mixture.SetTarget(k, isDirection ? Point3(lobe.mean) : Point3(Vector3d(center_) + distance * lobe.mean),
                        isDirection);
      mixture.kappaPerSquare[k] =
          static_cast<float>(isDirection ? lobe.kappa : lobe.kappa * lobe.nearness * lobe.nearness);
    }
    return mixture;
  }

  std::span<const GuideEvent> events_;
  const Point3 center_;
  std::vector<float> weights_;
  std::vector<FromCenter> fromCenter_;
  double total_ = 0, count_ = 0;  // sum of the weights, and the number of equal ones with the same variance
  double share_ = 0.5;
  std::vector<Lobe> lobes_;
  LobeSums sums_;  // of the last expectation
};

}  // namespace

MixtureFit FitMixture(std::span<const GuideEvent> events, const Point3& center) {
  return Fit(events, center).Run();
}

}  // namespace lampyr
