// The matrix of agreement: every feature crossed with every integrator in every mode.
//
// A row is a rig (matrix_rigs.h), a column a mode of an integrator (matrix_modes.h). In each cell the mode's picture
// is held against path tracing's: the means of the picture and of its quarters, per channel, from replicas with other
// seeds, by Welch's test. All cells together raise a false alarm once in a thousand suites (Šidák).
//
// A trial tells how many samples a cell takes until it would notice a picture that is so much too bright in 19 of 20
// cases: 12.5 % in the default suite, 2 % in `tests/run matrix-whole` (LAMPYR_MATRIX_NOTICES). A cell that cannot
// afford them fails.
//
// What is learned and guided is which light is chosen, and where it sends photons. By default rigs of lights have all
// modes that learn or guide; those of filters and motion three of the six in turn, of materials and cameras one.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <regex>

#include "lights/types/type_registry.h"
#include "matrix/matrix_modes.h"
#include "matrix/matrix_rigs.h"
#include "support/render_scene.h"
#include "support/replicas.h"
#include "support/temporary_folder.h"
#include "support/whole.h"

namespace lampyr::test {
namespace {

constexpr double kFamilyWise = 1e-3;
constexpr int kReplicas = 32, kTrials = 8;
// Seeds that a cell may use: its first half for replicas, the other for the trial.
constexpr uint64_t kSeedsOfACell = uint64_t{1} << 24;
constexpr int kMostRounds = 20;
// Standard errors between the truth and a threshold that it crosses in 19 of 20 cases.
constexpr double kPower = 1.645;
// Samples per pixel of a cell, at most: 12 × 12 pixels.
constexpr double kMostSamples = 200000;

// Relative bias of a picture that every cell notices.
double Noticed() {
  const char* text = std::getenv("LAMPYR_MATRIX_NOTICES");
  return text ? std::strtod(text, nullptr) : 0.125;
}

// The folder of the files that rigs read.
const TemporaryFolder& Folder() {
  static const TemporaryFolder folder;
  return folder;
}

const std::vector<Rig>& Rigs() {
  static const std::vector<Rig> rigs = MatrixRigs(Folder().Path());
  return rigs;
}

// False if the mode is light tracing and cannot show the rig.
bool Sees(const Rig& rig, const Mode& mode) {
  return mode.integrator != "light" || !(rig.cameraSeesDeltas || rig.refusesLightPaths);
}

bool IsItsTurn(const Rig& rig, const Mode& mode) {
  if (!mode.Adapts() || IsWhole() || rig.kind == "lights") return true;
  std::vector<std::string> adaptive;
  for (const Mode& one : Modes()) {
    if (one.Adapts()) adaptive.push_back(one.name);
  }
  // Neighbours are of one integrator: three that are not, or one.
  const size_t step = rig.kind == "filters" || rig.kind == "motion" ? 2 : adaptive.size();
  for (size_t i = rig.turn % step; i < adaptive.size(); i += step) {
    if (mode.name == adaptive[i]) return true;
  }
  return false;
}

bool IsCell(const Rig& rig, const Mode& mode) {
  return Sees(rig, mode) && IsItsTurn(rig, mode);
}

int Cells() {
  int cells = 0;
  for (const Rig& rig : Rigs()) {
    for (const Mode& mode : Modes()) cells += IsCell(rig, mode);
  }
  return cells;
}

BuiltScene Build(const std::string& text) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(text, (Folder() / "rig.pbrt").string(), diagnostics), {}, true, diagnostics);
}

Replicas RenderMode(BuiltScene& built, const Mode& mode, int replicas, int samples, uint64_t seed) {
  mode.Apply(built.settings);
  Replicas result;
  for (int i = 0; i < replicas; ++i) {
    built.settings.seed = seed + static_cast<uint64_t>(i);
    const Rendered rendered = RenderBuilt(built, samples, 1);
    result.images.push_back(rendered.image);
    result.faults += rendered.outcome.counts.droppedSamples + rendered.rejectedRays;
  }
  return result;
}

