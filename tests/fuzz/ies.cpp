#include <cmath>

#include "fuzz/target_support.h"
#include "scene/ies_profile.h"

namespace lampyr::fuzz {

bool ReadIesFile(std::string_view bytes) {
  return AcceptErrors([&] {
    const auto profile = ParseIes(std::string(bytes), "input.ies");
    if (!std::isfinite(profile->Power()) || profile->Power() < 0) Fail("an IES profile without a finite power");
    constexpr int kDirections = 24;
    for (int i = 0; i <= kDirections; ++i) {
      const double part = static_cast<double>(i) / kDirections;
      const double candela = profile->Intensity(3.2 * part - 0.05, 13 * part * part - 3);
      if (!(candela >= 0 && candela <= profile->Largest() * (1 + 1e-12))) Fail("an intensity beyond the largest one");
    }
  });
}

}  // namespace lampyr::fuzz
