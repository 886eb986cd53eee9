// "cookie": an image that is thrown from the filter's origin, however large the light is.
#include "lights/filters/beam_image.h"

namespace lampyr {

FilterType CookieFilterType();

FilterType CookieFilterType() {
  return BeamImageType("cookie", "an image that is projected from the filter's origin", "analytic");
}

}  // namespace lampyr
