// "gobo": an image in the beam that the light itself goes through, like a slide: sharp for a point, soft for an area.
#include "lights/filters/beam_image.h"

namespace lampyr {

FilterType GoboFilterType();

FilterType GoboFilterType() {
  return BeamImageType("gobo", "an image that the light goes through, in a plane across its beam", "physical");
}

}  // namespace lampyr
