// Placement of a filter: in any placement, however it is given, the factor equals that of the same edge in the filter's
// own space.
//
// A factor may have steps, and rounding may move a placed edge across a step: the value on the other side is correct
// too. A factor is therefore compared with the range of the factors of the edge's neighbours. The range is widened by
// its own width at both ends, because a few neighbours do not find the extremes of a factor that changes many times
// among them.
#include <algorithm>

#include "math/motion.h"
#include "suite/filter_checks.h"

namespace lampyr::suite {

namespace {

constexpr int kEdgesPerKind = 5;
constexpr double kRounding = 2e-5;
constexpr double kAtOrigin = 1e-4;

struct FactorRange {
  Filtered low, high;

  // The correct value nearest to `left`.
  Filtered Nearest(const Filtered& left) const {
    const auto clamp = [](const Color& c, const Color& least, const Color& most) {
      return Color(std::clamp(c.r, least.r, most.r), std::clamp(c.g, least.g, most.g),
                   std::clamp(c.b, least.b, most.b));
    };
    return {clamp(left.diffuse, low.diffuse, high.diffuse), clamp(left.specular, low.specular, high.specular)};
  }
};

FactorRange RangeOf(const std::vector<Filtered>& factors) {
  const auto with = [](const Color& a, const Color& b, const auto& choose) {
    return Color(choose(a.r, b.r), choose(a.g, b.g), choose(a.b, b.b));
  };
  const auto least = [](float a, float b) { return std::min(a, b); };
  const auto most = [](float a, float b) { return std::max(a, b); };
  FactorRange range{factors.front(), factors.front()};
  for (const Filtered& factor : factors) {
    range.low = {with(range.low.diffuse, factor.diffuse, least), with(range.low.specular, factor.specular, least)};
    range.high = {with(range.high.diffuse, factor.diffuse, most), with(range.high.specular, factor.specular, most)};
  }
  const auto widen = [](Color& low, Color& high) {
    const Color width = high - low;
    low = low - width;
    high += width;
  };
  widen(range.low.diffuse, range.high.diffuse);
  widen(range.low.specular, range.high.specular);
  return range;
}

class PlaceCheck {
 public:
  PlaceCheck(const FilterCase& filterCase, SuiteReport& report)
      : case_(filterCase), report_(report), rng_(filterCase.MakeRng()), edges_(SuiteEdges(rng_, kEdgesPerKind)) {
    // From a receiver at the filter's origin, the origin has no direction: the factor there depends on rounding alone.
    std::erase_if(edges_, [](const SuiteEdge& edge) { return glm::length(edge.receiver) < kAtOrigin; });
    const auto inPlace = filterCase.maker->Make(filterCase.changes, Transform());
    for (const SuiteEdge& edge : edges_) {
      const EdgeBatch around(Neighbours(edge, rng_), Transform(), rng_);
      ranges_.push_back(RangeOf(around.Filter(*inPlace, ContextAt(0))));
    }
  }

  void Run() {
    WorstEdge placed(kRounding);
    Expect(*case_.maker->Make(case_.changes, case_.placement), case_.placement, 0, "", placed);
    placed.Report(case_, "placement", report_);
    if (!case_.maker->Has("coordsys")) return;
    WorstEdge named(kRounding);
    Expect(*case_.maker->MakeByName(case_.changes, case_.placement), case_.placement, 0,
           "in a named coordinate system, ", named);
    named.Report(case_, "coordsys", report_);
    WorstEdge moving(kRounding);
    CheckMotion(moving);
    moving.Report(case_, "motion", report_);
  }

 private:
  // Edges are transformed as the filter is, so the factors must be those in the filter's own space.
  void Expect(const LightFilter& filter, const Transform& placement, float time, const std::string& how,
              WorstEdge& worst) {
    const EdgeBatch placed(edges_, placement, rng_);
    const std::vector<Filtered> left = placed.Filter(filter, ContextAt(time));
    for (size_t i = 0; i < left.size(); ++i) {
      const Filtered right = ranges_[i].Nearest(left[i]);
      worst.Note(Difference(left[i], right),
                 [&] { return how + placed.Say(i) + ": " + SayDifference(left[i], right); });
    }
  }

  // The filter moves from its placement to another and rotates on its way.
  void CheckMotion(WorstEdge& worst) {
    const FileLocation nowhere;
    const Transform end =
        case_.placement * Transform::Translate({0.4, -0.3, 0.5}) * Transform::Rotate(35, {0.3, 1, 0.2});
    const MotionChain chain =
        MotionChain(Transform()) * AnimatedTransform(case_.placement, end, "a light filter", nowhere);
    const auto motion = MakeMotion(chain, {}, {}, "a light filter", nowhere);
    const auto filter = case_.maker->MakeMoving(case_.changes, motion);
    for (const float time : {0.0f, 0.3f, 0.5f, 1.0f}) {
      const Affine at = motion->At(time);
      glm::dmat4 matrix{glm::dmat3(at.linear)};
      matrix[3] = glm::dvec4(Vector3d(at.translation), 1);
      Expect(*filter, Transform(matrix), time, "at time " + std::to_string(time) + " of a motion, ", worst);
    }
  }

  const FilterCase& case_;
  SuiteReport& report_;
  Rng rng_;
  std::vector<SuiteEdge> edges_;
  std::vector<FactorRange> ranges_;
};

}  // namespace

void CheckFilterPlace(const FilterCase& filterCase, SuiteReport& report) {
  PlaceCheck(filterCase, report).Run();
}

}  // namespace lampyr::suite
