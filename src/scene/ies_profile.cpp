// Converts the candela over the measured angles of an IES file to a profile over the whole sphere: symmetry, types A
// and B, power.
#include "scene/ies_profile.h"

#include <algorithm>
#include <cmath>

#include "scene/ies_text.h"
#include "scene/text_file.h"

namespace lampyr {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;

// Exact for multiples of 90.
double ToRadians(double degrees) {
  return degrees / 180 * kPiDouble;
}

bool Near(double a, double b) {
  return std::abs(a - b) < 0.01;
}

// The interval of `knots` that contains x, and the position t of x in it.
struct Place {
  size_t index;
  double t;
};
Place Find(const std::vector<double>& knots, double x) {
  const size_t above = static_cast<size_t>(std::upper_bound(knots.begin(), knots.end(), x) - knots.begin());
  const size_t index = std::min(std::max<size_t>(above, 1), knots.size() - 1) - 1;
  return {index, std::clamp((x - knots[index]) / (knots[index + 1] - knots[index]), 0.0, 1.0)};
}

double Bilinear(const std::vector<double>& values, size_t stride, const Place& fast, const Place& slow) {
  const double* v = &values[slow.index * stride + fast.index];
  const double low = v[0] + fast.t * (v[1] - v[0]), high = v[stride] + fast.t * (v[stride + 1] - v[stride]);
  return low + slow.t * (high - low);
}

// A plane of the full circle: its angle, and the planes of the file between which its values are interpolated.
struct Plane {
  double degrees;
  size_t source;
  size_t other = 0;
  double t = 0;  // 0 at `source`, 1 at `other`
};

// The planes of a type C file over [0°, 360°] ([LM-63-02 §5.13]): a single plane stands for all; 0°-90° and 0°-180° are
// mirrored; 90°-270° (since 1995) is mirrored at the 90°-270° plane; 0°-360° is complete.
std::vector<Plane> FullCircle(const IesFile& file) {
  const std::vector<double>& h = file.horizontal;
  const size_t last = h.size() - 1;
  if (h.size() == 1) return {{0, 0}, {360, 0}};
  std::vector<Plane> planes;
  for (size_t i = 0; i < h.size(); ++i) planes.push_back({h[i], i});
  const auto mirrorAt = [&planes](double degrees) {
    planes.back().degrees = degrees;
    for (size_t i = planes.size() - 1; i-- > 0;) planes.push_back({2 * degrees - planes[i].degrees, planes[i].source});
  };
  if (Near(h[0], 90) && Near(h[last], 270)) {
    planes.front().degrees = 90;
    mirrorAt(270);  // now 90° to 450°
    const auto above = std::find_if(planes.begin(), planes.end(), [](const Plane& p) { return p.degrees > 360; });
    const Plane before = *(above - 1), after = *above;
    const Plane seam = {360, before.source, after.source, (360 - before.degrees) / (after.degrees - before.degrees)};
    std::vector<Plane> turned = {seam};
    turned[0].degrees = 0;
    for (auto plane = above; plane != planes.end(); ++plane) turned.push_back({plane->degrees - 360, plane->source});
    for (auto plane = planes.begin() + 1; plane != above && plane->degrees < 360; ++plane) turned.push_back(*plane);
    turned.push_back(seam);
    return turned;
  }
  if (!Near(h[0], 0)) {
    throw Error(file.horizontalWhere,
                "the horizontal angles of type C photometry have to start at 0 (or be 90 to 270 degrees)");
  }
  planes.front().degrees = 0;
  if (Near(h[last], 90)) mirrorAt(90);
  if (Near(planes.back().degrees, 180)) mirrorAt(180);
  if (!Near(planes.back().degrees, 360)) {
    // Some programs omit the plane at 360°, which equals that at 0°.
    if (!(h[last] > 180) || 360 - h[last] > 1.01 * std::max(h[last] - h[last - 1], h[1] - h[0])) {
      throw Error(file.horizontalWhere,
                  "the horizontal angles of type C photometry have to end at 0 (one plane), 90, "
                  "180 or 360 degrees");
    }
    planes.push_back({360, 0});
  }
  planes.back().degrees = 360;
  return planes;
}

// Candela of a type A or B file in a direction given by its forward, right and up components. Type A has its poles
// above and below: vertical angles are elevations. Type B has them left and right: horizontal angles are measured from
// the forward-up plane. Angles that start at 0° are symmetric.
double SideIntensity(const IesFile& file, double forward, double right, double up) {
  const bool typeA = file.type == IesPhotometry::TypeA;
  double h = typeA ? std::atan2(right, forward) : std::asin(std::clamp(right, -1.0, 1.0));
  double v = typeA ? std::asin(std::clamp(up, -1.0, 1.0)) : std::atan2(up, forward);
  h *= 180 / kPiDouble;
  v *= 180 / kPiDouble;
  if (Near(file.horizontal.front(), 0)) h = std::abs(h);
  if (Near(file.vertical.front(), 0)) v = std::abs(v);
  const double slack = 1e-9;
  if (h < file.horizontal.front() - slack || h > file.horizontal.back() + slack || v < file.vertical.front() - slack ||
      v > file.vertical.back() + slack) {
    return 0;
  }
  return Bilinear(file.candela, file.vertical.size(), Find(file.vertical, v), Find(file.horizontal, h));
}

double SmallestStep(const std::vector<double>& angles) {
  double step = 360;
  for (size_t i = 1; i < angles.size(); ++i) step = std::min(step, angles[i] - angles[i - 1]);
  return step;
}

// ∫ (a + t (b - a)) sinθ dθ over [low, high], with t from 0 to 1: Gauss-Legendre quadrature with 4 points in pieces of
// at most 0.2, exact to rounding, and without the cancellation of the closed form near the poles.
double IntegrateRow(double low, double high, double a, double b) {
  constexpr double kNode[2] = {0.8611363115940526, 0.3399810435848563};
  constexpr double kWeight[2] = {0.3478548451374538, 0.6521451548625461};
  const int pieces = static_cast<int>(std::ceil((high - low) / 0.2));
  const double h = (high - low) / pieces;
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    for (const int side : {-1, 1}) {
      for (int k = 0; k < 2; ++k) {
        const double theta = low + (i + 0.5 * (1 + side * kNode[k])) * h;
        sum += kWeight[k] * (a + (b - a) * (theta - low) / (high - low)) * std::sin(theta);
      }
    }
  }
  return 0.5 * h * sum;
}

}  // namespace

