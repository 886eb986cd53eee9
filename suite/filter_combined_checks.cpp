// A filter combined with others, against a second implementation of the arithmetic of each combine mode.
#include <algorithm>
#include <array>

#include "suite/filter_checks.h"

namespace lampyr::suite {

namespace {

constexpr double kRounding = 2e-5;
constexpr std::array<const char*, 4> kModes = {"multiply", "max", "min", "screen"};

double Combined(const std::string& mode, double a, double b) {
  if (mode == "multiply") return a * b;
  if (mode == "max") return a > b ? a : b;
  if (mode == "min") return a < b ? a : b;
  return std::max(1 - (1 - a) * (1 - b), 0.0);
}

Color Combined(const std::string& mode, const Color& a, const Color& b) {
  const auto channel = [&](float x, float y) {
    return static_cast<float>(Combined(mode, static_cast<double>(x), static_cast<double>(y)));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}
Filtered Combined(const std::string& mode, const Filtered& a, const Filtered& b) {
  return {Combined(mode, a.diffuse, b.diffuse), Combined(mode, a.specular, b.specular)};
}

std::string Quoted(const char* type, const char* name, const std::string& value) {
  return std::string("\"") + type + " " + name + "\" \"" + value + "\" ";
}

// Combines the filter under test with one or two constant filters.
class CombinedCheck {
 public:
  CombinedCheck(const FilterCase& filterCase, SuiteReport& report)
      : case_(filterCase),
        report_(report),
        rng_(filterCase.MakeRng()),
        edges_(filterCase.Edges(rng_)),
        alone_(edges_.Filter(*filterCase.maker->Make(filterCase.changes, filterCase.placement), ContextAt(0))),
        combiner_(filterCase.maker->Has("filters") ? filterCase.maker->Type() : *FindFilterType("combiner")),
        combinerMaker_(combiner_, "", "."),
        tint_(*FindFilterType("intmult"), "", ".") {}

  void Run();

 private:
  static constexpr const char* kBeside = "\"rgb tint\" [ 0.7 0.35 0.9 ]";
  static constexpr const char* kAfter = "\"rgb tint\" [ 0.9 1.2 0.5 ]";

  FilterInstance Named(FilterInstance instance, const char* name, uint32_t linking = 0) const {
    instance.name = name;
    instance.linking = linking;
    return instance;
  }
  FilterInstance Tested(const std::string& mode, uint32_t linking = 0) const {
    return Named(
        case_.maker->MakeInstance(case_.changes + "\n" + Quoted("string", "combineMode", mode), case_.placement),
        "tested", linking);
  }
  FilterInstance Constant(const char* name, const char* tint, const std::string& mode) const {
    return Named(tint_.MakeInstance(tint + (" " + Quoted("string", "combineMode", mode)), Transform()), name);
  }
  // Light filtered by a combiner of `filters`, in this order.
  std::vector<Filtered> Run(const std::vector<FilterInstance>& filters, const std::string& parameters,
                            const FilterContext& context) const;
  void Expect(const std::vector<Filtered>& found, const std::string& how,
              const std::function<Filtered(const Filtered&)>& right, WorstEdge& worst) const;

  const FilterCase& case_;
  SuiteReport& report_;
  Rng rng_;
  EdgeBatch edges_;
  std::vector<Filtered> alone_;
  const FilterType& combiner_;
  FilterMaker combinerMaker_, tint_;
};

std::vector<Filtered> CombinedCheck::Run(const std::vector<FilterInstance>& filters, const std::string& parameters,
                                         const FilterContext& context) const {
  FilterBuildContext build;
  build.transform = PlacedBy(case_.placement);
  build.find = [&](const std::string& name, const FileLocation& where) {
    for (const FilterInstance& filter : filters) {
      if (filter.name == name) return filter;
    }
    throw Error(where, "there is no filter \"" + name + "\"");
  };
  std::string names;
  for (const FilterInstance& filter : filters) names += (names.empty() ? "" : ", ") + filter.name;
  const auto combiner =
      MakeFilter(combiner_, combinerMaker_.Parameters(Quoted("string", "filters", names) + parameters), build);
  return edges_.Filter(*combiner, context);
}

void CombinedCheck::Expect(const std::vector<Filtered>& found, const std::string& how,
                           const std::function<Filtered(const Filtered&)>& right, WorstEdge& worst) const {
  for (size_t i = 0; i < found.size(); ++i) {
    const Filtered expected = right(alone_[i]);
    worst.Note(Difference(found[i], expected),
               [&] { return how + ", " + edges_.Say(i) + ": " + SayDifference(found[i], expected); });
  }
}

void CombinedCheck::Run() {
  WorstEdge worst(kRounding);
  const Color besideColor(0.7f, 0.35f, 0.9f), afterColor(0.9f, 1.2f, 0.5f);
  const Filtered beside{besideColor, besideColor}, after{afterColor, afterColor}, white{Color(1.0f), Color(1.0f)};
  const uint8_t off[] = {1, 0};
  for (const std::string mode : kModes) {
    const std::vector<FilterInstance> filters = {Tested(mode), Constant("beside", kBeside, mode),
                                                 Constant("after", kAfter, "multiply")};
    Expect(
        Run(filters, "", ContextAt(0)), "by " + mode + " with (0.7 0.35 0.9), times (0.9 1.2 0.5)",
        [&](const Filtered& factor) { return Combined("multiply", Combined(mode, factor, beside), after); }, worst);
    Expect(
        Run({Tested(mode)}, "", ContextAt(0)), "alone by " + mode, [](const Filtered& factor) { return factor; },
        worst);
    // The combiner's own mode overrides those of the filters that it runs.
    const std::string other = mode == "max" ? "min" : "max";
    if (combinerMaker_.Has("mode")) {
      Expect(
          Run({Tested(other), Constant("beside", kBeside, other)}, Quoted("string", "mode", mode), ContextAt(0)),
          "by the combiner's mode " + mode + " with (0.7 0.35 0.9)",
          [&](const Filtered& factor) { return Combined(mode, factor, beside); }, worst);
    }
    const std::vector<FilterInstance> grouped = {Tested(mode, 1), Constant("beside", kBeside, mode)};
    Expect(
        Run(grouped, "", {0, kEnabled}), "enabled, by " + mode + " with (0.7 0.35 0.9)",
        [&](const Filtered& factor) { return Combined(mode, factor, beside); }, worst);
    Expect(
        Run(grouped, "", {0, off}), "not enabled, by " + mode + " with (0.7 0.35 0.9)",
        [&](const Filtered&) { return beside; }, worst);
    Expect(
        Run({Tested(mode, 1)}, "", {0, nullptr}), "alone by " + mode + ", where no group is enabled",
        [&](const Filtered&) { return white; }, worst);
  }
  worst.Report(case_, "combine", report_);
}

}  // namespace

void CheckFilterCombined(const FilterCase& filterCase, SuiteReport& report) {
  if (filterCase.maker->Has("combineMode")) CombinedCheck(filterCase, report).Run();
}

}  // namespace lampyr::suite
