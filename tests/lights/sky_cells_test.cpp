// The cells of a sky's image: texels are sampled as often as their density says, wherever they are in front.
#include "lights/types/sky_cells.h"

#include <gtest/gtest.h>

#include "math/frame.h"
#include "sampling/equal_area.h"
#include "sampling/rng.h"
#include "suite/statistics.h"

namespace lampyr {
namespace {

struct Picture {
  const char* name;
  int width, height;
  std::function<float(int, int)> value;
};

std::vector<Picture> Pictures() {
  const auto noise = [](int x, int y) { return 0.1f + static_cast<float>((x * 37 + y * 61) % 17); };
  return {{"one texel", 1, 1, [](int, int) { return 1.0f; }},
          {"four", 2, 2, [](int x, int y) { return x == y ? 1.0f : 3.0f; }},
          {"even", 64, 64, [](int, int) { return 1.0f; }},
          {"uneven sides", 37, 19, noise},
          {"sun", 96, 48, [&](int x, int y) { return x == 50 && y == 9 ? 1e9f : 0.5f; }},
          {"one bright texel of sixteen", 4, 4, [](int x, int y) { return x == 2 && y == 1 ? 1e9f : 0.5f; }},
          {"a sun alone, on black", 1024, 512, [](int x, int y) { return x == 301 && y == 250 ? 1.0f : 0.0f; }},
          {"half black", 32, 32, [noise](int x, int y) { return x < 16 ? 0.0f : noise(x, y); }}};
}

Vector3 DirectionAt(const Picture& picture, const Point2& uv) {
  return picture.width == picture.height ? EqualAreaSquareToSphere(uv) : LatLongSquareToSphere(uv);
}

ColorTable TableOf(const Picture& picture) {
  std::vector<float> weights;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(picture.height);
      weights.push_back(picture.value(x, y) * (picture.width == picture.height ? 1.0f : std::sin(kPi * v)));
    }
  }
  return ColorTable(
      weights, [&](int x, int y) { return Color(picture.value(x, y)); }, picture.width, picture.height);
}

std::vector<SkyReceiver> ReceiversOf() {
  std::vector<SkyReceiver> receivers;
  for (const Vector3& n : {Vector3(0, 0, 1), Vector3(0, 0, -1), Vector3(-1, 0.3f, -0.2f), Vector3(0.3f, -0.8f, 0.1f)}) {
    receivers.push_back({glm::normalize(n), false});
    receivers.push_back({glm::normalize(n), true});
  }
  return receivers;
}

TEST(SkyCells, TexelsAreSampledByTheirDensity) {
  for (const Picture& picture : Pictures()) {
    const ColorTable table = TableOf(picture);
    const SkyCells cells(table, [&](const Point2& uv) { return DirectionAt(picture, uv); });
    std::vector<SkyReceiver> receivers = ReceiversOf();
    // Just in front of the sun, and just behind it.
    const Vector3 sun = DirectionAt(picture, {301.5f / 1024, 250.5f / 512});
    for (const float tilt : {0.02f, 0.004f, -0.02f}) {
      receivers.push_back({glm::normalize(Frame::FromNormal(sun).x + tilt * sun), false});
      receivers.push_back({glm::normalize(Frame::FromNormal(sun).y - tilt * sun), true});
    }
    for (const SkyReceiver& receiver : receivers) {
      const std::string what = std::string(picture.name) + (receiver.isTransmissive ? ", both sides" : "");
      const auto width = static_cast<size_t>(picture.width), texels = width * static_cast<size_t>(picture.height);
      constexpr int kDraws = 20000;
      std::vector<double> expected(texels + 1), observed(texels + 1), errors(texels + 1, 0.0);
      double sum = 0;
      for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
          const double p = static_cast<double>(cells.Gain(receiver, x, y)) * table.ShareOfRow(y, x, x + 1);
          sum += p;
          expected[static_cast<size_t>(y) * width + static_cast<size_t>(x)] = kDraws * p;
          const Point2 middle((static_cast<float>(x) + 0.5f) / static_cast<float>(picture.width),
                              (static_cast<float>(y) + 0.5f) / static_cast<float>(picture.height));
          const float cosine = glm::dot(DirectionAt(picture, middle), receiver.normal);
          const bool isSeen = picture.value(x, y) > 0 && (receiver.isTransmissive ? std::abs(cosine) : cosine) > 1e-3f;
          if (isSeen) {
            EXPECT_GT(p, 0) << what << " " << x << " " << y;
          }
        }
      }
      EXPECT_LT(sum, 1 + 1e-5) << what;
      // A block whose only sun is just behind the surface is selected without effect.
      if (picture.width != 1024) {
        EXPECT_GT(sum, 0.9) << what;
      }
      // The last entry is of draws without a sample: a block may be selected of which nothing is in front.
      expected.back() = kDraws * std::max(1 - sum, 0.0);
      Rng rng(5);
      for (int i = 0; i < kDraws; ++i) {
        const SkyCells::Choice choice = cells.Sample(table, receiver, rng.NextPoint2());
        observed.back() += choice.exists ? 0 : 1;
        if (!choice.exists) continue;
        EXPECT_NEAR(choice.gain, cells.Gain(receiver, choice.texel.x, choice.texel.y), 1e-6f * choice.gain);
        EXPECT_TRUE(choice.texel.t.x >= 0 && choice.texel.t.x < 1 && choice.texel.t.y >= 0 && choice.texel.t.y < 1);
        observed[static_cast<size_t>(choice.texel.y) * width + static_cast<size_t>(choice.texel.x)] += 1;
      }
      EXPECT_GT(ChiSquaredTest(observed, expected, errors), 1e-6) << what;
    }
  }
}

}  // namespace
}  // namespace lampyr
