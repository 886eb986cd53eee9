// Participating media: scattering, absorption and emission at a point, and bounds along rays for distance sampling.
// Lengths are in scene units, coefficients per scene unit, in render space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "math/transform.h"
#include "math/vec.h"
#include "media/majorant_grid.h"

namespace lampyr {

class Wavelengths;

struct MediumCoefficients {
  Color absorption, scattering;  // σ_a, σ_s
  Color emission;                // σ_a L_e: radiance emitted per length, W/(m² sr)

  Color Extinction() const { return absorption + scattering; }  // σ_t
};

// Immutable; any thread may call it.
class Medium {
 public:
  virtual ~Medium() = default;

  // Coefficients at a point of render space; for a grid, 0 outside of its box.
  virtual MediumCoefficients At(const Point3& position) const = 0;
  // Upper bounds of the extinction, the largest of its channels; null: the medium is homogeneous, and At is the same
  // everywhere.
  virtual const MajorantGrid* Majorants() const { return nullptr; }
  // The corners of the box of a grid, in render space; none: homogeneous.
  virtual std::vector<Point3> Corners() const { return {}; }
  // This medium at the wavelengths of a pass. `self`: a pointer to this medium.
  virtual std::shared_ptr<const Medium> AtWavelengths(const std::shared_ptr<const Medium>& self,
                                                      const std::shared_ptr<const Wavelengths>& wavelengths) const;
  // Time of At on a typical machine, for estimates of the cost of integrators.
  virtual double LookupNanoseconds() const { return IsHomogeneous() ? 15 : 60; }
  // Memory of its grids.
  virtual size_t Bytes() const { return 0; }

  bool IsHomogeneous() const { return Majorants() == nullptr; }
  // Asymmetry g of the Henyey–Greenstein phase function, in (-1,1): the mean cosine between the directions before and
  // after scattering.
  float Asymmetry() const { return asymmetry_; }
  bool IsEmissive() const { return isEmissive_; }
  // True if paths may scatter in the medium; otherwise it only attenuates light.
  bool Scatters() const { return scatters_; }
  const std::string& Name() const { return name_; }

 protected:
  Medium(std::string name, float asymmetry, bool isEmissive, bool scatters = true)
      : name_(std::move(name)), asymmetry_(asymmetry), isEmissive_(isEmissive), scatters_(scatters) {}

 private:
  std::string name_;
  float asymmetry_;
  bool isEmissive_, scatters_;
};

}  // namespace lampyr
