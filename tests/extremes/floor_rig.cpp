#include "extremes/floor_rig.h"

#include "extremes/extreme_case.h"

namespace lampyr::test {

std::string FloorRig::Scene(const std::string& world, int maxDepth) const {
  const std::string n = std::to_string(pixels);
  const Point3d at = origin + middle;
  const double x0 = -extent, x1 = extent, z0 = -extent, z1 = extent;
  const std::string flat =
      "Shape \"bilinearmesh\" \"point3 P\" [" + Numbers({x0, 0, z0, x1, 0, z0, x0, 0, z1, x1, 0, z1}) + "]\n";
  const std::string axis = " 1 2 3\n";
  std::string text = "Film \"rgb\" \"integer xresolution\" " + n + " \"integer yresolution\" " + n + " " + film +
                     "\nPixelFilter \"box\"\nLookAt 0 " + Number(eye) + " 0 0 0 0 0 0 1\nTranslate " +
                     Numbers({-at.x, -at.y, -at.z}) + "\n";
  if (turn != 0) text += "Rotate " + Number(-turn) + axis;
  text += camera.empty()
              ? "Camera \"orthographic\" \"float screenwindow\" [" + Numbers({-half, half, -half, half}) + "]\n"
              : camera + "\n";
  text += "Integrator \"path\" \"integer maxdepth\" " + std::to_string(maxDepth) + "\nWorldBegin\n";
  if (turn != 0) text += "Rotate " + Number(turn) + axis;
  text += "AttributeBegin\n" + material + "Translate " + Numbers({at.x, at.y, at.z}) + "\n" +
          (floor.empty() ? flat : floor) + "AttributeEnd\nTranslate " + Numbers({origin.x, origin.y, origin.z}) + "\n" +
          world;
  return text;
}

double FloorRig::Radiance(const std::function<double(const Point3d&)>& irradiance) const {
  const int n = places;
  double sum = 0;
  for (int i = 0; i < n * n; ++i) {
    const double x = (2 * (i % n) + 1.0) / n - 1, z = (2 * (i / n) + 1.0) / n - 1;
    sum += irradiance({middle.x + half * x, 0, middle.z + half * z});
  }
  return 0.5 / M_PI * sum / (n * n);
}

double RectangleIrradiance(const Point3d& P, const Point3d& corner, const Vector3d& u, const Vector3d& v, int cells) {
  const Vector3d element = glm::cross(u, v) / static_cast<double>(cells * cells);
  double sum = 0;
  for (int i = 0; i < cells * cells; ++i) {
    const Vector3d way = corner + u * ((i % cells + 0.5) / cells) + v * ((i / cells + 0.5) / cells) - P;
    const double squared = glm::dot(way, way), facing = -glm::dot(element, way);
    if (facing > 0 && way.y > 0) sum += facing * way.y / (squared * squared);
  }
  return sum;
}

}  // namespace lampyr::test
