// The sky through a window. Made by "portal" (portal.cpp) and by "infinite" with a portal (dome.cpp).
#pragma once

#include "lights/types/portal_place.h"
#include "lights/types/sky_parameters.h"

namespace lampyr {

struct PortalDescription {
  PortalShape shape;
  SkyChoice sky;
  // Of the portal and of the sky: one of them stands in world space, the other moves with the light.
  bool portalMoves = true;
  LightTransform worldToRender;
};

std::unique_ptr<Light> MakePortalLight(LightTypeFunction type, const ParameterList& parameters,
                                       const LightBuildContext& build, PortalDescription description);

}  // namespace lampyr
