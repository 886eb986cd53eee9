#include "suite/suite_inputs.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include "base/error.h"
#include "film/image.h"
#include "sampling/rng.h"

namespace lampyr::suite {

namespace {

void WriteImages(const std::filesystem::path& folder) {
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
  const auto striped = [&](int i) { return (i % 8) < 2 ? 0.0f : 0.2f + noise(i); };
  write("suite-texture.exr", 8, 8, striped);
  write("suite-square.exr", 8, 8, noise);
  write("suite-latlong.exr", 16, 8, noise);
  write("suite-bright.exr", 4, 4, [](int i) {
    return i == 6 ? 1e9f : i == 3 ? std::numeric_limits<float>::quiet_NaN() : i == 9 ? -1.0f : 0.5f;
  });
  write("suite-black.exr", 4, 4, [](int) { return 0.0f; });
  write("suite-texture-2.exr", 8, 8, striped);
  write("suite-square-2.exr", 8, 8, noise);
  write("suite-latlong-2.exr", 16, 8, noise);
}

// Vertical angles of uneven steps, nine planes; the plane at 360° repeats that at 0°, and all planes meet at the poles.
void WriteProfile(const std::filesystem::path& file, double phase) {
  constexpr int thetas[] = {0, 10, 20, 35, 50, 60, 75, 90, 105, 130, 155, 180};
  constexpr int planes = 9;
  std::string text =
      "IESNA:LM-63-2002\n[TEST] lampyr suite\n[MANUFAC] lampyr\n[LUMINAIRE] uneven in both angles\nTILT=NONE\n";
  text += "1 1000 1.5 " + std::to_string(std::size(thetas)) + " " + std::to_string(planes) + " 1 2 0 0 0\n1 1 60\n";
  for (const int theta : thetas) text += std::to_string(theta) + " ";
  text += "\n";
  for (int plane = 0; plane < planes; ++plane) text += std::to_string(45 * plane) + " ";
  text += "\n";
  for (int plane = 0; plane < planes; ++plane) {
    const double phi = 0.785398163397448 * (plane % (planes - 1));
    for (const int theta : thetas) {
      const double t = theta * 0.0174532925199433,
                   uneven = std::sin(t) * (0.5 * std::cos(phi + phase) + 0.3 * std::sin(3 * phi));
      char number[32];
      std::snprintf(number, sizeof(number), "%.2f ", theta == 180 ? 0.0 : 20 + 400 * (1 + std::cos(t)) * (1 + uneven));
      text += number;
    }
    text += "\n";
  }
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw Error("cannot write \"" + file.string() + "\"");
}

}  // namespace

void WriteSuiteInputs(const std::filesystem::path& folder) {
  WriteImages(folder);
  WriteProfile(folder / "suite-profile.ies", 0);
  WriteProfile(folder / "suite-profile-2.ies", 2);
}

std::string OtherSuiteInput(const std::string& name) {
  for (const char* first : {"suite-texture.exr", "suite-square.exr", "suite-latlong.exr", "suite-profile.ies"}) {
    const std::string stem = std::filesystem::path(first).stem().string(),
                      end = std::filesystem::path(first).extension().string();
    if (name == first) return stem + "-2" + end;
    if (name == stem + "-2" + end) return first;
  }
  return "";
}

}  // namespace lampyr::suite
