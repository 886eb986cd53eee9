// Scenes with participating media, for the agreement of integrators and the proof of weights.
#pragma once

#include "agreement/agreement_scenes.h"

namespace lampyr::test {

struct MediaScene : AgreementScene {
  bool lightTracerSeesAll = true;  // nothing smooth is in front of the camera
};

std::vector<MediaScene> MediaScenes();

}  // namespace lampyr::test
