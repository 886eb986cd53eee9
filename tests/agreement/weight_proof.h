// The proof of the weights of bidirectional path tracing and of vertex merging, path by path: the recursive ones are
// those of the explicit densities, and those of all techniques of a path sum to 1. What both are computed from is asked
// for anew, by other means: the densities at the light's end and at the camera's, how many photons are merged, and what
// refraction does to a delta's densities.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "integrators/walk/technique_counts.h"

namespace lampyr::test {

// One kind of input: how many were computed again, and how many of them are off by more than 1 %.
struct InputCheck {
  int asked = 0, wrong = 0;
  // A few are met elsewhere than they were made: on an edge, in a cut-out, at a grazing angle.
  bool Passes() const { return wrong <= 10 + asked / 100; }
  void Note(double value, double expected);
};

// The largest errors over all paths of a scene.
struct WeightErrors {
  int paths = 0;
  std::map<std::pair<int, int>, int> perTechnique;
  double sum = 0;        // |Σ weights - 1|
  double recursion = 0;  // between the two ways of weighing the same densities
  double reported = 0;   // between the integrator's weight and that of the densities asked for anew
  double groups = 0;     // between the integrator's sums over groups of techniques and those of explicit densities
  int sums = 0;          // compared
  int merges = 0;
  int beams = 0;  // merges with beams
  InputCheck direct, emission, lens, mergesPerDensity, connections, refraction;

  // "": the weights are exact. Else what is not.
  std::string WhatIsWrong() const;
};

// One way of making paths in a scene, repeated until so many have been checked, or one of the largest errors is too
// large where `stopsAtFirst` is set.
struct WeightProof {
  int paths = 4000;
  float radius = 0;    // that photons are gathered within, in parts of the scene's; 0: none
  bool aimed = false;  // photons: at two balls in the scene's middle
  float pixels = 0;    // if `radius` is 0: photons are gathered within so many pixels, seen at the first hit
  bool stopsAtFirst = false;
  TechniqueCounts counts{};
  float beamShare = 0;      // of light paths whose flights in homogeneous media are photons; 0: photons are points
  bool isGuided = false;    // both walks, by a guide of random directions
  double splatCount = 1.8;  // samples of a pixel that a splat is worth; that of a Gaussian filter
};
WeightErrors CheckWeights(const std::string& sceneText, const WeightProof& proof);

}  // namespace lampyr::test
