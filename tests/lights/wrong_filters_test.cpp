// Each fault in a sound filter: it is caught, and what fails is the property that describes it and nothing that has no
// part in it.
#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <set>
#include <thread>

#include "lights/filters/filter_base.h"
#include "lights/light_base.h"
#include "suite/filter_suite.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

using Properties = std::set<std::string>;

enum class Fault {
  None,
  Negative,           // a little below 0, on one side
  NegativeSpecular,   // that in specular light alone
  NotANumber,         // at one place: straight below
  Infinite,           // on edges that come from infinity
  ByTime,             // fades while the shutter is open
  ByThread,           // dims on any thread but the one that made it
  ByPlaceInBatch,     // the later in its batch, the darker
  BrighterInBatches,  // 2 % in batches of more than one
  ByState,            // dims whatever is asked next after a far receiver
  ByCount,            // each seventh call is off by 2 %
  ByLightPdf,         // where the light's sampling is sparse
  Clamped,            // light of more than 1 is cut
  MixesLobes,         // specular light is a part of the diffuse light
  LobesSwapped,
  ModifierIsZero,
  ModifierTooLow,
  ModifierIsNoNumber,
  IsIdentityAlways,
  Throws,
};

class WrongFilter final : public LightFilter {
 public:
  WrongFilter(std::unique_ptr<LightFilter> sound, Fault fault) : sound_(std::move(sound)), fault_(fault) {}

  const std::vector<std::string>* GetProperty(FilterProperty property) const override {
    return sound_->GetProperty(property);
  }
  bool IsIdentity() const override { return fault_ == Fault::IsIdentityAlways || sound_->IsIdentity(); }
  std::optional<float> GetRadianceModifier() const override {
    if (fault_ == Fault::ModifierIsZero) return 0.0f;
    if (fault_ == Fault::ModifierTooLow) return 0.02f;
    if (fault_ == Fault::ModifierIsNoNumber) return std::numeric_limits<float>::quiet_NaN();
    return sound_->GetRadianceModifier();
  }

  void Filter(const FilterContext& context, const FilterSamples& samples) const override {
    if (fault_ == Fault::Throws) throw std::runtime_error("the lamp broke");
    const std::vector<Color> diffuse(samples.diffuse, samples.diffuse + samples.count);
    sound_->Filter(context, samples);
    ++calls_;
    for (int i = 0; i < samples.count; ++i) {
      const float strength = Strength(context, samples, i);
      samples.specular[i] *= strength;
      if (fault_ != Fault::NegativeSpecular) samples.diffuse[i] *= strength;
      if (fault_ == Fault::Clamped) samples.diffuse[i] = Clamped(samples.diffuse[i]);
      if (fault_ == Fault::MixesLobes) samples.specular[i] = samples.specular[i] + 0.1f * diffuse[i];
    }
  }

 private:
  static Color Clamped(const Color& c) { return {std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f)}; }

  // The factor on the light besides the correct filter's factor.
  float Strength(const FilterContext& context, const FilterSamples& samples, int i) const {
    const Point3& receiver = samples.receiver[i];
    switch (fault_) {
      case Fault::Negative:
      case Fault::NegativeSpecular:
        return receiver.x > 0 ? -0.01f : 1.0f;
      case Fault::NotANumber:
        return samples.toLight[i].x == 0 && samples.toLight[i].y == 0 ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
      case Fault::Infinite:
        return std::isinf(samples.distance[i]) ? kInfinity : 1.0f;
      case Fault::ByTime:
        return 1 - 0.1f * context.time;
      case Fault::ByThread:
        return std::this_thread::get_id() == maker_ ? 1.0f : 0.9f;
      case Fault::ByPlaceInBatch:
        return 1 / (1 + 0.01f * static_cast<float>(i));
      case Fault::BrighterInBatches:
        return samples.count > 1 ? 1.02f : 1.0f;
      case Fault::ByState: {
        const bool wasFar = isFar_;
        isFar_ = glm::length(receiver) > 1000;
        return wasFar ? 0.9f : 1.0f;
      }
      case Fault::ByCount:
        return calls_ % 7 == 0 ? 1.02f : 1.0f;
      case Fault::ByLightPdf:
        return samples.pdfDirect[i].value < 0.5f ? 0.9f : 1.0f;
      default:
        return 1;
    }
  }

  std::unique_ptr<LightFilter> sound_;
  Fault fault_;
  std::thread::id maker_ = std::this_thread::get_id();
  mutable std::atomic<int> calls_ = 0;
  mutable std::atomic<bool> isFar_ = false;
};

