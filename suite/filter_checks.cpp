// Checks that a filter is a function of the edge and of nothing else, and a factor.
#include "suite/filter_checks.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <thread>

namespace lampyr::suite {

namespace {

constexpr int kEdgesPerKind = 8;
// Relative tolerance for the same result computed twice in float, in different order.
constexpr double kRounding = 1e-5;

double ChannelDifference(float a, float b) {
  if (a == b) return 0;
  const double x = static_cast<double>(a), y = static_cast<double>(b);
  return std::abs(x - y) / std::max({1.0, std::abs(x), std::abs(y)});
}

std::vector<size_t> Indices(size_t count) {
  std::vector<size_t> indices(count);
  std::iota(indices.begin(), indices.end(), size_t{0});
  return indices;
}
void Shuffle(std::vector<size_t>& indices, Rng& rng) {
  for (size_t i = indices.size(); i > 1; --i) std::swap(indices[i - 1], indices[rng.NextUint32() % i]);
}

// One filter, and its results for white light from the first query.
class FunctionCheck {
 public:
  FunctionCheck(const FilterCase& filterCase, SuiteReport& report)
      : case_(filterCase),
        report_(report),
        rng_(filterCase.MakeRng()),
        filter_(filterCase.maker->Make(filterCase.changes, filterCase.placement)),
        edges_(filterCase.Edges(rng_)),
        first_(edges_.Filter(*filter_, ContextAt(0))) {}

  void Run() {
    CheckManyEdges();
    CheckRepeat();
    CheckBatches();
    if (case_.changes.empty()) CheckThreads();
    CheckTimes();
    CheckLightPdf();
    CheckValid();
    CheckLight();
    CheckIdentity();
    CheckModifier();
  }

 private:
  // Requires the same bits as in the first query.
  void ExpectFirst(size_t edge, const Filtered& found, const std::string& how, WorstEdge& worst) const {
    if (IsSame(found, first_[edge])) return;
    // Equal bits are required: a difference in the bits alone is an error too.
    worst.Note(std::max(Difference(found, first_[edge]), 1e-9),
               [&] { return how + ", " + edges_.Say(edge) + ": " + SayDifference(found, first_[edge]); });
  }
  void ExpectFirst(std::span<const size_t> order, const std::vector<Filtered>& found, const std::string& how,
                   WorstEdge& worst) const {
    for (size_t i = 0; i < order.size(); ++i) ExpectFirst(order[i], found[i], how, worst);
  }

  void CheckManyEdges();
  void CheckRepeat();
  void CheckBatches();
  void CheckThreads();
  void CheckTimes();
  void CheckLightPdf();
  void CheckValid();
  void CheckLight();
  void CheckIdentity();
  void CheckModifier();

