// Curves: from a scene file's parameters to cubic Bézier segments, and the surface point of a hit on one.
//
// Embree traces them: Flat turns towards the ray, Cylinder is a swept round tube, Ribbon follows given normals. Texture
// coordinates are pbrt-v4's: u along each segment, v across the width.
//
// Embree renders a flat segment as CurveSet::kLinesPerFlatSegment straight lines. Bent segments are divided until the
// lines stay within a hundredth of the half width of the curve, because the scattering of a fibre depends on the hit's
// position across its width.
#pragma once

#include "base/error.h"
#include "geometry/ray.h"
#include "geometry/shapes.h"

namespace lampyr {

struct CurveParameters {
  enum class Basis { Bezier, BSpline };
  Basis basis = Basis::Bezier;
  int degree = 3;                // 2 or 3
  std::vector<Point3> points;    // control points, the curve's own space
  float width0 = 1, width1 = 1;  // full widths at both ends, the curve's own space
  CurveSet::Kind kind = CurveSet::Kind::Flat;
  std::vector<Normal3> normals;  // ribbons: one at every segment's end, segments + 1 in all
  Transform toRender;
  FileLocation where;  // for errors
};

// Widths scale by the transform's mean scale (the cube root of its determinant). Throws Error.
CurveSet MakeCurves(const CurveParameters& parameters);

// Number of segments that MakeCurves returns: bent ones of flat curves are divided, into 256 at most, and
// those of ribbons, into 64. Throws Error.
size_t CountDividedSegments(const CurveParameters& parameters);

// Sets position, error, normals, uv and tangents of the hit at origin + t·direction with curve parameter `u`, in the
// space of the curves. Does not set the indices.
void EvaluateCurve(const CurveSet& curves, uint32_t segment, float u, const Point3& origin, const Vector3& direction,
                   float t, SurfacePoint& point);

// Point and derivative of a segment's axis, and half width there.
Point3 CurveAxis(const CurveSet& curves, uint32_t segment, float u);
Vector3 CurveTangent(const CurveSet& curves, uint32_t segment, float u);
float CurveRadius(const CurveSet& curves, uint32_t segment, float u);

}  // namespace lampyr