// The type with another factory, which may call the sound one.
using Create = decltype(FilterType::create);
FilterType With(const std::string& name, const std::function<Create(const Create& sound)>& change) {
  FilterType type = *FindFilterType(name);
  type.create = change(type.create);
  return type;
}
FilterType With(const std::string& name, Fault fault) {
  return With(name, [&](const Create& sound) -> Create {
    return [sound, fault](const ParameterList& parameters, const FilterBuildContext& build) {
      return std::make_unique<WrongFilter>(sound(parameters, build), fault);
    };
  });
}
// The parameters as the wrong filter reads them.
using Reading = std::function<ParameterList(const ParameterList&)>;
FilterType Reads(const std::string& name, const Reading& reading) {
  return With(name, [&](const Create& sound) -> Create {
    return [sound, reading](const ParameterList& parameters, const FilterBuildContext& build) {
      return sound(reading(parameters), build);
    };
  });
}
using Building = std::function<void(FilterBuildContext&)>;
FilterType Builds(const std::string& name, const Building& change) {
  return With(name, [&](const Create& sound) -> Create {
    return [sound, change](const ParameterList& parameters, const FilterBuildContext& given) {
      FilterBuildContext build = given;
      change(build);
      return sound(parameters, build);
    };
  });
}

Parameter Number(const char* name, double value) {
  Parameter parameter;
  parameter.name = name;
  parameter.numbers = {value};
  return parameter;
}
ParameterList Changed(const ParameterList& parameters, const std::vector<Parameter>& changes) {
  return MergeParameters(parameters, ParameterList({}, "", changes));
}
ParameterList Without(const ParameterList& parameters, const std::string& name) {
  std::vector<Parameter> kept;
  for (const Parameter& parameter : parameters.All()) {
    if (parameter.name != name) kept.push_back(parameter);
  }
  return {parameters.Where(), parameters.Owner(), kept};
}

class WrongFilters : public testing::Test {
 protected:
  std::vector<SuiteResult> Failures(const FilterType& type) {
    SuiteOptions options;
    options.threads = 1;
    std::vector<SuiteResult> failures;
    for (const SuiteResult& result : RunFilterSuite({type}, folder_.Path(), options)) {
      if (!result.passed) failures.push_back(result);
    }
    return failures;
  }
  // All of `named` fail, and nothing but them and those that may `follow`.
  void ExpectNamed(const FilterType& type, const Properties& named, const Properties& follow, const std::string& what) {
    Properties failed;
    for (const SuiteResult& result : Failures(type)) {
      failed.insert(result.property);
      // The worst case is said in words: a place, and what would be right.
      EXPECT_NE(result.caseName.find(": "), std::string::npos) << result.property << ": " << result.caseName;
    }
    for (const std::string& property : named) EXPECT_TRUE(failed.count(property)) << what << " passes " << property;
    for (const std::string& property : failed)
      EXPECT_TRUE(named.count(property) || follow.count(property)) << what << " fails " << property;
  }
  void ExpectNamed(const std::string& name, Fault fault, const Properties& named, const Properties& follow = {}) {
    ExpectNamed(With(name, fault), named, follow, name + " with fault " + std::to_string(static_cast<int>(fault)));
  }

