#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/command_line.h"
#include "app/command_support.h"
#include "app/commands.h"
#include "app/compare/comparison.h"
#include "app/compare/first_look.h"
#include "app/compare/report.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "film/atomic_file.h"
#include "render/load_scene.h"
#include "render/output_files.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

ComparisonPlan MakePlan(const CompareOptions& options) {
  ComparisonPlan plan;
  for (const std::string& name : options.integrators) {
    VariantOf({}, name);
    if (std::find(plan.integrators.begin(), plan.integrators.end(), name) != plan.integrators.end()) {
      throw UsageError("--integrators: " + name + " is named twice");
    }
    plan.integrators.push_back(name);
  }
  plan.times = options.times;
  plan.sampleCounts = options.sampleCounts;
  if (plan.times.empty() && plan.sampleCounts.empty()) plan.times = {1, 4, 16};
  std::sort(plan.times.begin(), plan.times.end());
  std::sort(plan.sampleCounts.begin(), plan.sampleCounts.end());
  plan.times.erase(std::unique(plan.times.begin(), plan.times.end()), plan.times.end());
  plan.sampleCounts.erase(std::unique(plan.sampleCounts.begin(), plan.sampleCounts.end()), plan.sampleCounts.end());
  plan.repeats = options.repeats;
  plan.seed = options.overrides.seed;
  plan.exposure = options.exposure;
  return plan;
}

// Expected time of the longest of the compared renders of an integrator, seconds.
double LongestRender(const ComparisonPlan& plan, const Pilot& pilot) {
  const double ofTimes = plan.times.empty() ? 0 : plan.times.back();
  const double ofSamples =
      plan.sampleCounts.empty() ? 0 : pilot.seconds / pilot.samplesPerPixel * plan.sampleCounts.back();
  return std::max(ofTimes, ofSamples);
}

// The pilot of a compared integrator, or of the integrator that it is a variant of; null: none was made.
const Pilot* PilotOf(const ComparisonPlan& plan, const std::vector<Pilot>& pilots, const std::string& name) {
  const auto find = [&](const std::string& integrator) -> const Pilot* {
    const auto found =
        std::find_if(pilots.begin(), pilots.end(), [&](const Pilot& pilot) { return pilot.integrator == integrator; });
    return found == pilots.end() ? nullptr : &*found;
  };
  const Pilot* own = find(name.substr(0, name.find(':')));
  return !own && IsAuto(name) ? find(plan.autoIntegrator) : own;
}

double LongestRender(const ComparisonPlan& plan, const std::vector<Pilot>& pilots) {
  double longest = plan.times.empty() ? 0 : plan.times.back();
  for (const std::string& name : plan.integrators) {
    if (const Pilot* pilot = PilotOf(plan, pilots, name)) longest = std::max(longest, LongestRender(plan, *pilot));
  }
  if (longest > 0) return longest;
  // No pilot was made of these integrators.
  for (const Pilot& pilot : pilots) longest = std::max(longest, LongestRender(plan, pilot));
  return longest;
}

// Throws a UsageError if the reference, whose noise is known, is noisier than all renders that would be measured
// against it, and the pilots show this before the work starts. A render that misses light has an error in addition to
// its noise, and so has one that blurs; a render without a pilot may have any error.
void CheckReferenceIsFinerThanRenders(const Reference& reference, const ComparisonPlan& plan,
                                      const std::vector<Pilot>& pilots) {
  for (const std::string& name : plan.integrators) {
    const Pilot* pilot = PilotOf(plan, pilots, name);
    if (!pilot || pilot->isFlawed || !(pilot->mean > 0)) return;
    const double noise = pilot->relMse * pilot->seconds / LongestRender(plan, *pilot);
    if (noise + pilot->bias * pilot->bias >= *reference.noiseOfNeighbourhoods) return;
  }
  throw UsageError("--reference: \"" + reference.facts.file +
                   "\" is noisier than all that would be measured against it; use one of more samples, or leave the "
                   "option out to have one made");
}

// Progress bar over stages of the work. For stages other than the current one only their share is known.
class Stages {
 public:
  explicit Stages(bool quiet) : progress_(quiet) {}
  void Begin(double from, double to) {
    from_ = from;
    to_ = to;
  }
  void Update(double fraction, const std::string& note) { progress_.Update(from_ + (to_ - from_) * fraction, note); }

 private:
  Progress progress_;
  double from_ = 0, to_ = 1;
};