class IesReader {
 public:
  static std::shared_ptr<const IesProfile> Make(const IesFile& file) {
    const auto profile = std::make_shared<IesProfile>();
    if (file.type == IesPhotometry::TypeC) {
      Unfold(file, *profile);
    } else {
      Resample(file, *profile);
    }
    Finish(*profile);
    return profile;
  }

 private:
  static void Unfold(const IesFile& file, IesProfile& profile) {
    for (const double degrees : file.vertical) profile.thetas_.push_back(ToRadians(degrees));
    const size_t count = file.vertical.size();
    double last = -1;
    for (const Plane& plane : FullCircle(file)) {
      if (!(plane.degrees > last))
        throw Error(file.horizontalWhere, "two horizontal angles are too close to each other");
      last = plane.degrees;
      profile.phis_.push_back(ToRadians(plane.degrees));
      const double* values = &file.candela[plane.source * count];
      const double* others = &file.candela[plane.other * count];
      for (size_t i = 0; i < count; ++i) profile.candela_.push_back(values[i] + plane.t * (others[i] - values[i]));
    }
  }

  // Types A and B have the luminaire face forward. Their axis at 0°, 0° is rotated to the nadir, by the rotation that
  // takes up to φ = 0. The grid has half the smallest step of the file, but at least a quarter of a degree.
  static void Resample(const IesFile& file, IesProfile& profile) {
    if (file.horizontal.size() < 2) {
      throw Error(file.horizontalWhere, "photometry of types A and B has to have at least 2 horizontal angles");
    }
    const double finest = std::min(SmallestStep(file.vertical), SmallestStep(file.horizontal));
    const int perDegree = static_cast<int>(std::ceil(1 / std::clamp(0.5 * finest, 0.25, 1.0)));
    const int rows = 90 * perDegree, columns = 360 * perDegree;
    for (int i = 0; i <= rows; ++i) profile.thetas_.push_back(0.5 * kPiDouble * i / rows);
    for (int j = 0; j <= columns; ++j) profile.phis_.push_back(2 * kPiDouble * j / columns);
    for (const double phi : profile.phis_) {
      for (const double theta : profile.thetas_) {
        const double side = std::sin(theta);
        profile.candela_.push_back(SideIntensity(file, std::cos(theta), -side * std::sin(phi), side * std::cos(phi)));
      }
    }
  }

  static void Finish(IesProfile& profile) {
    const size_t count = profile.thetas_.size();
    profile.largest_ = *std::max_element(profile.candela_.begin(), profile.candela_.end());
    std::vector<double> lowWeights, highWeights;  // of the two ends of each row; equal in all planes
    for (size_t i = 0; i + 1 < count; ++i) {
      lowWeights.push_back(IntegrateRow(profile.thetas_[i], profile.thetas_[i + 1], 1, 0));
      highWeights.push_back(IntegrateRow(profile.thetas_[i], profile.thetas_[i + 1], 0, 1));
    }
    for (size_t j = 0; j + 1 < profile.phis_.size(); ++j) {
      const double* values = &profile.candela_[j * count];
      double sum = 0;
      for (size_t i = 0; i + 1 < count; ++i) {
        const double low = 0.5 * (values[i] + values[i + count]), high = 0.5 * (values[i + 1] + values[i + 1 + count]);
        sum += lowWeights[i] * low + highWeights[i] * high;
      }
      profile.power_ += sum * (profile.phis_[j + 1] - profile.phis_[j]);
    }
  }
};

double IesProfile::Intensity(double theta, double phi) const {
  if (!(theta >= thetas_.front() && theta <= thetas_.back())) return 0;
  const double around = phi - 2 * kPiDouble * std::floor(phi / (2 * kPiDouble));
  return Bilinear(candela_, thetas_.size(), Find(thetas_, theta), Find(phis_, around));
}

std::shared_ptr<const IesProfile> ParseIes(const std::string& text, const std::string& name) {
  return IesReader::Make(ParseIesFile(text, name));
}

std::shared_ptr<const IesProfile> ReadIes(const std::string& file, const FileLocation& where) {
  return ParseIes(ReadTextFile(file, where), file);
}

}  // namespace lampyr
