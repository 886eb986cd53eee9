// Each fault in one light of every kind that can have it: it is caught, and what fails is the property that describes
// it and nothing that has no part in it.
#include "mixed_light.h"
#include "suite_fixture.h"
#include "support/whole.h"
#include "wrong_light.h"

namespace lampyr {
namespace {

using namespace test;

Lights operator+(Lights a, const Lights& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Lights kSurfaces = {"square", "ball", "rect", "disk"};  // on a shape, and their own
const Lights kPoints = {"point", "spot", "goniometric", "projection"};
const Lights kSkies = {"sun", "even sky", "dome"};
const Lights kPortals = {"portal", "window"};
const Lights kAll = kSurfaces + kPoints + Lights{"parallel"} + kSkies + Lights{"portal"};

// `named` fail, and of the rest none but `follow`, which compare with what is wrong.
struct Expected {
  Fault fault;
  Lights lights;
  Properties named, follow;
};

class WrongTypes : public SuiteTest {
 protected:
  Properties FailuresOf(const std::string& name, Fault fault) {
    return Failures(name, [&](std::shared_ptr<const Light> light) {
      return std::make_unique<WrongLight>(std::move(light), fault);
    });
  }
  // By default faults take turns with the lights of a list, of which two that follow each other are of one kind: each
  // fault in half of them, each light with half of the faults. In `tests/run long`: all.
  void ExpectEach(const std::vector<Expected>& faults) {
    size_t turn = 0;
    for (const auto& [fault, lights, named, follow] : faults) {
      ++turn;
      for (size_t i = 0; i < lights.size(); ++i) {
        if (lights.size() > 1 && (i + turn) % 2 != 0 && !IsWhole()) continue;
        ExpectNamed(FailuresOf(lights[i], fault), named, follow,
                    lights[i] + " with fault " + std::to_string(static_cast<int>(fault)));
      }
    }
  }
};

TEST_F(WrongTypes, SoundOnesPass) {
  for (const auto& [name, light] : SuiteLights()) ExpectNamed(FailuresOf(name, Fault::None), {}, {}, name);
}

TEST_F(WrongTypes, AreCaughtAtReceivers) {
  ExpectEach({
      {Fault::PdfOffByOnePercent, kSurfaces + kSkies + kPortals, {"integral"}, {"irradiance", "power"}},
      {Fault::PdfOffByOnePercent, kPoints + Lights{"parallel"}, {"consistency"}, {"power"}},
      {Fault::CosineForgotten, kSurfaces, {"integral", "irradiance"}, {"directions", "power"}},
      {Fault::SolidAngleToAreaWrong, kSurfaces + Lights{"mesh", "sphere", "cylinder"}, {"surface"}, {}},
      {Fault::SolidAngleToAreaWrong, kPoints + kSkies + Lights{"parallel", "portal"}, {"consistency"}, {}},
      {Fault::ZeroWhereItEmits, kSurfaces + kSkies + Lights{"portal"}, {"irradiance"}, {"power"}},
      {Fault::ZeroWhereItEmits,
       kPoints + Lights{"parallel"},
       {"power", "emission-integral"},
       {"emission-directions", "emission-positions", "emission-edge", "shines-from"}},
      {Fault::OtherRadiance,
       kSurfaces + kSkies + Lights{"portal"},
       {"consistency"},
       {"camera", "emission-edge", "irradiance"}},
      {Fault::SpecularForgotten, kAll, {"multipliers"}, {"power-estimate"}},
      {Fault::CameraSeesMore, kAll, {"camera"}, {}},
  });
}

TEST_F(WrongTypes, AreCaughtOnTheirBack) {
  const Properties follow = {"camera", "directions", "integral", "irradiance", "emission-directions"};
  ExpectEach({
      {Fault::LeaksBehind,
       kSurfaces + Lights{"mesh", "sphere", "cylinder"},
       {"one-sided", "emission-integral"},
       follow},
      {Fault::LeaksBehind, kPortals, {"integral", "irradiance", "emission-integral"}, follow},
  });
}

// Where something is, asked in the wrong space or from the wrong place.
TEST_F(WrongTypes, AreCaughtInTheWrongPlace) {
  const Properties atReceivers = {"consistency", "directions",     "integral", "irradiance",
                                  "power",       "position-error", "segment",  "uvw"};
  const Properties ofPhotons = {"bounds",         "emission-integral", "emission-positions", "power",
                                "power-estimate", "position-error",    "shines-from",        "uvw"};
  ExpectEach({
      {Fault::PdfOfTheOrigin, kPortals, {"integral", "directions", "irradiance"}, {"power"}},
      {Fault::SeenFromTheOrigin,
       {"portal"},
       {"camera", "emission-integral", "emission-edge", "power"},
       {"emission-directions", "emission-positions", "estimate", "segment", "shines-from"}},
      {Fault::FrameNotTurned, {"square", "rect", "disk"}, {"surface"}, atReceivers},
      {Fault::FrameNotTurned, {"sun", "dome", "portal"}, {"consistency", "directions"}, atReceivers},
      {Fault::FrameNotTurned,
       {"spot", "goniometric", "projection"},
       {"emission-directions", "emission-edge"},
       {"estimate", "segment"}},
      {Fault::FrameNotTurned, {"parallel"}, {"emission-edge"}, {}},
      {Fault::PhotonFrameNotTurned, {"rect", "disk"}, {"surface", "emission-positions"}, ofPhotons},
      {Fault::PhotonFrameNotTurned, {"square"}, {"emission-positions"}, {"bounds", "position-error"}},
      {Fault::PhotonFrameNotTurned,
       {"spot", "goniometric", "projection", "dome", "portal"},
       {"emission-directions", "emission-edge"},
       ofPhotons},
      {Fault::PhotonFrameNotTurned, {"parallel"}, {"emission-edge"}, {}},
      {Fault::DiskNotRotated,
       kSkies + Lights{"parallel", "portal"},
       {"emission-positions"},
       {"emission-edge", "emission-directions", "emission-integral", "position-error", "shines-from"}},
  });
}

TEST_F(WrongTypes, AreCaughtEmitting) {
  const Properties follow = {"emission-integral", "emission-positions", "emission-directions", "power",
                             "power-estimate"};
  ExpectEach({
      {Fault::EmissionNotCosine, kSurfaces, {"emission-directions", "power"}, {"power-estimate"}},
      {Fault::EmitDensityOff,
       kSurfaces + kSkies + Lights{"parallel", "portal"},
       {"emission-integral", "power"},
       {"power-estimate"}},
      {Fault::EmitDensityOff, kPoints, {"power"}, {"power-estimate"}},
      // A sun has so few photons left that there may be none to check.
      {Fault::PhotonsNotWhereTheyEmit,
       kSurfaces + kSkies + Lights{"point", "spot", "goniometric", "portal"},
       {"power"},
       {"power-estimate", "emission-positions"}},
      {Fault::DarkPhotonsAreNone, kSurfaces, {"emission-origin"}, follow},
      {Fault::PlaceDependsOnDirection, kSurfaces, {"emission-origin"}, {"emission-directions"}},
      // There it is the direction that must not depend on the place.
      {Fault::PlaceDependsOnDirection, kSkies + Lights{"portal"}, {"emission-positions"}, {}},
      {Fault::SpecularForgottenInPhotons, kAll, {"multipliers"}, {"emission-edge", "power", "power-estimate"}},
  });
}

TEST_F(WrongTypes, AreCaughtByAHundredthInWhereTheyEmit) {
  powerError_ = 6e-4;
  ExpectEach({
      {Fault::DirectionDensityOff,
       kSurfaces + kPoints + kSkies + Lights{"portal"},
       {"emission-integral", "power"},
       {"power-estimate"}},
      // The texels through the window leave the integral no nearer than that.
      {Fault::DirectionDensityOff, {"window"}, {"power"}, {"emission-integral", "power-estimate"}},
      {Fault::DirectionDensityOff, {"parallel"}, {"consistency", "emission-edge"}, {"power", "power-estimate"}},
  });
}

TEST_F(WrongTypes, AreCaughtEstimating) {
  ExpectEach({
      {Fault::PowerOffByTwo, kAll, {"power-estimate"}, {}},
      {Fault::BoxTooSmall, kSurfaces + kPoints, {"bounds"}, {}},
      {Fault::ConeTooNarrow, kSurfaces + Lights{"spot", "projection"}, {"bounds"}, {}},
      {Fault::EstimateIsZero, kAll, {"estimate"}, {}},
      {Fault::SegmentIsMissed, kAll, {"estimate", "segment"}, {}},
      {Fault::SegmentEndsEarly, kAll, {"estimate", "segment"}, {}},
      {Fault::SegmentCutTooShort, {"spot", "projection"}, {"segment"}, {"estimate"}},
      {Fault::SegmentWithoutEndIsMissed, kAll, {"segment"}, {}},
  });
}

TEST_F(WrongTypes, SoundOnesOfTwoPartsPass) {
  for (const char* name : {"square", "rect", "spot", "sun", "portal"}) {
    for (const Part part : {Part::Draws, Part::PhotonDraws, Part::DirectPdf, Part::PhotonPdf}) {
      if (part == Part::Draws && name == std::string("spot")) continue;
      const auto failed = Failures(name, [&](const std::shared_ptr<const Light>& light) {
        return std::make_unique<MixedLight>(light, light, part);
      });
      ExpectNamed(failed, {}, {}, name + std::string(" with part ") + std::to_string(static_cast<int>(part)));
    }
  }
}

// One part of the light has its angle in degrees where the others have it in radians.
TEST_F(WrongTypes, AreCaughtWithAnAngleConvertedTwice) {
  struct Converted {
    std::string light, angle;  // the name of its parameter
    double degrees;
    Part part;
    Properties named, follow;
  };
  // A density that is 0 where photons are made: of what is made there, nothing is left.
  const Properties ofDensity = {"emission-edge", "emission-origin", "emission-positions", "power", "power-estimate"};
  const Properties power = {"power", "power-estimate"};
  const std::vector<Converted> faults = {
      {"spot", "coneangle", 50, Part::PhotonDraws, {"emission-directions"}, power},
      {"spot", "coneangle", 50, Part::PhotonPdf, {"emission-directions", "power"}, {"power-estimate"}},
      {"spot", "coneangle", 50, Part::Power, {"power-estimate"}, {"energy"}},
      {"spot", "coneangle", 50, Part::Bounds, {"bounds"}, {"energy"}},
      {"spot", "coneangle", 50, Part::Estimate, {"estimate"}, {}},
      {"spot", "coneangle", 50, Part::Segment, {"estimate", "segment"}, {}},
      {"sun", "angle", 40, Part::Draws, {"directions"}, {}},
      {"sun", "angle", 40, Part::PhotonDraws, {"emission-directions"}, {}},
      {"sun", "angle", 40, Part::DirectPdf, {"directions"}, {"integral", "irradiance", "power"}},
      {"sun", "angle", 40, Part::PhotonPdf, {"emission-directions", "power"}, ofDensity},
      {"sun", "angle", 40, Part::Power, {"power-estimate"}, {}},
      {"sun", "angle", 40, Part::Camera, {"camera"}, {}},
      {"rect", "shaping:cone:angle", 40, Part::PhotonDraws, {"emission-directions"}, power},
      {"rect", "shaping:cone:angle", 40, Part::PhotonPdf, {"emission-directions", "power"}, ofDensity},
      {"rect", "shaping:cone:angle", 40, Part::Bounds, {"bounds"}, {"energy"}},
      {"rect", "shaping:cone:angle", 40, Part::Camera, {"camera"}, {}},
  };
  for (const auto& [name, angle, degrees, part, named, follow] : faults) {
    const SuiteLight& light = SuiteLights().at(name);
    const auto with = [&, &angle = angle](double value) {
      return Make(light, "\"float " + angle + "\" " + std::to_string(value) + " ");
    };
    const auto failed = Failures(name, [&, &degrees = degrees, &part = part](const std::shared_ptr<const Light>&) {
      return std::make_unique<MixedLight>(with(degrees), with(degrees * 3.14159265358979 / 180), part);
    });
    ExpectNamed(failed, named, follow, name + " with part " + std::to_string(static_cast<int>(part)));
  }
}

}  // namespace
}  // namespace lampyr
