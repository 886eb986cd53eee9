// Lens files of pbrt-v4: text with one surface per line, from the scene to the film, with four numbers each:
// - radius of curvature (mm; positive: the centre lies towards the film; 0: the aperture stop),
// - thickness (mm along the axis to the next surface; of the last surface to the film),
// - index of refraction behind the surface (0 stands for 1),
// - diameter of the aperture (mm).
//
// `#` starts a comment.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace lampyr {

struct LensSurface {
  double curvatureRadius = 0;  // mm, signed; 0: the stop
  double thickness = 0;        // mm, >= 0
  double index = 1;            // behind the surface, >= 1
  double apertureRadius = 0;   // mm, > 0; not above |curvatureRadius|

  bool IsStop() const { return curvatureRadius == 0; }
};

// Surfaces from the scene to the film: exactly one stop, no overlapping surfaces, air at both ends.
struct LensPrescription {
  std::vector<LensSurface> surfaces;

  const LensSurface& Stop() const;
};

inline constexpr size_t kMostLensSurfaces = 128;

// Distance (mm, towards the film) of a point of a surface at `height` from the plane of its vertex; |height| must not
// exceed |curvatureRadius|.
double Sag(const LensSurface& surface, double height);

// Throws an Error located in the file (file:line:column) for an invalid lens, and at `where` for a file that cannot be
// read.
LensPrescription ReadLensFile(const std::string& file, const FileLocation& where);
// Parses text in memory; `name` stands for the file in messages.
LensPrescription ParseLensFile(const std::string& text, const std::string& name);

}  // namespace lampyr
