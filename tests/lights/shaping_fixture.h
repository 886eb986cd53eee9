// A Shaping from a line of scene text, and IES files of our own in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <sstream>

#include "light_fixture.h"
#include "lights/types/shaping.h"
#include "support/temporary_folder.h"

namespace lampyr::test {

using Emitter = Shaping::Emitter;

// An IES file that lives as long as this.
class IesOnDisk {
 public:
  explicit IesOnDisk(const std::string& text) { WriteBytes(Path(), text); }
  std::filesystem::path Path() const { return folder_ / "profile.ies"; }
  // The parameter that names it.
  std::string Parameter() const { return "\"string shaping:ies:file\" \"" + Path().string() + "\" "; }

 private:
  TemporaryFolder folder_;
};

// LM-63-2002, type C, no multipliers.
inline std::string IesText(const std::string& vertical, const std::string& horizontal, const std::string& candela) {
  const auto count = [](const std::string& numbers) {
    std::istringstream stream(numbers);
    return std::to_string(std::distance(std::istream_iterator<double>(stream), {}));
  };
  return "IESNA:LM-63-2002\n[TEST] own\nTILT=NONE\n1 -1 1 " + count(vertical) + " " + count(horizontal) +
         " 1 2 0 0 0\n1 1 10\n" + vertical + "\n" + horizontal + "\n" + candela + "\n";
}

inline std::shared_ptr<const Shaping> MakeShaping(const std::string& parameters, Emitter emitter = Emitter::Point,
                                                  Diagnostics* diagnostics = nullptr) {
  LightBuildContext build;
  build.diagnostics = diagnostics;
  return Shaping::Read(Parse("point", parameters, false), build, emitter);
}

// The direction at θ from -z and φ from +x towards +y, degrees.
inline Vector3 AtAngles(double theta, double phi = 0) {
  const double t = theta * M_PI / 180, p = phi * M_PI / 180;
  return Vector3(Vector3d(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), -std::cos(t)));
}

}  // namespace lampyr::test
