#include "materials/measured.h"

#include <cmath>
#include <span>

#include "base/error.h"
#include "fuzz/target_support.h"
#include "materials/measured_file.h"

namespace lampyr::fuzz {

bool ReadMeasuredFile(std::string_view bytes) {
  return AcceptErrors([&] {
    const MeasuredData data = ParseMeasured(std::as_bytes(std::span(bytes)));
    const MeasuredBsdf bsdf{&data};
    constexpr int kDirections = 8;
    for (int i = 0; i < kDirections; ++i) {
      const float part = (static_cast<float>(i) + 0.5f) / kDirections, z = 1 - 2 * part;
      const float across = std::sqrt(1 - z * z), phi = 11 * part;
      const Vector3 wo(across * std::cos(phi), across * std::sin(phi), z);
      const auto sample = bsdf.Sample(wo, part, {part, 1 - part}, TransportMode::Radiance);
      if (!sample) continue;
      if (!(std::abs(glm::length(sample.wi) - 1) < 1e-5f)) Fail("a sample without a direction");
      if (!(sample.pdfForward.value > 0) || !(sample.pdfReverse.value >= 0)) Fail("a sample without a density");
      const BsdfEvaluation value = bsdf.Evaluate(wo, sample.wi, TransportMode::Importance);
      if (!(value.specular.Max() >= 0)) Fail("a value that is no number");
    }
  });
}

}  // namespace lampyr::fuzz
