#include "matrix/matrix_rigs.h"

#include "suite/suite_inputs.h"

namespace lampyr::test {

namespace rigs {

namespace {

// Photons are blurred over a radius that finds some of them, and over which radiance hardly bends.
std::string Head(int depth, double radius) {
  return "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\nPixelFilter \"box\"\n"
         "Integrator \"path\" \"integer maxdepth\" " +
         std::to_string(depth) + " \"float radius\" " + std::to_string(radius) +
         " \"float alpha\" 1 \"integer photonsperiteration\" 600\n";
}

}  // namespace

std::string Room(const std::string& material, const std::string& inside, const std::string& camera, int depth,
                 double photonRadius) {
  return Head(depth, photonRadius) + "LookAt -0.2 -0.15 0  -1 -0.6 0.5  0 1 0\n" + camera + "WorldBegin\n" + inside +
         Scope(material + " Shape \"sphere\" \"float radius\" 1");
}

std::string Floor(const std::string& above, const std::string& ball, double photonRadius) {
  return Head(3, photonRadius) +
         "LookAt -0.6 1.6 1.2  -0.25 0 0.2  0 1 0\nCamera \"perspective\" \"float fov\" 26\nWorldBegin\n" + above +
         Scope(kMatte + "Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 1") +
         Scope((ball.empty() ? "Material \"diffuse\" \"rgb reflectance\" [0.3 0.5 0.7]" : ball) +
               " Translate 0.2 0.3 0 Shape \"sphere\" \"float radius\" 0.25");
}

std::string Lamp(const std::string& place, double radius, const std::string& more) {
  return Scope("Translate " + place + " AreaLightSource \"diffuse\" \"rgb L\" [4 3 2] " + more +
               " Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"sphere\" \"float radius\" " +
               std::to_string(radius));
}

}  // namespace rigs

std::vector<Rig> MatrixRigs(const std::filesystem::path& folder) {
  suite::WriteSuiteInputs(folder);
  std::vector<Rig> all;
  const auto add = [&](const char* kind, void (*rigs)(std::vector<Rig>&)) {
    const size_t first = all.size();
    rigs(all);
    for (size_t i = first; i < all.size(); ++i) {
      all[i].kind = kind;
      all[i].turn = i - first;
    }
  };
  add("materials", AddMaterialRigs);
  add("lights", AddLightRigs);
  add("filters", AddFilterRigs);
  add("motion", AddMotionRigs);
  add("cameras", AddCameraRigs);
  return all;
}

}  // namespace lampyr::test
