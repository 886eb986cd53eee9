// A medium of a grid at the wavelengths of a pass: its colours in Rec. 709, upsampled at each point. They are convex
// combinations of red, green and blue there, so that the bounds of the medium hold.
#include "media/medium.h"
#include "spectral/wavelengths.h"

namespace lampyr {

namespace {

class TunedMedium final : public Medium {
 public:
  TunedMedium(std::shared_ptr<const Medium> medium, std::shared_ptr<const Wavelengths> wavelengths)
      : Medium(medium->Name(), medium->Asymmetry(), medium->IsEmissive(), medium->Scatters()),
        medium_(std::move(medium)),
        wavelengths_(std::move(wavelengths)) {}

  MediumCoefficients At(const Point3& position) const override {
    const MediumCoefficients here = medium_->At(position);
    return {wavelengths_->FromRgb(here.absorption), wavelengths_->FromRgb(here.scattering),
            wavelengths_->FromRgb(here.emission)};
  }
  const MajorantGrid* Majorants() const override { return medium_->Majorants(); }
  double LookupNanoseconds() const override { return medium_->LookupNanoseconds() + 40; }

 private:
  std::shared_ptr<const Medium> medium_;
  std::shared_ptr<const Wavelengths> wavelengths_;
};

}  // namespace

std::shared_ptr<const Medium> Medium::AtWavelengths(const std::shared_ptr<const Medium>& self,
                                                    const std::shared_ptr<const Wavelengths>& wavelengths) const {
  return std::make_shared<TunedMedium>(self, wavelengths);
}

}  // namespace lampyr