// Relative standard error of one replica's mean.
double NoiseOf(const Replicas& replicas) {
  using namespace replicas_internal;
  double worst = 0;
  for (size_t c = 0; c < 3; ++c) {
    const Moments moments = MomentsOf(Means(replicas, c, 0, 0, replicas.images[0].width, replicas.images[0].height));
    if (moments.mean > 0)
      worst = std::max(worst, std::sqrt(moments.variance * static_cast<double>(replicas.images.size())) / moments.mean);
  }
  return worst;
}

// A dark rig would agree with whatever finds no light.
bool IsLit(const Replicas& replicas) {
  const Image& image = replicas.images[0];
  for (size_t c = 0; c < 3; ++c) {
    const std::vector<double> means = replicas_internal::Means(replicas, c, 0, 0, image.width, image.height);
    if (std::any_of(means.begin(), means.end(), [](double mean) { return mean > 0; })) return true;
  }
  return false;
}

struct Cell {
  Replicas replicas;
  int samples = 0;  // per pixel and replica

  void Add(const Replicas& more) {
    replicas.images.insert(replicas.images.end(), more.images.begin(), more.images.end());
    replicas.faults += more.faults;
  }
};

// Renders the samples that bring the standard error of the mean to `error`, as trials predict. Sobol points converge
// faster than independent ones: a trial predicts no more than four times its own samples. A cell that is far surer than
// it says would find the blur of merging, which it is not about.
Cell RenderTo(BuiltScene& built, const Mode& mode, double error, uint64_t seed) {
  int samples = mode.Samples();
  double wanted = 0;
  for (;; samples *= 4) {
    const double noise = NoiseOf(RenderMode(built, mode, kTrials, samples, seed + kSeedsOfACell / 2));
    wanted = samples * Sqr(noise / error) / kReplicas;
    if (wanted <= 4.0 * samples || samples >= kMostSamples / kReplicas) break;
  }
  Cell cell;
  cell.samples = static_cast<int>(std::clamp(std::ceil(wanted), double(mode.Samples()), kMostSamples / kReplicas));
  cell.replicas = RenderMode(built, mode, kReplicas, cell.samples, seed);
  return cell;
}

// The same, with as many more replicas as it takes where the trial had met too little of the noise: what all modes are
// held against must be as sure as it is said to be.
Cell RenderReference(BuiltScene& built, double error, uint64_t seed) {
  Cell cell = RenderTo(built, Reference(), error, seed);
  for (int round = 1; round < kMostRounds; ++round) {
    const auto count = static_cast<double>(cell.replicas.images.size());
    const double ratio = NoiseOf(cell.replicas) / error, missing = ratio * ratio / count - 1;
    if (!(missing > 0)) break;
    const auto more = static_cast<int>(std::ceil(std::min(1.1 * missing, 1.0) * count));
    cell.Add(RenderMode(built, Reference(), std::max(more, 4), cell.samples, seed + cell.replicas.images.size()));
  }
  return cell;
}

struct Verdict {
  double bias = 0, error = 0;          // of the mean, of the channel that is farthest off
  double largestZ = 0, threshold = 0;  // over all means
  double noticed = 0;                  // the relative bias of a picture that would be found in 19 of 20 cases
  bool Agrees() const { return largestZ <= threshold; }
};

Verdict Compare(const Replicas& a, const Replicas& b, double rate) {
  using namespace replicas_internal;
  const int width = a.images[0].width, height = a.images[0].height;
  Verdict verdict;
  const auto n = static_cast<double>(std::min(a.images.size(), b.images.size()));
  const auto compare = [&](size_t c, int x0, int y0, int x1, int y1) {
    const Moments first = MomentsOf(Means(a, c, x0, y0, x1, y1)), second = MomentsOf(Means(b, c, x0, y0, x1, y1));
    const double z = Deviate(first, second, n);
    verdict.largestZ = std::max(verdict.largestZ, std::abs(z));
    return std::pair((first.mean - second.mean) / second.mean,
                     std::sqrt(first.variance + second.variance) / second.mean);
  };
  verdict.threshold = NormalQuantileTwoSided(SidakRate(rate, 15));
  for (size_t c = 0; c < 3; ++c) {
    const auto [bias, error] = compare(c, 0, 0, width, height);
    if (std::abs(bias) >= std::abs(verdict.bias)) verdict.bias = bias;
    verdict.error = std::max(verdict.error, error);
    for (const int x : {0, width / 2}) {
      for (const int y : {0, height / 2}) compare(c, x, y, x + width / 2, y + height / 2);
    }
  }
  // Student's quantile that belongs to the normal threshold ([Wallace59], inverted), for the degrees of freedom of a
  // mode that is much noisier than the reference.
  const double nu = n - 1, z = verdict.threshold * (8 * nu + 3) / (8 * nu + 1);
  const double student = std::sqrt(nu * std::expm1(z * z / nu));
  verdict.noticed = (student + kPower) * verdict.error;
  return verdict;
}

