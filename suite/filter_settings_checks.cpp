// Effects of the parameters common to filters: density, invert, diffuse, specular, linkingGroups.
#include <algorithm>

#include "suite/filter_checks.h"

namespace lampyr::suite {

namespace {

// Tolerance for a few roundings of float.
constexpr double kRounding = 2e-5;

// Parameters that neutralise the common parameters of a block, so that its factor alone is left.
std::string Neutral(const FilterMaker& maker) {
  std::string text;
  for (const char* strength : {"density", "diffuse", "specular"}) {
    if (maker.Has(strength)) text += "\"float " + std::string(strength) + "\" 1 ";
  }
  if (maker.Has("invert")) text += "\"bool invert\" false ";
  return text;
}

struct Setting {
  const char* property;
  std::vector<std::string> needs;  // parameters that the type's table has to have
  float density = 1, diffuse = 1, specular = 1;
  bool invert = false;

  std::string Parameters() const {
    std::string text;
    for (const std::string& name : needs) {
      const float value = name == "density" ? density : name == "diffuse" ? diffuse : specular;
      text += name == "invert" ? std::string("\"bool invert\" ") + (invert ? "true " : "false ")
                               : "\"float " + name + "\" " + std::to_string(value) + " ";
    }
    return text;
  }
  // The factor applied by a filter of factor `factor`. In double, so that the reference does not round as the filter
  // does.
  Color Applied(const Color& factor, float ofLobe) const {
    const double strength = static_cast<double>(density) * static_cast<double>(ofLobe);
    const auto channel = [&](float value) {
      const double effect = invert ? std::max(1 - static_cast<double>(value), 0.0) : static_cast<double>(value);
      return static_cast<float>(1 + strength * (effect - 1));
    };
    return {channel(factor.r), channel(factor.g), channel(factor.b)};
  }
  Filtered Applied(const Filtered& factor) const {
    return {Applied(factor.diffuse, diffuse), Applied(factor.specular, specular)};
  }
};

const std::vector<Setting>& Settings() {
  static const std::vector<Setting> settings = {
      {"density", {"density"}, 0},
      {"density", {"density"}, 0.3f},
      {"density", {"density"}, 0.85f},
      {"invert", {"invert"}, 1, 1, 1, true},
      {"invert", {"invert", "density"}, 0.4f, 1, 1, true},
      {"invert", {"invert", "density"}, 0, 1, 1, true},
      {"lobes", {"diffuse"}, 1, 0},
      {"lobes", {"specular"}, 1, 1, 0},
      {"lobes", {"diffuse", "specular"}, 1, 0.25f, 0.75f},
      {"lobes", {"density", "diffuse", "specular"}, 0.5f, 0.8f, 0.1f},
      {"lobes", {"density", "invert", "diffuse", "specular"}, 0.6f, 0.3f, 1, true},
  };
  return settings;
}

std::string SayNames(const std::vector<std::string>* names) {
  if (!names) return "none";
  std::string text;
  for (const std::string& name : *names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text.empty() ? "none" : text;
}

class SettingsCheck {
 public:
  SettingsCheck(const FilterCase& filterCase, SuiteReport& report)
      : case_(filterCase),
        report_(report),
        rng_(filterCase.MakeRng()),
        edges_(filterCase.Edges(rng_)),
        factors_(Left(Neutral(*filterCase.maker))) {}

  void Run() {
    for (const char* property : {"density", "invert", "lobes"}) CheckProperty(property);
    if (case_.maker->Has("linkingGroups")) CheckGroups();
  }

 private:
  std::vector<Filtered> Left(const std::string& changes) const {
    return edges_.Filter(*case_.maker->Make(changes, case_.placement), ContextAt(0));
  }

  void CheckProperty(const std::string& property) {
    WorstEdge worst(kRounding);
    bool isAsked = false;
    for (const Setting& setting : Settings()) {
      const FilterMaker& maker = *case_.maker;
      if (setting.property != property ||
          !std::all_of(setting.needs.begin(), setting.needs.end(), [&](const auto& name) { return maker.Has(name); })) {
        continue;
      }
      isAsked = true;
      const std::vector<Filtered> left = Left(Neutral(maker) + "\n" + setting.Parameters());
      for (size_t i = 0; i < left.size(); ++i) {
        const Filtered right = setting.Applied(factors_[i]);
        worst.Note(Difference(left[i], right), [&] {
          return "with " + setting.Parameters() + "on " + edges_.Say(i) + ": " + SayDifference(left[i], right);
        });
      }
    }
    if (isAsked) worst.Report(case_, property, report_);
  }

  void CheckGroups() {
    WorstEdge worst(0);
    const auto expect = [&](const std::string& parameter, const std::vector<std::string>& right) {
      const auto filter = case_.maker->Make(Neutral(*case_.maker) + "\n" + parameter, case_.placement);
      const std::vector<std::string>* found = filter->GetProperty(FilterProperty::LinkingGroups);
      const std::string how = parameter.empty() ? "without linkingGroups" : "with " + parameter;
      if (found ? *found != right : !right.empty()) {
        worst.Note(1, [&] { return how + ": its groups are " + SayNames(found) + ", right is " + SayNames(&right); });
      }
      const std::vector<Filtered> left = edges_.Filter(*filter, ContextAt(0));
      for (size_t i = 0; i < left.size(); ++i) {
        if (IsSame(left[i], factors_[i])) continue;
        worst.Note(std::max(Difference(left[i], factors_[i]), 1e-9),
                   [&] { return how + ", " + edges_.Say(i) + ": " + SayDifference(left[i], factors_[i]); });
      }
    };
    expect("", {});
    expect("\"string linkingGroups\" \"suite\"", {"suite"});
    expect("\"string linkingGroups\" \" keys , rims\"", {"keys", "rims"});
    expect("\"string linkingGroups\" [ \"rims\" \"keys, others\" ]", {"rims", "keys", "others"});
    worst.Report(case_, "groups", report_);
  }

  const FilterCase& case_;
  SuiteReport& report_;
  Rng rng_;
  EdgeBatch edges_;
  std::vector<Filtered> factors_;
};

}  // namespace

void CheckFilterSettings(const FilterCase& filterCase, SuiteReport& report) {
  SettingsCheck(filterCase, report).Run();
}

}  // namespace lampyr::suite
