// Luminous intensity of a luminaire over directions, from an IES file (ANSI/IES LM-63-1986, -1991, -1995, -2002 and
// -2019).
//
// Angles are those of type C photometry: θ in [0, π] from the nadir (0, straight down, where most luminaires shine) to
// the zenith, φ in [0, 2π) around it from the 0° plane of the luminaire, counterclockwise as seen from the zenith.
// Types A and B, for luminaires that face forward, are converted to it: forward becomes the nadir, up becomes φ = 0.
// Values that a file omits by symmetry are filled in; directions beyond the measured angles are dark.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"

namespace lampyr {

class IesProfile {
 public:
  // Candela, interpolated bilinearly between the angles of the file; never negative.
  double Intensity(double theta, double phi) const;
  double Largest() const { return largest_; }  // candela
  double Power() const { return power_; }      // ∫ Intensity dω, lumen; 0 for a dark profile
  // Knots of the interpolation, radians, ascending: thetas within [0, π], from the first to the last measured angle;
  // phis from 0 to 2π (these two alone if the profile is symmetric about its axis).
  const std::vector<double>& Thetas() const { return thetas_; }
  const std::vector<double>& Phis() const { return phis_; }

 private:
  friend class IesReader;
  std::vector<double> thetas_, phis_;
  std::vector<double> candela_;  // thetas fastest
  double largest_ = 0, power_ = 0;
};

// Throws an Error located in the IES file (file:line) if it is not valid LM-63, and at `where` if it cannot be opened.
std::shared_ptr<const IesProfile> ReadIes(const std::string& file, const FileLocation& where);

// Parses text in memory; `name` stands for the file in messages.
std::shared_ptr<const IesProfile> ParseIes(const std::string& text, const std::string& name);

}  // namespace lampyr