Reference ObtainReference(const CompareOptions& options, const ComparedScene& scene, const ComparisonPlan& plan,
                          const std::string& sceneHash, const std::filesystem::path& folder, Stages& stages,
                          ComparisonResults& results) {
  const auto update = [&](double fraction, const std::string& note) { stages.Update(fraction, note); };
  const double time = plan.times.empty() ? 4 : plan.times.back();
  const double pilotSeconds = std::clamp(0.5 * time, 0.5, 10.0);
  const auto flyPilots = [&] {
    stages.Begin(0, 0.05);
    results.pilots = FlyPilots(scene, pilotSeconds, options.referenceSeconds.value_or(10 * time), update);
  };
  if (options.reference) {
    Reference reference = ReadReference(*options.reference, scene.Built().settings, sceneHash);
    if (reference.noiseOfNeighbourhoods) {
      flyPilots();
      CheckReferenceIsFinerThanRenders(reference, plan, results.pilots);
    }
    return reference;
  }
  const std::filesystem::path file = folder / "reference.exr";
  const std::string key = ReferenceKey(scene, sceneHash);
  const auto wanted = [&](double longest) { return options.referenceSeconds.value_or(10 * longest); };
  if (options.referenceSeconds || plan.sampleCounts.empty()) {  // the time is known without pilots
    if (auto kept = FindKeptReference(file, key, wanted(time))) {
      kept->facts.file = file.string();
      return *kept;
    }
  }
  flyPilots();
  const auto findsLight = [](const Pilot& pilot) { return pilot.mean > 0; };
  if (std::none_of(results.pilots.begin(), results.pilots.end(), findsLight)) {
    throw Error("a first look by all integrators found no light: there is nothing to compare");
  }
  const double longest = LongestRender(plan, results.pilots);
  if (auto kept = FindKeptReference(file, key, wanted(longest))) {
    kept->facts.file = file.string();
    return *kept;
  }
  const auto chosen =
      std::find_if(results.pilots.begin(), results.pilots.end(), [](const Pilot& p) { return p.chosen; });
  const double compared = longest * plan.repeats * static_cast<double>(plan.integrators.size());
  stages.Begin(0.05, 0.05 + 0.95 * wanted(longest) / (wanted(longest) + compared));
  Reference reference =
      MakeReference(scene, chosen->integrator, chosen->seconds / chosen->samplesPerPixel, wanted(longest), update);
  reference.facts.file = file.string();
  if (!(reference.facts.mean > 0)) throw Error("the reference came out black: there is nothing to compare");
  KeepReference(reference, key, wanted(longest), file);
  return reference;
}

// Checks the memory for a picture per milestone of each repeat, with R, G and B, and for work on a few of them; and,
// before those pictures exist, for the reference. `mayMerge`: a reference by merged photons may be rendered, of up to
// four radii.
void CheckMemory(const RenderSettings& settings, const ComparisonPlan& plan, bool mayMerge) {
  const double milestones = static_cast<double>(plan.times.size() + plan.sampleCounts.size());
  const double images = static_cast<double>(plan.integrators.size()) * milestones * plan.repeats;
  const double pixels = static_cast<double>(settings.crop.Width()) * settings.crop.Height();
  // A Level has 180 bytes per pixel for each radius; its mean comes again with the result, and sums with differences.
  const double ofReference = mayMerge ? pixels * (4 * 180 + 4 * 24 + 24 + 100) : 0;
  const double bytes = std::max(images * pixels * 3 * sizeof(float), ofReference) + 700 * pixels;
  if (bytes <= static_cast<double>(AvailableMemory())) return;
  throw UsageError("comparing takes " + std::to_string(static_cast<int64_t>(bytes / (1 << 30)) + 1) +
                   " GiB of memory, more than there is: use fewer budgets or repeats, --crop or --resolution");
}

void WritePictures(const std::filesystem::path& folder, const ComparisonResults& results) {
  for (const auto& [key, png] : results.pictures) {
    if (key.rfind("error-", 0) == 0) continue;  // gray levels, coloured by the page
    AtomicFile file(folder / (key + ".png"));
    file.Write(png.data(), png.size());
    file.Commit();
  }
}

void WriteResults(const CompareOptions& options, const std::filesystem::path& folder, const ComparisonPlan& plan,
                  const ComparisonResults& results) {
  Outputs outputs;
  outputs.Write([&] { WriteText(folder / "results.json", ToJson(results)); });
  outputs.Write([&] { WriteText(folder / "results.csv", ToCsv(results)); });
  const std::string page = ToPage(results);
  if (!page.empty()) outputs.Write([&] { WriteText(folder / "report.html", page); });
  outputs.Write([&] { WritePictures(folder, results); });
  if (!options.quiet) {
    std::printf("%s", ToText(results).c_str());
    if (results.repeats < plan.repeats) std::printf("interrupted: %d of %d repeats\n", results.repeats, plan.repeats);
    if (!outputs.HasFailed())
      std::printf("\n%s: results.csv, results.json%s\n", folder.c_str(), page.empty() ? "" : ", report.html");
  }
  if (page.empty()) {
    std::fprintf(stderr,
                 "warning: no report.html: its page was not built (with npm: cmake --build … --target "
                 "lampyr_report_page)\n");
  }
  const bool unresolved =
      std::any_of(results.integrators.begin(), results.integrators.end(), [](const auto& integrator) {
        return std::any_of(integrator.snapshots.begin(), integrator.snapshots.end(),
                           [](const auto& s) { return !s.relMse; });
      });
  if (unresolved) {
    std::fprintf(stderr, "warning: some renders are within the reference's own noise%s and have no figure; %s\n",
                 results.reference.IsBlurred() ? " and blur" : "",
                 options.reference ? "use a reference of more samples" : "give it more time with --reference-time");
  }
  outputs.ThrowFailure();
}

