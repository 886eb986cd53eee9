// Noise textures: fbm, wrinkled, windy (float) and marble (colour).
#include <array>
#include <cmath>

#include "math/noise.h"
#include "textures/texture_families.h"

namespace lampyr {

namespace {

struct NoiseSettings {
  TextureMapping3D mapping;
  int octaves = 8;
  float roughness = 0.5f;  // amplitude of an octave relative to the one before
};

class FbmTexture : public FloatTexture {
 public:
  explicit FbmTexture(const NoiseSettings& settings) : settings_(settings) {}
  float Evaluate(const TextureContext& where) const override {
    return FractalNoise(settings_.mapping.Map(where), settings_.roughness, settings_.octaves);
  }

 private:
  NoiseSettings settings_;
};

class WrinkledTexture : public FloatTexture {
 public:
  explicit WrinkledTexture(const NoiseSettings& settings) : settings_(settings) {}
  float Evaluate(const TextureContext& where) const override {
    return Turbulence(settings_.mapping.Map(where), settings_.roughness, settings_.octaves);
  }

 private:
  NoiseSettings settings_;
};

// Waves whose amplitude follows a slowly varying wind strength.
class WindyTexture : public FloatTexture {
 public:
  explicit WindyTexture(const TextureMapping3D& mapping) : mapping_(mapping) {}
  float Evaluate(const TextureContext& where) const override {
    const Point3 p = mapping_.Map(where);
    return std::abs(FractalNoise(p * 0.1f, 0.5f, 3)) * FractalNoise(p, 0.5f, 6);
  }

 private:
  TextureMapping3D mapping_;
};

// Layers along y, perturbed by noise, coloured by a chain of cubic Bézier segments.
class MarbleTexture : public ColorTexture {
 public:
  MarbleTexture(const NoiseSettings& settings, float scale, float variation)
      : settings_(settings), scale_(scale), variation_(variation) {}

  Color Evaluate(const TextureContext& where) const override {
    const Point3 p = settings_.mapping.Map(where) * scale_;
    const float phase = p.y + variation_ * FractalNoise(p, settings_.roughness, settings_.octaves);
    return Veins(0.5f + 0.5f * std::sin(phase));
  }

 private:
  static Color Veins(float t) {
    static constexpr Color kLight(0.58f, 0.58f, 0.6f), kDark(0.5f, 0.5f, 0.5f), kWarm(0.6f, 0.59f, 0.58f);
    static constexpr std::array<Color, 9> kColors = {
        kLight, kLight, kLight, kDark, kWarm, kLight, kLight, Color(0.2f, 0.2f, 0.33f), kLight};
    constexpr int kSegments = static_cast<int>(kColors.size()) - 3;
    const float along = t * static_cast<float>(kSegments);
    const int first = std::clamp(static_cast<int>(along), 0, kSegments - 1);
    const float u = along - static_cast<float>(first), v = 1 - u;
    const Color* c = &kColors[static_cast<size_t>(first)];
    return 1.5f * (c[0] * (v * v * v) + c[1] * (3 * v * v * u) + c[2] * (3 * v * u * u) + c[3] * (u * u * u));
  }

  NoiseSettings settings_;
  float scale_, variation_;
};

NoiseSettings ReadNoiseSettings(const TextureRequest& request) {
  constexpr int maxOctaves = 32;
  NoiseSettings settings;
  settings.mapping = {request.renderToTexture};
  settings.octaves = request.Parameters().GetInteger("octaves", 8);
  settings.roughness = static_cast<float>(request.Parameters().GetFloat("roughness", 0.5));
  if (settings.octaves < 0 || settings.octaves > maxOctaves) {
    throw Error(request.Parameters().WhereOf("octaves"), "octaves must be from 0 to " + std::to_string(maxOctaves));
  }
  return settings;
}

}  // namespace

FloatParameter MakeFbm(const TextureRequest& request) {
  return FloatParameter(std::make_shared<FbmTexture>(ReadNoiseSettings(request)));
}

FloatParameter MakeWrinkled(const TextureRequest& request) {
  return FloatParameter(std::make_shared<WrinkledTexture>(ReadNoiseSettings(request)));
}

FloatParameter MakeWindy(const TextureRequest& request) {
  return FloatParameter(std::make_shared<WindyTexture>(TextureMapping3D{request.renderToTexture}));
}

ColorParameter MakeMarble(const TextureRequest& request) {
  const float scale = static_cast<float>(request.Parameters().GetFloat("scale", 1));
  const float variation = static_cast<float>(request.Parameters().GetFloat("variation", 0.2));
  return ColorParameter(std::make_shared<MarbleTexture>(ReadNoiseSettings(request), scale, variation));
}

}  // namespace lampyr
