#include "extremes/measurement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "film/metrics.h"
#include "support/render_scene.h"

namespace lampyr::test {

namespace {

constexpr int kReplicas = 16;
constexpr int kMostComparisons = 2000;  // of the whole suite, for the family-wise rate
constexpr double kRounding = 3e-7;      // of a mean of floats
constexpr double kNothing = 1e-30;      // smaller values are 0: lights of the suite have a radiance of 3 or so

Measured MeasureBy(const std::string& integrator, const ExtremeCase& extreme, BuiltScene& built) {
  built.settings.integrator = integrator;
  Measured measured;
  measured.integrator = integrator;
  double sum = 0, squares = 0;
  const uint64_t rejectedBefore = built.scene.geometry->RejectedRays();
  std::vector<double> means;
  for (int i = 0; i < kReplicas; ++i) {
    built.settings.seed = static_cast<uint64_t>(i);
    const Rendered rendered = RenderBuilt(built, integrator == "light" ? extreme.lightSamples : extreme.samples, 1);
    for (const float value : rendered.image.data) measured.isFinite = measured.isFinite && std::isfinite(value);
    means.push_back(MeanOf(rendered.image).mean);
    sum += means.back();
    measured.dropped += rendered.outcome.counts.droppedSamples;
  }
  measured.dropped += built.scene.geometry->RejectedRays() - rejectedBefore;
  measured.mean = sum / kReplicas;
  for (const double mean : means) squares += (mean - measured.mean) * (mean - measured.mean);
  measured.standardError = std::sqrt(squares / (kReplicas * (kReplicas - 1)));
  return measured;
}

std::string Text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

void Judge(const ExtremeCase& extreme, const Measured& m, std::vector<std::string>& faults) {
  static const double student = StudentQuantileTwoSided(SidakRate(1e-3, kMostComparisons), kReplicas - 1);
  const auto fault = [&](const std::string& what) { faults.push_back(m.integrator + ": " + what); };
  if (!m.isFinite) fault("a pixel is not finite");
  if (m.dropped > 0) fault(std::to_string(m.dropped) + " dropped samples or rejected rays");
  const double noise = student * m.standardError;
  if (extreme.expected > 0 && noise > extreme.noise * extreme.expected) {
    fault("too noisy to tell: " + Text(m.mean) + " +- " + Text(m.standardError) + ", expected " +
          Text(extreme.expected));
  }
  const double allowed = extreme.expected > 0 ? noise + (extreme.bias + kRounding) * extreme.expected : kNothing;
  if (!(std::abs(m.mean - extreme.expected) <= allowed)) {
    fault("found " + Text(m.mean) + " +- " + Text(m.standardError) + ", expected " + Text(extreme.expected) + " (" +
          Text(100 * (m.mean / extreme.expected - 1)) + " %)");
  }
}

}  // namespace

double Measured::RelativeError(double expected) const {
  return expected > 0 ? mean / expected - 1 : (mean < kNothing ? 0 : std::numeric_limits<double>::infinity());
}

const Measured& Row::Worst() const {
  return *std::max_element(measured.begin(), measured.end(), [this](const Measured& a, const Measured& b) {
    return std::abs(a.RelativeError(of->expected)) < std::abs(b.RelativeError(of->expected));
  });
}

std::string Row::Verdict() const {
  return of->limit.empty() ? "right" : "limit: " + of->limit;
}

Row Measure(const ExtremeCase& extreme) {
  Row row;
  row.of = &extreme;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  SceneDescription description =
      ParseScene(extreme.scene, std::string(LAMPYR_SOURCE_DIR) + "/scenes/extreme.pbrt", diagnostics);
  if (extreme.change) extreme.change(description);
  BuiltScene built = BuildScene(description, extreme.overrides, true, diagnostics);
  row.warnings = diagnostics.Warnings();
  const bool isTold = std::any_of(row.warnings.begin(), row.warnings.end(), [&](const std::string& warning) {
    return warning.find(extreme.warning) != std::string::npos;
  });
  if (!extreme.warning.empty() && !isTold) row.faults.push_back("no warning says \"" + extreme.warning + "\"");
  if (extreme.warning.empty() && !row.warnings.empty()) row.faults.push_back("warned of: " + row.warnings.front());
  if (!extreme.limit.empty() && extreme.warning.empty()) row.faults.push_back("a limit without a warning");
  for (const std::string& integrator : extreme.integrators) {
    row.measured.push_back(MeasureBy(integrator, extreme, built));
    Judge(extreme, row.measured.back(), row.faults);
  }
  return row;
}

}  // namespace lampyr::test