// The error that a cell's means may have for Noticed(), of the mode and of the reference.
struct Errors {
  double mode, reference;
};
Errors WantedErrors(double rate) {
  const double threshold = NormalQuantileTwoSided(SidakRate(rate, 15));
  const double nu = kReplicas - 1, z = threshold * (8 * nu + 3) / (8 * nu + 1);
  const double error = 0.95 * Noticed() / (std::sqrt(nu * std::expm1(z * z / nu)) + kPower);
  return {0.9 * error, 0.43 * error};
}

// A cell, and what it says. A trial of a few replicas tells the noise to a quarter at best, and may have met a sample
// that is rare: the cell begins with fewer samples than it says, and more replicas are asked for by the noise alone,
// which is no bias.
Verdict Measure(BuiltScene& built, const Mode& mode, double error, uint64_t seed, const Cell& reference, double rate,
                Cell& cell) {
  cell = RenderTo(built, mode, 1.8 * error, seed);
  Verdict verdict = Compare(cell.replicas, reference.replicas, rate);
  for (int round = 1; round < kMostRounds && verdict.noticed > Noticed(); ++round) {
    const double missing = 1.1 * (verdict.noticed * verdict.noticed / (Noticed() * Noticed()) - 1);
    const auto more =
        static_cast<int>(std::ceil(std::min(missing, 1.0) * static_cast<double>(cell.replicas.images.size())));
    cell.Add(RenderMode(built, mode, std::max(more, 4), cell.samples, seed + cell.replicas.images.size()));
    verdict = Compare(cell.replicas, reference.replicas, rate);
  }
  return verdict;
}

// Light tracing renders what it can, or says that it cannot, and what can.
void ExpectRefusal(BuiltScene& built, const Rig& rig) {
  built.settings.integrator = "light";
  std::string said = "nothing";
  try {
    MakeIntegrator(built.scene, built.settings);
  } catch (const UsageError& error) {
    said = error.what();
  }
  EXPECT_EQ(said.find("bdpt, vcm and sppm can") != std::string::npos, rig.refusesLightPaths)
      << rig.name << ": " << said;
}

class Matrix : public testing::TestWithParam<Rig> {};

