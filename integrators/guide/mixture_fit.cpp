#include "integrators/guide/mixture_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/frame.h"

namespace lampyr {

namespace {

constexpr size_t kLobes = DirectionMixture::kLobes;
// Iterations after each doubling of the lobes.
constexpr int kIterations = 4;
// Effective number of uniformly distributed events that each lobe is mixed with: few events do not make a narrow lobe.
constexpr double kPriorEvents = 0.3;
// A region whose events have a smaller effective number is not guided.
constexpr double kFewestEvents = 12;
// Most of the weight of a region that one event may have.
constexpr double kLargestPart = 0.1;
// An expected share below this is not worth its evaluation.
constexpr double kLeastShare = 0.02;

// A lobe while it is fitted, as seen from the center of the region.
struct Lobe {
  Vector3d mean{0.0, 0.0, 1.0};  // unit
  double nearness = 0;           // 1 / distance of the target; 0: at infinity
  double kappa = 1, weight = 0;
};

// Sums over the events of a lobe, each by its share of the event.
struct LobeSums {
  double weight = 0, squares = 0, nearness = 0;
  Vector3d direction{0.0};
  double moments[6] = {0, 0, 0, 0, 0, 0};  // of the direction: xx, yy, zz, xy, xz, yz

  void Add(const Vector3d& d, double near, double part) {
    weight += part;
    squares += part * part;
    nearness += part * near;
    direction += part * d;
  }
  void AddMoments(const Vector3d& d, double part) {
    moments[0] += part * d.x * d.x;
    moments[1] += part * d.y * d.y;
    moments[2] += part * d.z * d.z;
    moments[3] += part * d.x * d.y;
    moments[4] += part * d.x * d.z;
    moments[5] += part * d.y * d.z;
  }
  double SecondMoment(const Vector3d& a, const Vector3d& b) const {
    return a.x * b.x * moments[0] + a.y * b.y * moments[1] + a.z * b.z * moments[2] +
           (a.x * b.y + a.y * b.x) * moments[3] + (a.x * b.z + a.z * b.x) * moments[4] +
           (a.y * b.z + a.z * b.y) * moments[5];
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
      weights_.push_back(std::min(static_cast<double>(event.weight), most));
      total_ += weights_.back();
      squares += weights_.back() * weights_.back();
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
      fromCenter_.push_back({way, near});
    }
    count_ = squares > 0 ? total_ * total_ / squares : 0;
  }

  MixtureFit Run() {
    if (!(count_ >= kFewestEvents)) return {};
    lobes_.assign(1, Lobe{.kappa = 0, .weight = 1});
    Maximize(Expect(true, true));
    for (size_t lobes = 2; lobes <= kLobes; lobes *= 2) {
      Split();
      for (int i = 1; i <= kIterations; ++i) Maximize(Expect(false, i == kIterations && lobes < kLobes));
    }
    MixtureFit fit{Mixture(), static_cast<float>(std::min(share_, static_cast<double>(kMostShare)))};
    if (share_ < kLeastShare || !fit.mixture.IsValid()) return {};
    return fit;
  }

 private:
  struct FromCenter {
    Vector3d direction;
    double nearness;
  };

  // `isFirst`: all events are the lobe's, in the part that scattering leaves. `withMoments`: the lobes are split next.
  std::vector<LobeSums> Expect(bool isFirst, bool withMoments) {
    std::vector<LobeSums> sums(lobes_.size());
    const DirectionMixture mixture = Mixture();
    double guided = 0;
    for (size_t i = 0; i < events_.size(); ++i) {
      const GuideEvent& event = events_[i];
      if (!(event.unguided > 0) || !(weights_[i] > 0)) continue;  // a delta: no lobe's
      alignas(32) DirectionMixture::Lanes densities;
      if (isFirst) {
        densities.fill(0.25f * kInvPi);
      } else {
        mixture.Densities(event.position, event.direction, densities);
      }
      double all = (1 - share_) * static_cast<double>(event.unguided);
      for (size_t k = 0; k < lobes_.size(); ++k) all += share_ * lobes_[k].weight * static_cast<double>(densities[k]);
      if (!(all > 0)) continue;
      for (size_t k = 0; k < lobes_.size(); ++k) {
        const double part = weights_[i] * share_ * lobes_[k].weight * static_cast<double>(densities[k]) / all;
        guided += part;
        sums[k].Add(fromCenter_[i].direction, fromCenter_[i].nearness, part);
        if (withMoments) sums[k].AddMoments(fromCenter_[i].direction, part);
      }
    }
    if (!isFirst) share_ = std::clamp(guided / total_, 1e-4, 0.98);
    return sums;
  }

  void Maximize(std::vector<LobeSums>&& sums) {
    sums_ = std::move(sums);
    double all = 0;
    for (const LobeSums& sum : sums_) all += sum.weight;
    for (size_t k = 0; k < lobes_.size(); ++k) {
      const LobeSums& sum = sums_[k];
      Lobe& lobe = lobes_[k];
      lobe.weight = all > 0 ? sum.weight / all : 0.0;
      const double length = glm::length(sum.direction);
      if (!(sum.weight > 0) || !(length > 1e-12 * sum.weight)) {
        lobe.weight = 0;
        continue;
      }
      lobe.mean = sum.direction / length;
      lobe.nearness = sum.nearness / sum.weight;
      const double count = sum.weight * sum.weight / sum.squares;
      lobe.kappa = KappaOf(length / sum.weight * count / (count + kPriorEvents));
    }
  }

  // Each lobe becomes two, apart by a deviation along the direction in which its events differ most.
  void Split() {
    std::vector<Lobe> halves;
    for (size_t k = 0; k < lobes_.size(); ++k) {
      const Lobe& lobe = lobes_[k];
      const Frame frame = Frame::FromNormal(Normal3(Vector3(lobe.mean)));
      const Vector3d x(frame.x), y(frame.y);
      const LobeSums& sum = sums_[k];
      const double perWeight = sum.weight > 0 ? 1 / sum.weight : 0;
      const double xx = sum.SecondMoment(x, x) * perWeight, yy = sum.SecondMoment(y, y) * perWeight,
                   xy = sum.SecondMoment(x, y) * perWeight;
      const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
      const double c = std::cos(angle), s = std::sin(angle);
      const double variance = std::max(c * c * xx + 2 * c * s * xy + s * s * yy, 0.0);
      const Vector3d step = std::min(std::sqrt(variance), 0.7) * (c * x + s * y);
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
  std::vector<double> weights_;
  std::vector<FromCenter> fromCenter_;
  double total_ = 0, count_ = 0;  // sum of the weights, and the number of equal ones with the same variance
  double share_ = 0.5;
  std::vector<Lobe> lobes_;
  std::vector<LobeSums> sums_;  // of the last expectation
};

}  // namespace

MixtureFit FitMixture(std::span<const GuideEvent> events, const Point3& center) {
  return Fit(events, center).Run();
}

}  // namespace lampyr