  const FilterCase& case_;
  SuiteReport& report_;
  Rng rng_;
  std::shared_ptr<const LightFilter> filter_;
  EdgeBatch edges_;
  std::vector<Filtered> first_;
};

void FunctionCheck::CheckRepeat() {
  WorstEdge worst(0);
  const std::vector<size_t> all = Indices(edges_.Size());
  ExpectFirst(all, edges_.Filter(*filter_, ContextAt(0)), "asked for the second time", worst);
  for (const size_t i : all) {
    const Filtered once = edges_.FilterOne(i, *filter_, ContextAt(0));
    const Filtered again = edges_.FilterOne(i, *filter_, ContextAt(0));
    if (IsSame(once, again)) continue;
    worst.Note(std::max(Difference(again, once), 1e-9),
               [&] { return "asked twice alone, " + edges_.Say(i) + ": " + SayDifference(again, once); });
  }
  ExpectFirst(all, edges_.Filter(*filter_, ContextAt(0)), "asked again after other edges", worst);
  worst.Report(case_, "repeat", report_);
}

void FunctionCheck::CheckBatches() {
  WorstEdge worst(0);
  std::vector<size_t> order = Indices(edges_.Size());
  for (const size_t i : order)
    ExpectFirst(i, edges_.FilterOne(i, *filter_, ContextAt(0)), "alone, not in a batch", worst);
  const auto ask = [&](std::span<const size_t> some, const std::string& how) {
    ExpectFirst(some, edges_.Pick(some).Filter(*filter_, ContextAt(0)), how, worst);
  };
  std::reverse(order.begin(), order.end());
  ask(order, "in a batch in reverse order");
  for (const size_t size : {2, 3, 7, 64, 65}) {
    Shuffle(order, rng_);
    const size_t count = std::min(size, order.size());
    ask(std::span(order).first(count), "in a batch of " + std::to_string(count) + " others");
  }
  worst.Report(case_, "batch", report_);
}

void FunctionCheck::CheckThreads() {
  WorstEdge worst(0);
  std::vector<size_t> order = Indices(edges_.Size());
  Shuffle(order, rng_);
  const EdgeBatch shuffled = edges_.Pick(order);
  std::vector<Filtered> alone(edges_.Size()), together;
  std::thread one([&] {
    for (const size_t i : order) alone[i] = edges_.FilterOne(i, *filter_, ContextAt(0));
  });
  std::thread two([&] { together = shuffled.Filter(*filter_, ContextAt(0)); });
  one.join();
  two.join();
  ExpectFirst(Indices(edges_.Size()), alone, "alone on another thread", worst);
  ExpectFirst(order, together, "in a batch on another thread", worst);
  worst.Report(case_, "threads", report_);
}

void FunctionCheck::CheckTimes() {
  WorstEdge worst(0);
  const std::vector<size_t> all = Indices(edges_.Size());
  for (const float time : {0.25f, 0.5f, rng_.NextFloat(), 1.0f}) {
    ExpectFirst(all, edges_.Filter(*filter_, ContextAt(time)), "at time " + std::to_string(time), worst);
  }
  worst.Report(case_, "time", report_);
}

void FunctionCheck::CheckLightPdf() {
  WorstEdge worst(0);
  const std::vector<size_t> all = Indices(edges_.Size());
  for (const float scale : {0.01f, 1.0f, 300.0f}) {
    EdgeBatch changed = edges_;
    for (PdfSolidAngle& pdf : changed.pdfs) pdf = PdfSolidAngle(scale * (0.5f + rng_.NextFloat()));
    ExpectFirst(all, changed.Filter(*filter_, ContextAt(0)), "with another density of the light's sampling", worst);
  }
  worst.Report(case_, "light-pdf", report_);
}

// Size of the most negative component; kNoNumber if a component is not finite.
double Invalidity(const Color& color) {
  const float least = std::min({color.r, color.g, color.b, 0.0f});
  return std::isfinite(color.r + color.g + color.b) ? -static_cast<double>(least) : kNoNumber;
}

// Tests many edges, because a filter may be wrong for few only. Uses its own random numbers.
void FunctionCheck::CheckManyEdges() {
  constexpr size_t kManyEdges = 2048;
  constexpr uint64_t kOther = 0x65646765;
  Rng rng(Hash(case_.seed, kOther));
  WorstEdge worst(0);
  for (size_t asked = 0; asked < kManyEdges;) {
    const EdgeBatch edges = case_.Edges(rng);
    const std::vector<Filtered> left = edges.Filter(*filter_, ContextAt(0));
    for (size_t i = 0; i < left.size(); ++i) {
      for (const Color& found : {left[i].diffuse, left[i].specular})
        worst.Note(Invalidity(found), [&] { return edges.Say(i) + ": there is left " + Say(found); });
    }
    if (edges.Size() == 0) break;
    asked += edges.Size();
  }
  FilterCase many = case_;
  many.caseName += ", many edges";
  worst.Report(many, "valid", report_);
}

// Checks white light, and coloured light of any strength.
void FunctionCheck::CheckValid() {
  WorstEdge worst(0);
  EdgeBatch light = edges_;
  for (int round = 0; round < 3; ++round) {
    const std::vector<Filtered> left = light.Filter(*filter_, ContextAt(0));
    for (size_t i = 0; i < left.size(); ++i) {
      for (const bool isDiffuse : {true, false}) {
        const Color& found = isDiffuse ? left[i].diffuse : left[i].specular;
        worst.Note(Invalidity(found), [&] {
          const Color& given = isDiffuse ? light.diffuse[i] : light.specular[i];
          return light.Say(i) + ": of the light " + Say(given) + " for " + (isDiffuse ? "diffuse" : "specular") +
                 " lobes there is left " + Say(found);
        });
      }
    }
    for (size_t i = 0; i < light.Size(); ++i) {
      const float strength = round == 0 ? 1.0f : 1e6f;
      light.diffuse[i] = strength * Color(rng_.NextFloat(), rng_.NextFloat(), rng_.NextFloat());
      light.specular[i] = strength * Color(rng_.NextFloat(), 0, rng_.NextFloat());
    }
  }
  worst.Report(case_, "valid", report_);
}

void FunctionCheck::CheckLight() {
  WorstEdge worst(kRounding);
  EdgeBatch light = edges_;
  for (size_t i = 0; i < light.Size(); ++i) {
    light.diffuse[i] = Color(rng_.NextFloat(), rng_.NextFloat(), rng_.NextFloat());
    light.specular[i] = Color(rng_.NextFloat(), rng_.NextFloat(), rng_.NextFloat());
  }
  const std::vector<Filtered> left = light.Filter(*filter_, ContextAt(0));
  const auto compare = [&](const EdgeBatch& changed, float diffuse, float specular, const std::string& how) {
    const std::vector<Filtered> found = changed.Filter(*filter_, ContextAt(0));
    for (size_t i = 0; i < found.size(); ++i) {
      // Scaled back to the original strength, so that differences in dim light count.
      const Filtered scaled{diffuse > 0 ? found[i].diffuse / diffuse : found[i].diffuse,
                            specular > 0 ? found[i].specular / specular : found[i].specular};
      const Filtered right{diffuse > 0 ? left[i].diffuse : Color(0.0f), specular > 0 ? left[i].specular : Color(0.0f)};
      worst.Note(Difference(scaled, right),
                 [&] { return how + ", " + light.Say(i) + ": " + SayDifference(scaled, right); });
    }
  };
  for (const float scale : {0x1p-20f, 2.0f, 0x1p20f}) {
    EdgeBatch changed = light;
    for (Color& color : changed.diffuse) color *= scale;
    for (Color& color : changed.specular) color *= scale;
    compare(changed, scale, scale, "light of " + std::to_string(scale) + " times the strength (brought back to once)");
  }
  EdgeBatch dark = light;
  std::fill(dark.diffuse.begin(), dark.diffuse.end(), Color(0.0f));
  compare(dark, 0, 1, "without light for diffuse lobes");
  dark = light;
  std::fill(dark.specular.begin(), dark.specular.end(), Color(0.0f));
  compare(dark, 1, 0, "without light for specular lobes");
  worst.Report(case_, "light", report_);
}

void FunctionCheck::CheckIdentity() {
  if (!filter_->IsIdentity()) return;
  WorstEdge worst(kRounding);
  const Filtered white{Color(1.0f), Color(1.0f)};
  for (size_t i = 0; i < first_.size(); ++i) {
    worst.Note(Difference(first_[i], white),
               [&] { return "IsIdentity, but " + edges_.Say(i) + ": " + SayDifference(first_[i], white); });
  }
  worst.Report(case_, "identity", report_);
}

// The error is the number of powers of ten by which the transmitted light exceeds GetRadianceModifier.
void FunctionCheck::CheckModifier() {
  const std::optional<float> modifier = filter_->GetRadianceModifier();
  if (!modifier) return;
  WorstEdge worst(1);
  const std::string says = "GetRadianceModifier says " + std::to_string(*modifier);
  if (!(*modifier >= 0 && *modifier < kInfinity)) {
    worst.Note(kNoNumber, [&] { return says + ": not negative, and finite, would be right"; });
  }
  for (size_t i = 0; i < first_.size(); ++i) {
    const double through = static_cast<double>(std::max(first_[i].diffuse.Average(), first_[i].specular.Average()));
    if (!(through > 0)) continue;
    const double ratio = through / static_cast<double>(*modifier);
    worst.Note(*modifier > 0 ? std::log10(ratio) : kNoNumber, [&] {
      return says + ", but of white light there gets through " + std::to_string(through) + ", " + edges_.Say(i);
    });
  }
  worst.Report(case_, "modifier", report_);
}

}  // namespace

double Difference(const Color& a, const Color& b) {
  const double difference =
      std::max({ChannelDifference(a.r, b.r), ChannelDifference(a.g, b.g), ChannelDifference(a.b, b.b)});
  return std::isfinite(a.r + a.g + a.b) && std::isfinite(b.r + b.g + b.b) ? difference : kNoNumber;
}

double Difference(const Filtered& a, const Filtered& b) {
  return std::max(Difference(a.diffuse, b.diffuse), Difference(a.specular, b.specular));
}

std::string SayDifference(const Filtered& found, const Filtered& right) {
  const bool isDiffuse = Difference(found.diffuse, right.diffuse) >= Difference(found.specular, right.specular);
  return std::string(isDiffuse ? "diffuse" : "specular") + " light is " +
         Say(isDiffuse ? found.diffuse : found.specular) + ", right is " +
         Say(isDiffuse ? right.diffuse : right.specular);
}

void WorstEdge::Report(const FilterCase& filterCase, const std::string& property, SuiteReport& report) const {
  report.AddError(filterCase.name, property, filterCase.caseName + (words_.empty() ? "" : ": " + words_), error_,
                  tolerance_);
}

EdgeBatch FilterCase::Edges(Rng& rng) const {
  return {SuiteEdges(rng, kEdgesPerKind), placement, rng};
}

void CheckFilterFunction(const FilterCase& filterCase, SuiteReport& report) {
  FunctionCheck(filterCase, report).Run();
}

void CheckFilterChanges(const FilterCase& filterCase, SuiteReport& report) {
  Rng rng = filterCase.MakeRng();
  const auto filter = filterCase.maker->Make(filterCase.changes, filterCase.placement);
  double largest = 0;
  for (const Filtered& left : filterCase.Edges(rng).Filter(*filter, ContextAt(0))) {
    largest = std::max(largest, Difference(left, {Color(1.0f), Color(1.0f)}));
  }
  const std::string words = largest > 1e-3 ? "" : ": it changes no light on any edge: nothing of it is proved";
  report.AddError(filterCase.name, "samples", filterCase.caseName + words, largest > 1e-3 ? 0 : 1, 0.5);
}

}  // namespace lampyr::suite
