// The guide of a pixel, for display: the learned density of directions at the place that the pixel sees.
#pragma once

#include <memory>
#include <vector>

#include "integrators/guide/path_guide.h"
#include "integrators/walk/render_scene.h"

namespace lampyr {

// The guide of camera paths where the centre of a pixel sees a surface or a medium that scatters widely, itself or by
// way of mirrors and glass.
struct GuideView {
  static constexpr int kColumns = 64, kRows = 32;

  bool isGuided = false;  // false: the pixel sees no such place, or nothing was learned there
  float share = 0;        // probability with which a path goes by the guide, in [0, kMostShare]
  // Density of the guide, 1/sr, by direction, row by row: the middle is the direction in which the camera looks.
  // Columns turn by 2π to the right of the picture, rows by π downwards, all by the same angle.
  std::vector<float> densities;
};

// `x`, `y`: of the pixel in the full image of width × height pixels. Throws Stopped (base/stop.h).
GuideView ViewGuide(const RenderScene& scene, const std::shared_ptr<const PathGuide>& guide, int width, int height,
                    int x, int y);

}  // namespace lampyr
