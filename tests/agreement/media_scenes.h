// Scenes with participating media, for the agreement of integrators and the proof of weights.
#pragma once

#include "agreement/agreement_scenes.h"

namespace lampyr::test {

struct MediaScene : AgreementScene {
  bool hasLights = true;           // besides media that glow
  bool lightTracerSeesAll = true;  // nothing smooth is in front of the camera
  // The camera is within a medium that scatters, where connections to the lens have a variance without bound: 1 / d² of
  // points at any distance.
  bool isCameraInMedium = false;
  int pathFactor = 1;  // of the samples of path tracing, where it finds the light rarely
};

std::vector<MediaScene> MediaScenes();

}  // namespace lampyr::test
