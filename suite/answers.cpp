#include "suite/answers.h"

#include <cmath>
#include <cstring>
#include <utility>

namespace lampyr::suite {

namespace {

bool SameBits(float a, float b) {
  return std::memcmp(&a, &b, sizeof(float)) == 0;
}

// The numbers of an answer, by name and in a fixed order.
struct Field {
  const char* name;
  int count;
  float values[3];
  bool isBidirectional;
};
using Fields = std::vector<Field>;

struct FieldWriter {
  Fields& fields;
  void operator()(const char* name, float value) const { fields.push_back({name, 1, {value, 0, 0}, false}); }
  void operator()(const char* name, const Vector3& v) const { fields.push_back({name, 3, {v.x, v.y, v.z}, false}); }
  void operator()(const char* name, const Color& c) const { fields.push_back({name, 3, {c.r, c.g, c.b}, false}); }
  void Bidirectional(const char* name, float value) const { fields.push_back({name, 1, {value, 0, 0}, true}); }
};

Fields FieldsOf(const LightSample& s) {
  Fields fields;
  const FieldWriter write{fields};
  write("direction", s.direction);
  write("distance", s.distance);
  write("position", s.position);
  write("positionError", s.positionError);
  write("normal", s.normal);
  write("uvw", s.uvw);
  write("patchIndex", static_cast<float>(s.patchIndex));
  write("diffuse radiance", s.diffuse);
  write("specular radiance", s.specular);
  write("pdfDirect", s.pdfDirect.value);
  write.Bidirectional("pdfEmit", s.pdfEmit.value);
  write.Bidirectional("pdfEmitDirection", s.pdfEmitDirection.value);
  write.Bidirectional("solidAngleToArea", s.solidAngleToArea);
  return fields;
}
Fields FieldsOf(const LightEvaluation& e) {
  Fields fields;
  const FieldWriter write{fields};
  write("normal", e.normal);
  write("diffuse radiance", e.diffuse);
  write("specular radiance", e.specular);
  write("pdfDirect", e.pdfDirect.value);
  write.Bidirectional("pdfEmit", e.pdfEmit.value);
  write.Bidirectional("pdfEmitDirection", e.pdfEmitDirection.value);
  write.Bidirectional("solidAngleToArea", e.solidAngleToArea);
  return fields;
}
Fields FieldsOf(const EmissionSample& p) {
  Fields fields;
  const FieldWriter write{fields};
  write("position", p.position);
  write("positionError", p.positionError);
  write("normal", p.normal);
  write("direction", p.direction);
  write("emissionCosine", p.emissionCosine);
  write("shinesFrom", p.shinesFrom);
  write("uvw", p.uvw);
  write("patchIndex", static_cast<float>(p.patchIndex));
  write("diffuse radiance", p.diffuse);
  write("specular radiance", p.specular);
  write.Bidirectional("pdfEmit", p.pdfEmit.value);
  write.Bidirectional("pdfEmitDirection", p.pdfEmitDirection.value);
  return fields;
}
Fields FieldsOf(const SegmentEstimate& s) {
  Fields fields;
  const FieldWriter write{fields};
  write("radiance", s.radiance);
  write("minT", s.minT);
  write("maxT", s.maxT);
  return fields;
}
Fields FieldsOf(const EmissionBounds& b) {
  Fields fields;
  const FieldWriter write{fields};
  write("lower corner", b.box.min);
  write("upper corner", b.box.max);
  write("axis", b.axis);
  write("cosThetaO", b.cosThetaO);
  write("cosThetaE", b.cosThetaE);
  write("energy", b.energy);
  write("twoSided", b.twoSided ? 1.0f : 0.0f);
  return fields;
}
Fields FieldsOf(const Color& c) {
  Fields fields;
  FieldWriter{fields}("colour", c);
  return fields;
}
Fields FieldsOf(float value) {
  Fields fields;
  FieldWriter{fields}("value", value);
  return fields;
}

std::string ToText(const Field& field) {
  std::string text;
  for (int i = 0; i < field.count; ++i) {
    char number[32];
    std::snprintf(number, sizeof(number), "%s%.9g", i > 0 ? " " : "", static_cast<double>(field.values[i]));
    text += number;
  }
  return text;
}

std::string DifferenceOf(const char* what, const Fields& wanted, const Fields& got, Compare compare) {
  for (size_t i = 0; i < wanted.size(); ++i) {
    const bool isOptional = compare == Compare::AllButBidirectional && wanted[i].isBidirectional;
    if (isOptional && got[i].values[0] == 0) continue;
    for (int k = 0; k < wanted[i].count; ++k) {
      if (SameBits(wanted[i].values[k], got[i].values[k])) continue;
      return std::string(wanted[i].name) + " of " + what + ": " + ToText(got[i]) + " instead of " + ToText(wanted[i]);
    }
  }
  return "";
}

template <class Result>
std::string DifferenceOf(const char* what, const std::optional<Result>& wanted, const std::optional<Result>& got,
                         Compare compare) {
  if (wanted.has_value() != got.has_value()) return std::string(what) + (got ? ": some instead of none" : ": none");
  return wanted ? DifferenceOf(what, FieldsOf(*wanted), FieldsOf(*got), compare) : "";
}

bool SameHits(const std::optional<LocalHit>& a, const std::optional<LocalHit>& b) {
  if (!a || !b) return !a && !b;
  return a->t == b->t && a->position == b->position && a->normal == b->normal && a->uv == b->uv;
}

bool SameSurfaces(const IntersectableLight* a, const IntersectableLight* b) {
  if (!a || !b) return a == b;
  const std::vector<Point3> points = a->GetBounds();
  if (points != b->GetBounds()) return false;
  Bounds3d box;
  for (const Point3& p : points) box.Add(Point3d(p));
  Rng rng(points.size());
  for (int i = 0; i < 256; ++i) {
    Vector3d within;
    for (int k = 0; k < 3; ++k) within[k] = static_cast<double>(rng.NextFloat());
    LocalRay ray;
    ray.direction = RandomDirection(rng);
    ray.tMax = 4 * glm::length(box.Diagonal());
    ray.origin = box.min + within * box.Diagonal() - 0.5 * ray.tMax * ray.direction;
    if (!SameHits(a->Intersect(ray), b->Intersect(ray))) return false;
  }
  return true;
}

}  // namespace

std::vector<Question> MakeQuestions(const SuiteSubject& subject, const Light& light, int count, Rng& rng) {
  std::vector<Question> questions;
  const BoundingSphere& scene = subject.context.scene;
  const bool isAtInfinity = IsAtInfinity(light.Kind());
  for (int i = 0; i < count; ++i) {
    Question question;
    question.context = RandomContext(subject, rng);
    question.reach = scene.radius * rng.NextFloat();
    question.along = Vector3(RandomDirection(rng));
    question.P = scene.center + scene.radius * rng.NextFloat() * Vector3(RandomDirection(rng));
    const float away = scene.radius * std::exp2(8 * (2 * rng.NextFloat() - 1));
    if (const auto photon = light.GenerateEmission(question.context)) {
      const float distance = isAtInfinity ? 2 * scene.radius : away;
      question.firstHit = HitOf(*photon, isAtInfinity ? kInfinity : distance);
      question.firstHitAt = photon->position + distance * photon->direction;
      if (isAtInfinity) question.firstHit->position = question.firstHitAt;
      if (i % 2 == 1) question.P = question.firstHitAt;
    }
    if (const auto sample = light.GenerateSamples(question.context, question.P)) {
      question.hit = HitOf(*sample, question.P);
    }
    questions.push_back(question);
  }
  return questions;
}

Answer Ask(const Light& light, const Question& q, const LightContext& context, CallOrder order) {
  Answer answer;
  const std::function<void()> calls[] = {
      [&] { answer.sample = light.GenerateSamples(context, q.P); },
      [&] { answer.evaluation = q.hit ? light.EvaluateSamples(context, *q.hit, q.P) : std::nullopt; },
      [&] { answer.camera = q.hit ? light.EvaluateEmissionForCamera(context, *q.hit) : Color(0.0f); },
      [&] { answer.photon = light.GenerateEmission(context); },
      [&] { answer.firstHit = q.firstHit ? light.EvaluateSamples(context, *q.firstHit, q.firstHitAt) : std::nullopt; },
      [&] { answer.estimate = light.GetIncidentRadianceEstimate(context, q.P); },
      [&] { answer.segment = light.GetIncidentRadianceEstimate(context, q.P, q.along, q.reach); },
  };
  constexpr size_t count = std::size(calls);
  for (size_t i = 0; i < count; ++i) calls[order == CallOrder::Forwards ? i : count - 1 - i]();
  return answer;
}

namespace {

// The first value of a sample, an evaluation or a photon that cannot be, as text; empty if there is none.
template <class Record>
std::string InvalidOf(const std::optional<Record>& record, const char* what) {
  if (!record) return "";
  for (const Field& field : FieldsOf(*record)) {
    const std::string name = field.name;
    const bool isRadiance = name.ends_with("radiance"), isDensity = name.starts_with("pdf");
    if (!isRadiance && !isDensity) continue;
    for (int i = 0; i < field.count; ++i) {
      const float value = field.values[i];
      if (value >= 0 && (isDensity || std::isfinite(value))) continue;
      return name + " of " + what + " is " + std::to_string(value);
    }
  }
  return "";
}

}  // namespace

std::string Invalid(const Answer& answer) {
  for (const std::string& found : {InvalidOf(answer.sample, "a sample"), InvalidOf(answer.evaluation, "an evaluation"),
                                   InvalidOf(answer.firstHit, "an evaluation"), InvalidOf(answer.photon, "a photon")}) {
    if (!found.empty()) return found;
  }
  return answer.camera.IsValid() ? "" : "what a camera sees is negative, or not finite";
}

std::string Difference(const Answer& wanted, const Answer& got, Compare compare) {
  const auto all = Compare::Everything;
  for (const std::string& difference :
       {DifferenceOf("samples", wanted.sample, got.sample, compare),
        DifferenceOf("evaluations", wanted.evaluation, got.evaluation, compare),
        DifferenceOf("what the camera sees", FieldsOf(wanted.camera), FieldsOf(got.camera), all),
        DifferenceOf("photons", wanted.photon, got.photon, compare),
        DifferenceOf("evaluations where photons land", wanted.firstHit, got.firstHit, compare),
        DifferenceOf("estimates", FieldsOf(wanted.estimate), FieldsOf(got.estimate), all),
        DifferenceOf("estimates of segments", wanted.segment, got.segment, all)}) {
    if (!difference.empty()) return difference;
  }
  return "";
}

Whole AskWhole(const Light& light, const LightContext& context) {
  Whole whole{light.GetPowerEstimate(context), light.GetEmissionBounds(context), {}};
  for (int i = 0; i < std::min(light.PatchCount(), 64); ++i) whole.patches.push_back(light.PatchProbability(i).value);
  return whole;
}

std::string Difference(const Whole& wanted, const Whole& got) {
  const auto all = Compare::Everything;
  for (const std::string& difference : {DifferenceOf("power", FieldsOf(wanted.power), FieldsOf(got.power), all),
                                        DifferenceOf("bounds", wanted.bounds, got.bounds, all)}) {
    if (!difference.empty()) return difference;
  }
  return wanted.patches == got.patches ? "" : "probabilities of patches";
}

std::string DifferenceAsWhole(const SuiteSubject& subject, const Light& wanted, const Light& got) {
  if (wanted.Kind() != got.Kind() || wanted.PatchCount() != got.PatchCount()) return "kind";
  const LightSettings &s = wanted.Settings(), &t = got.Settings();
  if (s.name != t.name || s.lightGroup != t.lightGroup || s.cameraVisible != t.cameraVisible ||
      s.traceLightPaths != t.traceLightPaths || s.importanceMultiplier != t.importanceMultiplier ||
      s.fixedSampleCount != t.fixedSampleCount) {
    return "settings";
  }
  const std::string difference = Difference(AskWhole(wanted, subject.context), AskWhole(got, subject.context));
  if (!difference.empty()) return difference;
  return SameSurfaces(wanted.Surface(), got.Surface()) ? "" : "surface";
}

}  // namespace lampyr::suite
