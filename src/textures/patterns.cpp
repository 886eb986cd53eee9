// Simple patterns: bilerp, checkerboard (2-D and 3-D), dots.
#include <cmath>

#include "math/noise.h"
#include "textures/texture_families.h"

namespace lampyr {

namespace {

template <class Value>
class BilerpTexture : public Texture<Value> {
 public:
  BilerpTexture(const TextureMapping2D& mapping, const Value (&corners)[4]) : mapping_(mapping) {
    for (int i = 0; i < 4; ++i) corners_[i] = corners[i];
  }
  Value Evaluate(const TextureContext& where) const override {
    const Point2 st = mapping_.Map(where);
    return corners_[0] * ((1 - st.x) * (1 - st.y)) + corners_[1] * ((1 - st.x) * st.y) +
           corners_[2] * (st.x * (1 - st.y)) + corners_[3] * (st.x * st.y);
  }

 private:
  TextureMapping2D mapping_;
  Value corners_[4];  // v00, v01, v10, v11: s first
};

bool IsOddCell(float x) {
  return std::floor(x) - 2 * std::floor(0.5f * std::floor(x)) != 0;
}

template <class Value>
class CheckerboardTexture : public Texture<Value> {
 public:
  CheckerboardTexture(const TextureMapping2D& mapping2D, const TextureMapping3D& mapping3D, bool is3D,
                      ParameterOf<Value> even, ParameterOf<Value> odd)
      : mapping2D_(mapping2D), mapping3D_(mapping3D), is3D_(is3D), even_(std::move(even)), odd_(std::move(odd)) {}
  Value Evaluate(const TextureContext& where) const override { return (IsOdd(where) ? odd_ : even_).Evaluate(where); }

 private:
  bool IsOdd(const TextureContext& where) const {
    if (is3D_) {
      const Point3 p = mapping3D_.Map(where);
      return IsOddCell(p.x) != (IsOddCell(p.y) != IsOddCell(p.z));
    }
    const Point2 st = mapping2D_.Map(where);
    return IsOddCell(st.x) != IsOddCell(st.y);
  }

  TextureMapping2D mapping2D_;
  TextureMapping3D mapping3D_;
  bool is3D_;
  ParameterOf<Value> even_, odd_;
};

// One dot of radius 0.35 in about half of the unit cells, shifted at random within its cell.
template <class Value>
class DotsTexture : public Texture<Value> {
 public:
  DotsTexture(const TextureMapping2D& mapping, ParameterOf<Value> inside, ParameterOf<Value> outside)
      : mapping_(mapping), inside_(std::move(inside)), outside_(std::move(outside)) {}
  Value Evaluate(const TextureContext& where) const override {
    return (IsInside(mapping_.Map(where)) ? inside_ : outside_).Evaluate(where);
  }

 private:
  static bool IsInside(const Point2& st) {
    constexpr float radius = 0.35f, maxShift = 0.5f - radius;
    const Point2 cell(std::floor(st.x + 0.5f), std::floor(st.y + 0.5f));
    if (!(Noise({cell.x + 0.5f, cell.y + 0.5f, 0.5f}) > 0)) return false;
    const Vector2 shift(Noise({cell.x + 1.5f, cell.y + 2.8f, 0.5f}), Noise({cell.x + 4.5f, cell.y + 9.8f, 0.5f}));
    const Vector2 offset = st - (cell + maxShift * shift);
    return glm::dot(offset, offset) < radius * radius;
  }

  TextureMapping2D mapping_;
  ParameterOf<Value> inside_, outside_;
};

}  // namespace

template <class Value>
ParameterOf<Value> MakeBilerp(const TextureRequest& request) {
  const Value corners[4] = {GetConstant<Value>(request, "v00", 0), GetConstant<Value>(request, "v01", 1),
                            GetConstant<Value>(request, "v10", 0), GetConstant<Value>(request, "v11", 1)};
  return ParameterOf<Value>(std::make_shared<BilerpTexture<Value>>(ReadMapping2D(request), corners));
}

template <class Value>
ParameterOf<Value> MakeCheckerboard(const TextureRequest& request) {
  const int dimension = request.Parameters().GetInteger("dimension", 2);
  if (dimension != 2 && dimension != 3) {
    throw Error(request.Parameters().WhereOf("dimension"), "a checkerboard has dimension 2 or 3");
  }
  const TextureMapping2D mapping = dimension == 2 ? ReadMapping2D(request) : TextureMapping2D{};
  return ParameterOf<Value>(std::make_shared<CheckerboardTexture<Value>>(
      mapping, TextureMapping3D{request.renderToTexture}, dimension == 3, GetValue<Value>(request, "tex1", 1),
      GetValue<Value>(request, "tex2", 0)));
}

template <class Value>
ParameterOf<Value> MakeDots(const TextureRequest& request) {
  return ParameterOf<Value>(std::make_shared<DotsTexture<Value>>(
      ReadMapping2D(request), GetValue<Value>(request, "inside", 1), GetValue<Value>(request, "outside", 0)));
}

template FloatParameter MakeBilerp<float>(const TextureRequest&);
template ColorParameter MakeBilerp<Color>(const TextureRequest&);
template FloatParameter MakeCheckerboard<float>(const TextureRequest&);
template ColorParameter MakeCheckerboard<Color>(const TextureRequest&);
template FloatParameter MakeDots<float>(const TextureRequest&);
template ColorParameter MakeDots<Color>(const TextureRequest&);

}  // namespace lampyr