TEST_P(Matrix, Agrees) {
  const Rig& rig = GetParam();
  static const double rate = SidakRate(kFamilyWise, Cells());
  const Errors errors = WantedErrors(rate);
  BuiltScene built = Build(rig.text);
  const Cell reference = RenderReference(built, errors.reference, 1);
  EXPECT_EQ(reference.replicas.faults, 0u);
  EXPECT_TRUE(IsLit(reference.replicas)) << rig.name;
  ExpectRefusal(built, rig);
  uint64_t seed = 1;
  const char* only = std::getenv("LAMPYR_MATRIX_MODE");
  for (const Mode& mode : Modes()) {
    seed += kSeedsOfACell;
    if (!IsCell(rig, mode) || (only && mode.name != only)) continue;
    const auto start = std::chrono::steady_clock::now();
    Cell cell;
    const Verdict verdict = Measure(built, mode, errors.mode, seed, reference, rate, cell);
    std::printf(
        "[   info   ] %-36s %-36s %+.2f %% +- %.2f %%, largest |z| %.2f (%.2f), notices %.2f %%, %d samples, %.1f s\n",
        rig.name.c_str(), mode.name.c_str(), 100 * verdict.bias, 100 * verdict.error, verdict.largestZ,
        verdict.threshold, 100 * verdict.noticed, cell.samples * static_cast<int>(cell.replicas.images.size()),
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    EXPECT_TRUE(verdict.Agrees()) << rig.name << " by " << mode.name << " is off by " << 100 * verdict.bias << " %";
    EXPECT_LE(verdict.noticed, Noticed()) << rig.name << " by " << mode.name << ": too noisy";
    EXPECT_EQ(cell.replicas.faults, 0u) << rig.name << " by " << mode.name << ": samples dropped, or rays rejected";
  }
}

// By what they vary.
std::vector<Rig> Of(const char* kind) {
  std::vector<Rig> some;
  for (const Rig& rig : Rigs()) {
    if (rig.kind == kind) some.push_back(rig);
  }
  return some;
}
std::string NameOf(const testing::TestParamInfo<Rig>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Materials, Matrix, testing::ValuesIn(Of("materials")), NameOf);
INSTANTIATE_TEST_SUITE_P(Lights, Matrix, testing::ValuesIn(Of("lights")), NameOf);
INSTANTIATE_TEST_SUITE_P(Filters, Matrix, testing::ValuesIn(Of("filters")), NameOf);
INSTANTIATE_TEST_SUITE_P(Motion, Matrix, testing::ValuesIn(Of("motion")), NameOf);
INSTANTIATE_TEST_SUITE_P(Cameras, Matrix, testing::ValuesIn(Of("cameras")), NameOf);

bool IsCovered(const std::string& what) {
  return std::any_of(Rigs().begin(), Rigs().end(), [&](const Rig& rig) {
    return std::find(rig.covers.begin(), rig.covers.end(), what) != rig.covers.end();
  });
}

TEST(MatrixIsWhole, EveryRegisteredTypeHasARig) {
  for (const std::string& type : MaterialTypeNames()) {
    EXPECT_TRUE(IsCovered("material " + type)) << "material " << type;
    // "none" and "" are other names of "interface".
    if (type == "none" || type.empty()) continue;
    EXPECT_TRUE(IsCovered("material " + type + " in mix")) << "a mix with " << type;
  }
  for (const LightType* type : TypeRegistry::BuiltIn().Lights()) {
    EXPECT_TRUE(IsCovered((type->isAreaLight ? "area light " : "light ") + type->name)) << type->name;
  }
  for (const FilterType* type : TypeRegistry::BuiltIn().Filters()) {
    EXPECT_TRUE(IsCovered("filter " + type->name)) << type->name;
  }
  for (const char* camera : {"perspective", "orthographic", "spherical", "realistic"})
    EXPECT_TRUE(IsCovered(std::string("camera ") + camera)) << camera;
  std::printf("[   info   ] %zu rigs, %zu modes, %d cells\n", Rigs().size(), Modes().size(), Cells());
}

// Each integrator, and each setting that decides on how light is found, in both of its ways.
TEST(MatrixIsWhole, EveryModeIsAColumn) {
  for (const std::string& name : IntegratorNames()) {
    const bool isThere =
        name == Reference().integrator ||
        std::any_of(Modes().begin(), Modes().end(), [&](const Mode& mode) { return mode.integrator == name; });
    EXPECT_TRUE(isThere) << name;
    if (name == "light") continue;
    // With learning and without.
    for (const bool learns : {false, true}) {
      EXPECT_TRUE(std::any_of(Modes().begin(), Modes().end(),
                              [&](const Mode& mode) { return mode.integrator == name && mode.learns == learns; }) ||
                  (name == "path" && !learns))
          << name << (learns ? " learning" : "");
    }
    if (!GathersPhotons(name, IntegratorSettings())) continue;
    for (const bool guides : {false, true}) {
      EXPECT_TRUE(std::any_of(Modes().begin(), Modes().end(),
                              [&](const Mode& mode) { return mode.integrator == name && mode.guides == guides; }))
          << name << (guides ? " guided" : "");
    }
  }
  // Settings of integrators: those that are no mode change no more than the noise or the blur, or are said to be
  // biased.
  const std::vector<std::string> modes = {"merge",         "connect",      "direct-photons",
                                          "guide-photons", "guide-paths",  "guide-always",
                                          "learn-lights",  "learn-always", "light-samples"},
                                 others = {"max-depth", "light-sampler", "photons",         "photon-memory",
                                           "radius",    "alpha",         "shadow-roulette", "light-edges"};
  const Settings settings = IntegratorSettings();
  for (const std::string& name : settings.Names()) {
    if (settings.Find(name)->isBiased) continue;
    EXPECT_TRUE(std::count(modes.begin(), modes.end(), name) + std::count(others.begin(), others.end(), name) == 1)
        << "the setting \"" << name << "\" of integrators is neither a mode nor said to be none";
  }
}

// Taking turns leaves nothing out: each mode meets each kind of rig, and each rig all integrators that can show it.
TEST(MatrixIsWhole, EveryModeMeetsEveryKind) {
  for (const char* kind : {"materials", "lights", "filters", "motion", "cameras"}) {
    for (const Mode& mode : Modes()) {
      EXPECT_TRUE(std::any_of(Rigs().begin(), Rigs().end(),
                              [&](const Rig& rig) { return rig.kind == kind && IsCell(rig, mode); }))
          << kind << " by " << mode.name;
    }
  }
  for (const Rig& rig : Rigs()) {
    for (const Mode& mode : Modes()) EXPECT_TRUE(mode.Adapts() || !Sees(rig, mode) || IsCell(rig, mode)) << rig.name;
    EXPECT_TRUE(std::any_of(Modes().begin(), Modes().end(), [&](const Mode& mode) {
      return mode.Adapts() && IsCell(rig, mode);
    })) << rig.name;
  }
}

// Ten cells whose picture is as much too bright as they are said to notice. That is in 19 of 20 cases; with errors that
// are smaller by a quarter it is all but sure.
TEST(MatrixNotices, WhatIsPlantedInTenCells) {
  const double rate = SidakRate(kFamilyWise, Cells());
  Errors errors = WantedErrors(rate);
  errors.mode *= 0.75;
  errors.reference *= 0.75;
  const char* rigs[] = {"matte_walls", "mix_with_mirror_object", "light_spot", "filter_gobo", "camera_spherical"};
  const char* modes[] = {"bdpt", "vcm --no-connect", "sppm --direct-photons", "light", "vcm"};
  int found = 0, planted = 0;
  for (size_t i = 0; i < 5; ++i) {
    const auto rig = std::find_if(Rigs().begin(), Rigs().end(), [&](const Rig& r) { return r.name == rigs[i]; });
    ASSERT_NE(rig, Rigs().end()) << rigs[i];
    BuiltScene built = Build(rig->text);
    // Exposure is no part of what integrators know of a scene.
    BuiltScene bright = Build(rig->text);
    bright.settings.sensor = bright.settings.sensor.ImagingRatio() * (1 + static_cast<float>(Noticed()));
    const Cell reference = RenderReference(built, errors.reference, 5);
    for (size_t k = 0; k < 2; ++k) {
      const auto mode =
          std::find_if(Modes().begin(), Modes().end(), [&](const Mode& m) { return m.name == modes[(i + 2 * k) % 5]; });
      ASSERT_NE(mode, Modes().end());
      Cell cell;
      const Verdict verdict =
          Measure(bright, *mode, errors.mode, 7000 + kSeedsOfACell * (2 * i + k + 1), reference, rate, cell);
      std::printf("[   info   ] %-24s %-24s %+.2f %% +- %.2f %%, largest |z| %.2f (%.2f)\n", rigs[i],
                  mode->name.c_str(), 100 * verdict.bias, 100 * verdict.error, verdict.largestZ, verdict.threshold);
      ++planted;
      found += verdict.Agrees() ? 0 : 1;
    }
  }
  EXPECT_EQ(found, planted);
  std::printf("[   info   ] %d of %d planted faults found\n", found, planted);
}

}  // namespace
}  // namespace lampyr::test
