// What the suite runs over: every sample block of every type, on every shape for area lights, under every transform.
#include "film/image.h"
#include "geometry/quadric.h"
#include "lights/suite/pdf_suite.h"
#include "sampling/rng.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr {

namespace {

struct NamedTransform {
  std::string name;
  Transform transform;
};

std::vector<NamedTransform> Transforms() {
  const Transform move = Transform::Translate({0.7, -1.3, 2.1}), turn = Transform::Rotate(50, {1, 2, -1});
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.6;
  shear[2][1] = -0.4;
  return {
      {"identity", Transform()},
      {"rotated", move * turn},
      {"1e-3", turn * Transform::Scale(Vector3d(1e-3)) * move},
      {"1e3", turn * Transform::Scale(Vector3d(1e3)) * move},
      {"non-uniform", turn * Transform::Scale({2, 0.5, 1.3}) * move},
      {"mirrored", move * turn * Transform::Scale({-1, 1, 1})},
      {"sheared", move * Transform(shear) * turn},
  };
}

struct NamedShape {
  std::string name;
  Shape shape;
};

// Five triangles that are not flat, of different sizes, one without area.
std::shared_ptr<const TriangleMesh> SuiteMesh(bool withNormals) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{-1, -1, 0}, {1, -1, 0.1f}, {1, 1, 0}, {-1, 1, 0.3f}, {2, 0, -0.4f}, {2.5f, 1.5f, -1}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {0, 0, 1}, {4, 5, 2}};
  mesh->uvs = {{0, 0}, {0.6f, 0}, {0.6f, 0.8f}, {0, 0.8f}, {0.9f, 0.3f}, {1, 1}};
  // The vertex normals decide: these turn all of the surface over.
  if (withNormals) mesh->normals.assign(6, Normal3(0.1f, 0, -0.9949874f));
  return mesh;
}

std::shared_ptr<const BilinearMesh> SuitePatches(bool withUvs) {
  auto mesh = std::make_shared<BilinearMesh>();
  mesh->positions = {{-1, -1, 0},         {1, -0.8f, 0.2f}, {-0.7f, 1, 0.5f},
                     {1.2f, 1.1f, -0.3f}, {2.5f, -1, 0.4f}, {2.2f, 0.9f, 0}};
  mesh->patches = {{0, 1, 2, 3}, {1, 4, 3, 5}};
  if (withUvs) mesh->uvs = {{0, 0}, {0.5f, 0.1f}, {0.1f, 1}, {0.6f, 0.9f}, {1, 0}, {1, 1}};
  return mesh;
}

Quadric MakeQuadric(Quadric::Kind kind, float radius, float zMin, float zMax, float inner, float phiMaxDegrees) {
  Quadric q;
  q.kind = kind;
  q.radius = radius;
  q.zMin = zMin;
  q.zMax = zMax;
  q.innerRadius = inner;
  q.phiMax = phiMaxDegrees >= 360 ? 2 * kPi : phiMaxDegrees * (kPi / 180);
  return q;
}

std::vector<NamedShape> Shapes() {
  Quadric reversed = MakeQuadric(Quadric::Kind::Disk, 1, 0.3f, 0, 0, 360);
  reversed.flipNormals = true;
  return {
      {"mesh", SuiteMesh(false)},
      {"mesh-with-normals", SuiteMesh(true)},
      {"bilinear", SuitePatches(false)},
      {"bilinear-with-uv", SuitePatches(true)},
      {"sphere", MakeQuadric(Quadric::Kind::Sphere, 1.3f, -1.3f, 1.3f, 0, 360)},
      {"partial-sphere", MakeQuadric(Quadric::Kind::Sphere, 1, -0.4f, 0.8f, 0, 230)},
      {"disk-reversed", reversed},
      {"partial-disk", MakeQuadric(Quadric::Kind::Disk, 1.5f, 0, 0, 0.5f, 300)},
      {"cylinder", MakeQuadric(Quadric::Kind::Cylinder, 0.7f, -1, 1.5f, 0, 360)},
      {"partial-cylinder", MakeQuadric(Quadric::Kind::Cylinder, 1, 0, 1, 0, 150)},
  };
}

// The shape as a scene without instances holds it: already where the transform leads.
Shape Bake(const Shape& shape, const Transform& transform) {
  const auto points = [&](std::vector<Point3>& positions, std::vector<Normal3>& normals) {
    for (Point3& p : positions) p = Point3(transform.Point(Point3d(p)));
    for (Normal3& n : normals) n = Normal3(glm::normalize(transform.Normal(Vector3d(n))));
  };
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    auto baked = std::make_shared<TriangleMesh>(**mesh);
    points(baked->positions, baked->normals);
    baked->flipNormals = baked->flipNormals != transform.SwapsHandedness();
    return std::shared_ptr<const TriangleMesh>(baked);
  }
  if (const auto* patches = std::get_if<std::shared_ptr<const BilinearMesh>>(&shape)) {
    auto baked = std::make_shared<BilinearMesh>(**patches);
    points(baked->positions, baked->normals);
    baked->flipNormals = baked->flipNormals != transform.SwapsHandedness();
    return std::shared_ptr<const BilinearMesh>(baked);
  }
  Quadric quadric = std::get<Quadric>(shape);
  quadric.toRender = transform.ToAffine();
  quadric.toObject = transform.Inverse().ToAffine();
  quadric.flipNormals = quadric.flipNormals != transform.SwapsHandedness();
  return quadric;
}

