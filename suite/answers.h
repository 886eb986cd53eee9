// The values that a light's methods return for a fixed set of inputs, compared bit by bit: two lights with each other,
// or one light with itself.
#pragma once

#include "suite/checks.h"

namespace lampyr::suite {

// One edge between a receiver and the light, and one choice of random numbers.
struct Question {
  LightContext context;
  Point3 P{0.0f};
  Vector3 along{0, 0, 1};  // direction of a segment from P
  float reach = 1;
  // `hit`: the light's sample at P. `firstHit`: a photon's start, seen from firstHitAt on the photon's path. Both come
  // from the light for which the question was made.
  std::optional<LightHit> hit, firstHit;
  Point3 firstHitAt{0.0f};
};

struct Answer {
  std::optional<LightSample> sample;
  std::optional<LightEvaluation> evaluation, firstHit;
  Color camera{0.0f};
  std::optional<EmissionSample> photon;
  float estimate = 0;
  std::optional<SegmentEstimate> segment;
};

// `count` questions. Receivers lie throughout the scene and on photon paths, from very near the light to far away.
std::vector<Question> MakeQuestions(const SuiteSubject& subject, const Light& light, int count, Rng& rng);

// Order in which the methods are called. Reversing it reveals state kept between calls.
enum class CallOrder { Forwards, Backwards };
Answer Ask(const Light& light, const Question& question, const LightContext& context,
           CallOrder order = CallOrder::Forwards);
inline Answer Ask(const Light& light, const Question& question) {
  return Ask(light, question, question.context);
}

// Values to compare. Densities that only bidirectional techniques use may be 0 in AllButBidirectional.
enum class Compare { Everything, AllButBidirectional };

// The first difference as text, such as "radiance of samples: 1 0.5 0.2 instead of 2 1 0.4"; empty if there is none.
std::string Difference(const Answer& wanted, const Answer& got, Compare compare = Compare::Everything);
// The first value that cannot be, as text, such as "pdfDirect of a sample is nan"; empty if there is none.
std::string Invalid(const Answer& answer);
// The first difference, as text, of values that no question affects: kind, settings, power, bounds, patches, and the
// light's own surface. Empty if there is none.
std::string DifferenceAsWhole(const SuiteSubject& subject, const Light& wanted, const Light& got);

// The power, bounds and choice of patches of a light, for comparing it with itself.
struct Whole {
  Color power{0.0f};
  std::optional<EmissionBounds> bounds;
  std::vector<float> patches;
};
Whole AskWhole(const Light& light, const LightContext& context);
std::string Difference(const Whole& wanted, const Whole& got);

}  // namespace lampyr::suite