  // Properties that compare factors: all of them fail for a filter that is not deterministic.
  const Properties compares_ = {"combine", "coordsys",  "density", "groups", "identity", "invert",    "light", "lobes",
                                "motion",  "placement", "repeat",  "batch",  "threads",  "light-pdf", "time"};
  TemporaryFolder folder_;
};

TEST_F(WrongFilters, SoundOnesPass) {
  for (const char* name : {"barn", "gobo", "intmult", "ramp"}) ExpectNamed(name, Fault::None, {});
}

TEST_F(WrongFilters, AreCaughtGivingWhatIsNoLight) {
  const Properties follow = {"combine",   "density",  "identity", "invert", "lobes",
                             "placement", "coordsys", "motion",   "light"};
  for (const char* name : {"ramp", "blocker"}) {
    ExpectNamed(name, Fault::Negative, {"valid"}, follow);
    ExpectNamed(name, Fault::NegativeSpecular, {"valid"}, follow);
    ExpectNamed(name, Fault::Infinite, {"valid"}, compares_);
    ExpectNamed(name, Fault::NotANumber, {"valid"}, compares_);
  }
}

TEST_F(WrongFilters, AreCaughtLookingAtMoreThanTheEdge) {
  for (const char* name : {"barn", "ramp"}) {
    ExpectNamed(name, Fault::ByTime, {"time"}, {"motion"});
    ExpectNamed(name, Fault::ByThread, {"threads"});
    ExpectNamed(name, Fault::ByPlaceInBatch, {"batch"}, compares_);
    ExpectNamed(name, Fault::BrighterInBatches, {"batch"}, compares_);
    ExpectNamed(name, Fault::ByState, {"repeat"}, compares_);
    ExpectNamed(name, Fault::ByCount, {"repeat"}, compares_);
    ExpectNamed(name, Fault::ByLightPdf, {"light-pdf"}, compares_);
  }
}

TEST_F(WrongFilters, AreCaughtBeingNoFactor) {
  ExpectNamed("ramp", Fault::Clamped, {"light"}, {});
  ExpectNamed("barn", Fault::MixesLobes, {"light"}, {"density", "identity", "invert", "lobes", "combine"});
}

TEST_F(WrongFilters, AreCaughtSayingTooLittle) {
  for (const char* name : {"intmult", "barn"}) {
    ExpectNamed(name, Fault::ModifierIsZero, {"modifier"});
    ExpectNamed(name, Fault::ModifierTooLow, {"modifier"});
    ExpectNamed(name, Fault::ModifierIsNoNumber, {"modifier"});
    ExpectNamed(name, Fault::IsIdentityAlways, {"identity"});
  }
}

TEST_F(WrongFilters, AreCaughtMisreadingParameters) {
  const auto expect = [&](const Reading& reading, const Properties& named, const Properties& follow,
                          const std::string& what) {
    for (const char* name : {"barn", "intmult", "rod"})
      ExpectNamed(Reads(name, reading), named, follow, name + (" " + what));
  };
  const auto least = [](const ParameterList& p) {
    return Changed(p, {Number("density", std::max(p.GetFloat("density", 1), 0.05))});
  };
  expect(least, {"density"}, {"invert"}, "is never wholly off");
  expect([](const ParameterList& p) { return Changed(p, {Number("density", std::pow(p.GetFloat("density", 1), 2))}); },
         {"density"}, {"invert", "lobes"}, "squares its density");
  expect([](const ParameterList& p) { return Without(p, "invert"); }, {"invert"}, {"lobes"}, "is never inverted");
  expect(
      [](const ParameterList& p) {
        return Changed(p, {Number("diffuse", p.GetFloat("specular", 1)), Number("specular", p.GetFloat("diffuse", 1))});
      },
      {"lobes"}, {}, "swaps diffuse and specular");
  expect([](const ParameterList& p) { return Without(p, "specular"); }, {"lobes"}, {},
         "shows specular lobes all of it");
  expect([](const ParameterList& p) { return Without(p, "linkingGroups"); }, {"groups"}, {}, "forgets its groups");
  expect(
      [](const ParameterList& p) {
        return p.GetStrings("linkingGroups").empty() ? p : Changed(p, {Number("density", 0.98)});
      },
      {"groups"}, {}, "is dimmer in a group");
}

