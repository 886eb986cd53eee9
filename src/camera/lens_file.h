// Lenses as pbrt-v4 writes them: a text file with one surface a line, from the scene to the film, of four numbers:
// radius of curvature (mm; positive: the centre lies towards the film; 0: the aperture stop), thickness (mm along the
// axis to the next surface; of the last one to the film), index of refraction behind the surface (0 stands for 1), and
// diameter of the aperture (mm). `#` starts a comment.
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

// From the scene to the film: exactly one stop, no surfaces that run through one another, air at both ends.
struct LensPrescription {
  std::vector<LensSurface> surfaces;

  const LensSurface& Stop() const;
};

inline constexpr size_t kMostLensSurfaces = 128;

// Distance (mm, towards the film) of a surface's point at `height` from the plane of its vertex; |height| must not be
// above |curvatureRadius|.
double Sag(const LensSurface& surface, double height);

// Throws an Error located in the file (file:line:column) for what is no lens, and at `where` for a file that cannot be
// read.
LensPrescription ReadLensFile(const std::string& file, const FileLocation& where);
// The same for text in memory; `name` stands for the file in messages.
LensPrescription ParseLensFile(const std::string& text, const std::string& name);

}  // namespace lampyr
