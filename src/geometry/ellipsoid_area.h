// The areas of ellipsoids and of cylinders with an elliptic section, by Carlson's symmetric elliptic integrals
// ([Carlson95] Numerical computation of real or complex elliptic integrals): exact to rounding, in well under a
// microsecond.
#pragma once

#include <glm/mat3x3.hpp>

namespace lampyr {

// R_G(x, y, z): the mean over all directions n of sqrt(x n.x² + y n.y² + z n.z²). Not negative, at most one of them 0.
double CarlsonRG(double x, double y, double z);

// Mean over the unit sphere of |m n|.
double MeanStretchOverSphere(const glm::dmat3& m);
// Mean over the unit circle of |m (cosφ, sinφ, 0)|.
double MeanStretchOverCircle(const glm::dmat3& m);

}  // namespace lampyr