TEST_F(WrongFilters, AreCaughtInTheWrongPlace) {
  const auto expect = [&](const char* name, const Building& change, const Properties& named, const Properties& follow,
                          const std::string& what) {
    ExpectNamed(Builds(name, change), named, follow, name + (" " + what));
  };
  for (const char* name : {"barn", "ramp", "rod", "cookie"}) {
    expect(
        name, [](FilterBuildContext& build) { build.transform = {}; }, {"placement", "coordsys"}, {"samples"},
        "is not moved");
    expect(
        name,
        [](FilterBuildContext& build) {
          build.transform.toRender.linear = build.transform.toLocal.linear = glm::mat3(1.0f);
          build.transform.toLocal.translation = -build.transform.toRender.translation;
        },
        {"placement", "coordsys"}, {}, "is not turned");
    expect(
        name, [](FilterBuildContext& build) { build.motion = nullptr; }, {"motion"}, {}, "stays where it was");
  }
}

// A combiner that takes each filter of one mode by another.
TEST_F(WrongFilters, AreCaughtCombiningByAnotherMode) {
  using enum CombineMode;
  for (const auto& [from, to] : {std::pair(Max, Multiply), std::pair(Min, Max), std::pair(Screen, Multiply),
                                 std::pair(Multiply, Min), std::pair(Max, Screen)}) {
    const auto confuse = [from = from, to = to](FilterBuildContext& build) {
      build.find = [find = build.find, from, to](const std::string& name, const FileLocation& where) {
        FilterInstance found = find(name, where);
        if (found.combineMode == from) found.combineMode = to;
        return found;
      };
    };
    ExpectNamed(
        Builds("combiner", confuse), {"combine"}, {},
        "mode " + std::to_string(static_cast<int>(from)) + " taken for " + std::to_string(static_cast<int>(to)));
  }
  const auto always = [](FilterBuildContext& build) {
    build.find = [find = build.find](const std::string& name, const FileLocation& where) {
      FilterInstance found = find(name, where);
      found.linking = 0;
      return found;
    };
  };
  ExpectNamed(Builds("combiner", always), {"combine"}, {}, "does not ask whether a filter is enabled");
}

// Properties of parameters that a type's table lacks are not tested.
TEST_F(WrongFilters, HaveNoPropertyOfWhatTheirTableLacks) {
  FilterType type = *FindFilterType("barn");
  std::erase_if(type.parameters, [](const ParameterInfo& row) { return row.name == "combineMode"; });
  ASSERT_EQ(type.parameters.size() + 1, FindFilterType("barn")->parameters.size());
  for (const SuiteResult& result : RunFilterSuite({type}, folder_.Path(), {})) EXPECT_NE(result.property, "combine");
}

TEST_F(WrongFilters, AreCaughtChangingNothing) {
  FilterType type = *FindFilterType("barn");
  type.samples = {"\"float density\" 0"};
  ExpectNamed(type, {"samples"}, {}, "a sample of density 0");
}

TEST_F(WrongFilters, ThatThrowWhenAskedAreFound) {
  ExpectNamed(With("barn", Fault::Throws), {"exceptions"}, {}, "throws");
}

// A plugin's filter that refuses its parameters is an error with its own words.
TEST_F(WrongFilters, ThatThrowAreErrors) {
  const FilterType type = With("barn", [](const Create&) -> Create {
    return [](const ParameterList& parameters, const FilterBuildContext&) -> std::unique_ptr<LightFilter> {
      throw Error(parameters.Where(), "no such lens");
    };
  });
  EXPECT_THROW(Failures(type), Error);
}

}  // namespace
}  // namespace lampyr::test
