// Faults that hide: in what only some integrators ask for, where few samples go, or where all that is compared is wrong
// alike. Each is caught in lights of several kinds, by the property that says what is wrong.
#include "hidden_fault.h"
#include "suite_fixture.h"

namespace lampyr {
namespace {

using namespace test;

struct Hidden {
  HiddenFault fault;
  Lights lights;
  Properties named, follow;
};

class HiddenFaults : public SuiteTest {
 protected:
  Properties FailuresOf(const std::string& name, HiddenFault fault, unsigned parts) {
    return Failures(
        name,
        [&](std::shared_ptr<const Light> light) {
          return std::make_unique<HiddenFaultLight>(std::move(light), fault, placed_.toRender.translation, 1.0f);
        },
        parts);
  }
  // By the parts of the suite that are to find them.
  void ExpectEach(unsigned parts, const std::vector<Hidden>& faults) {
    for (const auto& [fault, lights, named, follow] : faults) {
      for (const std::string& name : lights) {
        ExpectNamed(FailuresOf(name, fault, parts), named, follow,
                    name + " with hidden fault " + std::to_string(static_cast<int>(fault)));
      }
    }
  }
};

const Lights kOfEachKind = {"square", "rect", "spot", "parallel", "sun", "portal"};

TEST_F(HiddenFaults, SoundOnesPass) {
  for (const char* name : {"square", "ball", "rect", "sphere", "cylinder", "spot", "parallel", "dome", "portal"}) {
    ExpectNamed(FailuresOf(name, HiddenFault::None, kAllParts & ~kDensityPart), {}, {}, name);
  }
}

TEST_F(HiddenFaults, OfPathTracingAlone) {
  ExpectEach(kContractPart, {
                                {HiddenFault::HalfWithoutBidirectional, kOfEachKind, {"bidirectional"}, {}},
                                {HiddenFault::PdfOffWithoutBidirectional, kOfEachKind, {"bidirectional"}, {}},
                            });
}

TEST_F(HiddenFaults, OfTheTimeAlone) {
  ExpectEach(kContractPart, {
                                {HiddenFault::RadianceOfTime, kOfEachKind, {"time"}, {}},
                                {HiddenFault::PdfOfTime, kOfEachKind, {"time"}, {}},
                                {HiddenFault::EmitPdfOfTime, kOfEachKind, {"time"}, {}},
                                {HiddenFault::PositionOfTime, {"square", "rect", "sun", "portal"}, {"time"}, {}},
                                {HiddenFault::CameraOfTime, {"square", "rect", "sun", "portal"}, {"time"}, {}},
                                {HiddenFault::EstimateOfTime, kOfEachKind, {"time"}, {}},
                            });
}

TEST_F(HiddenFaults, OfWhatWasAskedBefore) {
  ExpectEach(kContractPart | kAttributePart,
             {
                 {HiddenFault::SecondSampleDarker, kOfEachKind, {"repeat"}, {"multipliers"}},
                 {HiddenFault::EvaluationOfLastSample, {"square", "rect", "sun", "portal"}, {"repeat"}, {}},
                 {HiddenFault::PhotonsWearOut, kOfEachKind, {"repeat"}, {"multipliers", "emission-edge", "power"}},
                 {HiddenFault::StateOfItsThread, {"square", "rect", "sun", "portal"}, {"repeat"}, {}},
                 {HiddenFault::SharedNumbers, {"square", "rect", "sun", "portal"}, {"repeat"}, {}},
             });
}

TEST_F(HiddenFaults, OfSegments) {
  ExpectEach(kSegmentPart, {{HiddenFault::RangeFromFarBefore, {"square", "rect", "point", "spot"}, {"segment"}, {}}});
}

TEST_F(HiddenFaults, OfTheCosineOfPhotons) {
  ExpectEach(kDensityPart, {{HiddenFault::CosineOfPhotonsOne,
                             {"square", "ball", "rect", "disk", "point", "spot", "sun"},
                             {"emission-edge"},
                             {"power", "power-estimate"}}});
}

TEST_F(HiddenFaults, OfWhatGoesWithASample) {
  ExpectEach(
      kAttributePart,
      {
          {HiddenFault::TwoPatches, {"rect", "disk", "sphere", "cylinder"}, {"patches"}, {}},
          {HiddenFault::ShinesFromFarAway, kOfEachKind, {"shines-from"}, {}},
          {HiddenFault::NoPositionError, {"square", "ball", "rect", "disk", "sphere", "sun"}, {"position-error"}, {}},
          {HiddenFault::HugePositionError, {"square", "ball", "rect", "disk", "spot", "sun"}, {"position-error"}, {}},
          {HiddenFault::NoEnergy, {"square", "ball", "rect", "disk", "point", "spot"}, {"energy"}, {}},
          {HiddenFault::TinyEnergy, {"square", "ball", "rect", "disk", "point", "spot"}, {"energy"}, {}},
          {HiddenFault::UvwMirrored, {"square", "ball", "rect", "disk", "sphere", "cylinder"}, {"uvw"}, {}},
          {HiddenFault::UvwOfPhotonsConstant, {"square", "ball", "rect", "disk", "sphere"}, {"uvw"}, {}},
      });
}

TEST_F(HiddenFaults, WhereFewSamplesGo) {
  const Properties follow = {"integral", "irradiance", "directions", "power"};
  ExpectEach(
      kStrataPart,
      {
          {HiddenFault::PdfOffAtGrazing, {"square", "ball", "rect", "disk", "sphere", "cylinder"}, {"strata"}, follow},
          {HiddenFault::PdfTwiceEdgeOn, {"square", "disk", "cylinder"}, {"strata"}, follow},
          {HiddenFault::PdfOffFarAway, {"ball", "rect", "cylinder"}, {"strata"}, follow},
          {HiddenFault::PdfOffNear, {"square", "rect", "sphere"}, {"strata"}, follow},
          {HiddenFault::PdfOffOfDiscrete, {"point", "spot", "goniometric", "projection"}, {"consistency"}, {}},
      });
}

TEST_F(HiddenFaults, WhereNothingShines) {
  ExpectEach(kDensityPart, {{HiddenFault::PdfWhereDark, {"dome", "window"}, {"integral"}, {"directions", "irradiance"}}});
}

TEST_F(HiddenFaults, InDirectionsOfPhotons) {
  const Properties follow = {"emission-integral", "power", "power-estimate"};
  const Lights lights = {"square", "ball", "rect", "disk", "point", "spot", "sun", "even sky", "dome", "portal"};
  ExpectEach(kDirectionPart, {
                                 {HiddenFault::Ripple, lights, {"emission-directions"}, follow},
                                 {HiddenFault::Tilt, lights, {"emission-directions"}, follow},
                             });
}

}  // namespace
}  // namespace lampyr
