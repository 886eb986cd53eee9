// A light's front is its own, and its place that of a light with the same transform.
#include "lights/services/light_fronts.h"

#include <gtest/gtest.h>

#include <functional>

#include "light_fixture.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

using test::Build;

struct Lights {
  std::vector<std::unique_ptr<test::BuiltLight>> built;  // what a light needs to live
  std::vector<PlacedLight> placed;

  void Add(const std::string& type, std::shared_ptr<const Light> same = nullptr) {
    if (!same) {
      built.push_back(Build(type, ""));
      same = std::shared_ptr<const Light>(std::move(built.back()->light));
    }
    PlacedLight light;
    light.light = std::move(same);
    placed.push_back(std::move(light));
  }
};

void ExpectOwnFronts(const std::vector<PlacedLight>& lights) {
  const LightFronts fronts(lights);
  ASSERT_EQ(fronts.Size(), lights.size());
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const LightFront front = fronts[i];
    ASSERT_EQ(front.light, lights[i].light.get()) << i;
    ASSERT_EQ(front.kind, lights[i].light->Kind()) << i;
    ASSERT_EQ(front.canBeHit, lights[i].canBeHit) << i;
    ASSERT_EQ(front.isInstance, lights[i].isInstance) << i;
    ASSERT_EQ(front.moves, lights[i].motion != nullptr) << i;
    ASSERT_LE(front.place, i);
    ASSERT_EQ(lights[front.place].transform.toRender.translation, lights[i].transform.toRender.translation) << i;
  }
}

TEST(LightFronts, AreThoseOfEachLight) {
  for (const size_t count : {0, 1, 2, 63, 64, 65, 129, 40000}) {  // the last: more than a page of lights
    Lights lights;
    for (size_t i = 0; i < count; ++i) lights.Add("point");
    ExpectOwnFronts(lights.placed);
  }
}

// Lights that differ from their neighbours in kind, object or place.
TEST(LightFronts, OfLightsThatDiffer) {
  const std::vector<std::function<void(Lights&, size_t)>> differences = {
      [](Lights& lights, size_t) { lights.Add("spot"); },
      [](Lights& lights, size_t) { lights.Add("infinite"); },
      [](Lights& lights, size_t i) { lights.Add("point", lights.placed[i - 1].light); },
      [](Lights& lights, size_t i) { lights.Add("point", lights.placed[i / 2].light); },
      [](Lights& lights, size_t) {
        lights.Add("point");
        lights.placed.back().canBeHit = false;
      },
      [](Lights& lights, size_t) {
        lights.Add("point");
        lights.placed.back().isInstance = true;
      },
      [](Lights& lights, size_t) {
        lights.Add("point");
        lights.placed.back().transform.toRender.translation = Vector3(1, 2, 3);
      },
  };
  Rng rng(1);
  for (const auto& addDifferent : differences) {
    Lights lights;
    for (size_t i = 0; i < 1000; ++i) {
      if (i > 0 && rng.NextUint32() % 100 == 0) {
        addDifferent(lights, i);
      } else {
        lights.Add("point");
      }
    }
    ExpectOwnFronts(lights.placed);
  }
}

}  // namespace
}  // namespace lampyr
