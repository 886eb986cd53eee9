// A sky seen through a portal. Made by "portal" (portal.cpp) and by "infinite" with a portal (dome.cpp).
#pragma once

#include "lights/types/portal_place.h"
#include "lights/types/sky_parameters.h"

namespace lampyr {

struct PortalDescription {
  PortalShape shape;
  SkyChoice sky;
  // True: the portal moves with the light and the sky is fixed in world space. False: the other way round.
  bool portalMoves = true;
  LightTransform worldToRender;
};

std::unique_ptr<Light> MakePortalLight(LightTypeFunction type, const ParameterList& parameters,
                                       const LightBuildContext& build, PortalDescription description);

}  // namespace lampyr