// Images of noise: uneven, with black parts; one with a bright texel and some that are no light at all.
void WriteSuiteImages(const std::filesystem::path& folder) {
  Rng rng(7);
  const auto write = [&](const char* name, int width, int height, const std::function<float(int)>& value) {
    Image image(width, height, {"R", "G", "B"});
    for (int i = 0; i < width * height; ++i) {
      const float v = value(i);
      for (size_t c = 0; c < 3; ++c)
        image.data[static_cast<size_t>(i) * 3 + c] = v * (0.4f + 0.3f * static_cast<float>(c));
    }
    WriteExr(folder / name, image, ExrPrecision::Float);
  };
  const auto noise = [&](int) { return rng.NextFloat() < 0.2f ? 0.0f : 0.1f + 3 * Sqr(rng.NextFloat()); };
  write("suite-texture.exr", 8, 8, [&](int i) { return (i % 8) < 2 ? 0.0f : 0.2f + noise(i); });
  write("suite-square.exr", 8, 8, noise);
  write("suite-latlong.exr", 16, 8, noise);
  write("suite-bright.exr", 4, 4, [](int i) {
    return i == 6 ? 1e9f : i == 3 ? std::numeric_limits<float>::quiet_NaN() : i == 9 ? -1.0f : 0.5f;
  });
  write("suite-black.exr", 4, 4, [](int) { return 0.0f; });
}

ParameterList ParseSample(const LightType& type, const std::string& sample, const std::filesystem::path& folder,
                          Diagnostics& diagnostics) {
  const std::string statement =
      (type.isAreaLight ? "AreaLightSource \"" : "LightSource \"") + type.name + "\" " + sample;
  const std::string text = "WorldBegin\n" + statement + "\n" + (type.isAreaLight ? "Shape \"sphere\"\n" : "");
  const SceneDescription scene = ParseScene(text, folder / "suite.pbrt", diagnostics);
  return type.isAreaLight ? scene.areaLights.at(0).parameters : scene.lights.at(0).light.parameters;
}

class SuiteRun {
 public:
  SuiteRun(const std::filesystem::path& folder, const SuiteOptions& options)
      : folder_(folder), options_(options), textures_({}, Transform(), diagnostics_) {}

  void Run(const LightType& type) {
    int index = 0;
    for (const std::string& sample : type.samples) {
      const ParameterList parameters = ParseSample(type, sample, folder_, diagnostics_);
      const std::string name = type.name + "[" + std::to_string(index) + "]";
      int which = index++;
      for (const NamedTransform& transform : Transforms()) {
        // In turn: the shape where it belongs, and an instance of it.
        if (type.isAreaLight) {
          for (const NamedShape& shape : Shapes())
            CheckArea(type, parameters, name, shape, transform, which++ % 2 == 1);
        } else {
          CheckOther(type, parameters, name, transform);
        }
      }
    }
  }

  SuiteReport& Report() { return report_; }

 private:
  LightBuildContext Build(const Transform& placement) {
    LightBuildContext build;
    build.placement = placement;
    build.transform = {placement.ToAffine(), placement.Inverse().ToAffine()};
    build.textures = &textures_;
    build.diagnostics = &diagnostics_;
    return build;
  }

  void CheckArea(const LightType& type, const ParameterList& parameters, const std::string& name,
                 const NamedShape& shape, const NamedTransform& transform, bool isInstance) {
    const Shape placed = isInstance ? shape.shape : Bake(shape.shape, transform.transform);
    const Transform placement = isInstance ? transform.transform : Transform();
    LightBuildContext build = Build(placement);
    build.shape = &placed;
    const std::unique_ptr<EmitterModel> model = MakeEmitterModel(placed, placement);
    const bool hasImage = !parameters.GetFile("filename").empty();
    Check(type, parameters, build, name, shape.name + " " + transform.name + (isInstance ? " instance" : ""),
          model.get(), !hasImage);
  }

  void CheckOther(const LightType& type, const ParameterList& parameters, const std::string& name,
                  const NamedTransform& transform) {
    // Light that is defined over local directions has a closed form only where solid angles are kept.
    const bool keepsAngles = transform.name != "non-uniform" && transform.name != "sheared";
    Check(type, parameters, Build(transform.transform), name, transform.name, nullptr, keepsAngles);
  }

  void Check(const LightType& type, const ParameterList& parameters, const LightBuildContext& build,
             const std::string& name, const std::string& caseName, const EmitterModel* model, bool isPowerExact) {
    const std::unique_ptr<Light> light = MakeLight(type, parameters, build);
    SuiteSubject subject;
    subject.light = light.get();
    subject.model = model;
    subject.context.transform = &build.transform;
    subject.context.scene = {build.transform.toRender.translation,
                             3 * MaxAbsComponent(build.transform.toRender.linear[0])};
    subject.context.bidirectional = true;
    subject.isPowerExact = isPowerExact;
    subject.name = name;
    subject.caseName = caseName;
    CheckLight(subject, options_, report_);
  }

  std::filesystem::path folder_;
  SuiteOptions options_;
  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_;
  SuiteReport report_;
};

}  // namespace

std::vector<SuiteResult> RunPdfSuite(const std::vector<LightType>& types, const std::filesystem::path& scratch,
                                     const SuiteOptions& options) {
  WriteSuiteImages(scratch);
  SuiteRun run(scratch, options);
  for (const LightType& type : types) run.Run(type);
  return run.Report().Finish(options.familyWise);
}

}  // namespace lampyr