// The part of the description of the run that is known before any measurement.
ComparisonResults Describe(const CompareOptions& options, const LoadedScene& loaded) {
  const RenderSettings& settings = loaded.built.settings;
  ComparisonResults results;
  results.scene = options.scene.string();
  results.sceneHash = loaded.hash;
  results.command = options.command;
  results.width = settings.crop.Width();
  results.height = settings.crop.Height();
  results.maxDepth = settings.MaxDepth();
  results.threads = options.threads > 0 ? options.threads : HardwareThreads();
  results.ofProcessor = options.ofProcessor;
  return results;
}

int CompareLoaded(const CompareOptions& options, ComparisonPlan plan, const LoadedScene& loaded) {
  const RenderSettings& settings = loaded.built.settings;
  const bool hasAuto = std::any_of(plan.integrators.begin(), plan.integrators.end(), IsAuto);
  plan.autoIntegrator = settings.integrator;
  if (hasAuto && !options.quiet) std::printf("auto: %s\n", settings.counts->Describe(settings.integrator).c_str());
  for (const std::string& name : plan.integrators) {
    const RenderSettings variant = VariantOf(settings, name);
    const std::string refusal = IntegratorRefusal(loaded.built.scene, variant.integrator);
    if (!refusal.empty()) throw UsageError("--integrators: " + name + ": " + refusal);
    if (variant.adaptive && MakeIntegrator(loaded.built.scene, variant)->Paths() == TracedPaths::Light)
      throw UsageError("--integrators: " + name + ": " + variant.integrator +
                       " follows no camera paths, whose number could differ from pixel to pixel");
  }
  const std::filesystem::path folder =
      options.output.empty() ? std::filesystem::path(options.scene.stem().string() + "-compare") : options.output;
  CheckMemory(settings, plan, !options.reference && IntegratorRefusal(loaded.built.scene, "vcm").empty());
  MakeFolder(folder, "--output");
  for (const char* file : {"results.json", "results.csv", "report.html"}) CheckWritable(folder / file, "--output");

  ComparisonResults results = Describe(options, loaded);
  const ComparedScene scene(loaded.built, results.threads, FinishOnInterrupt(), options.ofProcessor);
  if (!options.quiet) {
    for (const std::string& name : plan.integrators) {
      for (const std::string& hint : IntegratorHints(loaded.built.scene, VariantOf(settings, name).integrator)) {
        std::fprintf(stderr, "hint: %s: %s\n", name.c_str(), hint.c_str());
      }
    }
  }
  // The reference is unbiased, whatever the scene or the command line specifies.
  BuiltScene unbiased = loaded.built;
  MakeConsistent(unbiased.settings.values);
  const ComparedScene referenceScene(unbiased, results.threads, FinishOnInterrupt(), options.ofProcessor);
  bool interrupted = false;
  {
    Stages stages(options.quiet);
    try {
      const Reference reference = ObtainReference(options, referenceScene, plan, loaded.hash, folder, stages, results);
      results.reference = reference.facts;
      const double longest = std::max(LongestRender(plan, results.pilots), 1e-3);
      const double compared = longest * plan.repeats * static_cast<double>(plan.integrators.size());
      const bool wasMade = reference.facts.origin == ComparisonReference::Origin::Made;
      stages.Begin(wasMade ? 1 - 0.95 * compared / (compared + reference.facts.seconds) : 0.05, 1);
      Compare(
          scene, plan, reference, [&](double fraction, const std::string& note) { stages.Update(fraction, note); },
          results);
      interrupted = results.repeats < plan.repeats;
    } catch (const ComparisonInterrupted&) {
      interrupted = true;
    }
  }
  return FinishRendering([&] {
    if (interrupted && results.integrators.empty()) {
      std::fprintf(stderr, "interrupted before two repeats were done: nothing was measured\n");
      return InterruptExitCode();
    }
    WriteResults(options, folder, plan, results);
    return interrupted ? InterruptExitCode() : kExitDone;
  });
}

}  // namespace

int RunCompare(const CompareOptions& options) {
  const ComparisonPlan plan = MakePlan(options);
  OutliveSurroundings();
  RenderOverrides overrides = options.overrides;
  overrides.threads = options.threads;
  const bool hasAuto = std::any_of(plan.integrators.begin(), plan.integrators.end(), IsAuto);
  overrides.integrator = hasAuto ? kAuto : VariantOf({}, plan.integrators.front()).integrator;
  const LoadedScene loaded = LoadScene(options.scene, options.plugins, overrides, options.strict, options.robust);
  int exitCode = kExitFailed;
  RunForeignCode(loaded.types, [&] { exitCode = CompareLoaded(options, plan, loaded); });
  return exitCode;
}

}  // namespace lampyr
