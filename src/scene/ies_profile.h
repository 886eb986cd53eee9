// Luminous intensity of a luminaire over directions, from an IES file (ANSI/IES LM-63-1986, -1991, -1995, -2002 and
// -2019).
//
// Angles are those of type C photometry: θ in [0, π] from the nadir (0, straight down, where most luminaires shine) to
// the zenith, φ in [0, 2π) around it from the luminaire's 0° plane, counterclockwise seen from the zenith. Types A and
// B, of luminaires that face forward, are turned into it: forward becomes the nadir, up becomes φ = 0. What a file
// leaves out by symmetry is filled in; directions beyond the angles it measures are dark.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"

namespace lampyr {

class IesProfile {
 public:
  // Candela, bilinear between the file's angles; never negative.
  double Intensity(double theta, double phi) const;
  double Largest() const { return largest_; }  // candela
  double Power() const { return power_; }      // ∫ Intensity dω, lumen; 0 for a profile that is dark
  // Where the interpolation has its knots, radians, ascending: theta within [0, π], from the first to the last angle
  // that is measured; phi from 0 to 2π (these two alone when the profile is symmetric about its axis).
  const std::vector<double>& Thetas() const { return thetas_; }
  const std::vector<double>& Phis() const { return phis_; }

 private:
  friend class IesReader;
  std::vector<double> thetas_, phis_;
  std::vector<double> candela_;  // thetas fastest
  double largest_ = 0, power_ = 0;
};

// Throws an Error located in the IES file (file:line) for what is not LM-63, and at `where` when it cannot be opened.
std::shared_ptr<const IesProfile> ReadIes(const std::string& file, const FileLocation& where);

// The same for text in memory; `name` stands for the file in messages.
std::shared_ptr<const IesProfile> ParseIes(const std::string& text, const std::string& name);

}  // namespace lampyr
