#include "lights/types/surface_facet.h"

namespace lampyr {

namespace {

const LightTransform kInPlace{};

std::vector<Point3> Corners(const Bounds3& box) {
  std::vector<Point3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(box.Corner(i));
  return corners;
}

}  // namespace

QuadricFacet::QuadricFacet(const QuadricSurface& surface) : surface_(surface), prepared_(surface.Shape()) {}

std::vector<Point3> QuadricFacet::GetBounds() const {
  return Corners(surface_.BoundsOf(surface_.Place(kInPlace)));
}

std::optional<LocalHit> QuadricFacet::Intersect(const LocalRay& ray) const {
  QuadricHit hits[2];
  if (prepared_.Intersect({ray.origin, ray.direction, ray.tMin, ray.tMax}, hits) == 0) return std::nullopt;
  LocalHit hit;
  hit.t = hits[0].t;
  hit.position = ray.origin + hit.t * ray.direction;
  // Own space is local space turned: an exact map.
  const glm::dmat3 toOwn(surface_.Shape().toObject.linear);
  const Point3d own = toOwn * hit.position;
  Vector3d normal(0, 0, 1);
  if (surface_.Shape().kind == Quadric::Kind::Sphere) normal = glm::normalize(own);
  if (surface_.Shape().kind == Quadric::Kind::Cylinder) normal = glm::normalize(Vector3d(own.x, own.y, 0));
  hit.normal = (normal * static_cast<double>(OutsideSign(surface_.Shape()))) * toOwn;
  hit.uv = glm::clamp(surface_.UvOf(Point3(own)), Point2(0.0f), Point2(1.0f));
  return hit;
}

std::vector<Point3> RectFacet::GetBounds() const {
  return Corners(surface_.BoundsOf(surface_.Place(kInPlace)));
}

std::optional<LocalHit> RectFacet::Intersect(const LocalRay& ray) const {
  if (ray.direction.z == 0) return std::nullopt;
  LocalHit hit;
  hit.t = -ray.origin.z / ray.direction.z;
  if (!(hit.t > ray.tMin && hit.t <= ray.tMax)) return std::nullopt;
  hit.position = ray.origin + hit.t * ray.direction;
  hit.position.z = 0;
  const Point2d uv(0.5 - hit.position.x / static_cast<double>(surface_.Width()),
                   0.5 + hit.position.y / static_cast<double>(surface_.Height()));
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return std::nullopt;
  hit.uv = Point2(uv);
  hit.normal = {0, 0, -1};
  return hit;
}

std::vector<ParameterInfo> UsdLuxSurfaceParameters(std::vector<ParameterInfo> own) {
  own.push_back({"twoSided", ParameterType::Bool, "", "false", "", "emit on the other side of the surface as well"});
  own.push_back({"texture:file", ParameterType::String, "", "\"\"", "", "image that multiplies the radiance"});
  for (ParameterInfo& row : ShapingParameters()) own.push_back(std::move(row));
  return WithCommonParameters(std::move(own));
}

std::vector<std::string> UsdLuxSurfaceSamples(const std::string& size) {
  std::vector<std::string> samples = {
      "\"rgb color\" [ 1 0.5 0.25 ] \"float intensity\" 3 \"float exposure\" 1",
      "\"bool twoSided\" true \"bool normalize\" true \"float diffuse\" 0.5 \"float specular\" 2",
      "\"string texture:file\" \"suite-texture.exr\" \"float intensity\" 2",
      "\"string texture:file\" \"suite-texture.exr\" \"bool twoSided\" true",
      "\"float shaping:cone:angle\" 40 \"float shaping:cone:softness\" 0.5",
      "\"float shaping:focus\" 4 \"rgb shaping:focusTint\" [ 0.3 0.1 0 ] \"bool twoSided\" true",
      "\"string shaping:ies:file\" \"suite-profile.ies\" \"bool shaping:ies:normalize\" true",
      "\"float shaping:cone:angle\" 120 \"bool twoSided\" true \"string texture:file\" \"suite-texture.exr\"",
      "\"float shaping:cone:angle\" 40 \"bool twoSided\" true",
  };
  if (!size.empty()) {
    for (std::string& sample : samples) sample = size + " " + sample;
  }
  return samples;
}

}  // namespace lampyr
