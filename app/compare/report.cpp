#include "app/compare/report.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/progress.h"

namespace lampyr {

namespace {

template <class... Values>
std::string Format(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string Field(double value) {
  return std::isfinite(value) ? Format("%.6g", value) : "";
}

std::string Fields(const std::optional<Estimate>& estimate) {
  if (!estimate) return ",,";
  return Field(estimate->value) + "," + Field(estimate->low) + "," + Field(estimate->high);
}

std::string Quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string Base64(const std::vector<unsigned char>& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

// Escapes JSON so that it does not end a script element.
std::string Escaped(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

// Reads the built page: beside the executable, in ../lib/lampyr, or in the build folder.
std::string ReadTemplate() {
  std::error_code code;
  std::vector<std::filesystem::path> places;
  const char* name = "lampyr_report_page.html";
  const std::filesystem::path executable = std::filesystem::read_symlink("/proc/self/exe", code);
  if (!code) {
    places.push_back(executable.parent_path() / name);
    places.push_back(executable.parent_path().parent_path() / "lib" / "lampyr" / name);
  }
  for (const auto& place : places) {
    std::ifstream stream(place, std::ios::binary);
    if (!stream) continue;
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  return "";
}

void Replace(std::string& page, const std::string& placeholder, const std::string& text) {
  const size_t at = page.find(placeholder);
  if (at == std::string::npos) throw Error("the report page has no place for " + placeholder);
  page.replace(at, placeholder.size(), text);
}

std::string Budget(bool byTime, double budget) {
  return byTime ? FormatDuration(budget) : Format("%.0f spp", budget);
}

// The limit below which errors are not resolved: noise of the reference, or noise and blur.
const char* LimitOf(const ComparisonReference& reference) {
  return reference.IsBlurred() ? "noise and blur" : "noise";
}

// "1.23e-03 (1.1e-03 to 1.4e-03)".
std::string WithInterval(const std::optional<Estimate>& estimate, const ComparisonReference& reference) {
  // Short, for the column; a line below the table explains it.
  if (!estimate) return reference.IsBlurred() ? "within the reference's error" : "within the reference's noise";
  return Format("%.3g (%.2g to %.2g)", estimate->value, estimate->low, estimate->high);
}

const char* OriginText(ComparisonReference::Origin origin) {
  switch (origin) {
    case ComparisonReference::Origin::Given:
      return "given";
    case ComparisonReference::Origin::Cached:
      return "kept from before";
    case ComparisonReference::Origin::Made:
      break;
  }
  return "made";
}

// Prints the blur of the reference by merged photons.
void PrintBlur(const ComparisonReference& reference, std::string& text) {
  if (!reference.bias || reference.radius.value_or(0) == 0) return;
  text += Format("  photons are merged within %.2g of the first radius; the bias of this is an error of %s%s\n",
                 *reference.radius, reference.biasIsLimit ? "at most " : "", FormatPercent(*reference.bias).c_str());
}

void PrintReference(const ComparisonResults& results, std::string& text) {
  const ComparisonReference& reference = results.reference;
  text += "reference: " + reference.file + ", " + OriginText(reference.origin);
  if (!reference.integrator.empty()) text += ", " + reference.integrator;
  if (reference.samplesPerPixel > 0) text += Format(", %d spp", reference.samplesPerPixel);
  if (reference.seconds > 0) text += ", " + FormatDuration(reference.seconds);
  if (reference.relativeError) {
    text += Format("; its noise is a relMSE of %s%.2g, an error of %s, %s subtracted\n",
                   reference.noiseIsLimit ? "at most " : "", *reference.relMse,
                   FormatPercent(std::sqrt(*reference.relMse)).c_str(), reference.noiseIsLimit ? "and not" : "and is");
  } else {
    text += "; its error is not known, and taken as none\n";
  }
  PrintBlur(reference, text);
  for (const Pilot& pilot : results.pilots) {
    text += Format("  first look: %-6s relMSE %.3g in %.2g s", pilot.integrator.c_str(), pilot.relMse, pilot.seconds);
    if (pilot.bias > 0) text += ", bias " + FormatPercent(pilot.bias);
    text += std::string(pilot.chosen ? ", chosen" : "") + (pilot.note.empty() ? "" : ", " + pilot.note) + "\n";
  }
}

void PrintSnapshots(const ComparisonResults& results, std::string& text) {
  text += Format("\n%-6s %9s %8s  %-30s %-30s %s\n", "", results.ofProcessor ? "CPU time" : "time", "spp", "MSE (95 %)",
                 "relMSE (95 %)", "FLIP");
  bool anyOpen = false;
  for (const ComparedIntegrator& integrator : results.integrators) {
    for (const ComparedSnapshot& snapshot : integrator.snapshots) {
      text += Format("%-6s %9s %8.0f  %-30s %-30s %.3f\n", integrator.name.c_str(),
                     FormatDuration(snapshot.seconds).c_str(), snapshot.samplesPerPixel,
                     WithInterval(snapshot.mse, results.reference).c_str(),
                     WithInterval(snapshot.relMse, results.reference).c_str(), snapshot.flip.value);
      anyOpen |= !snapshot.mse || !snapshot.relMse;
    }
  }
  if (anyOpen && results.reference.IsBlurred()) {
    text += "  within the reference's error: not told apart from its own noise and blur\n";
  }
}

// "1.2 % (1.1 % to 1.4 %)", or the upper bound alone if the value is not significant.
std::string PercentWithInterval(const Estimate& estimate, bool isTold) {
  const auto percent = [](double value) { return Format("%.2g %%", 100 * value); };
  if (!isTold)
    return std::isfinite(estimate.high) ? "not told from 0 (up to " + percent(estimate.high) + ")" : "not known";
  std::string text = percent(estimate.value);
  if (std::isfinite(estimate.high)) text += " (" + percent(estimate.low) + " to " + percent(estimate.high) + ")";
  return text;
}

// The relative error in its parts.
void PrintParts(const ComparisonResults& results, std::string& text) {
  std::string blurs;
  for (const ComparedIntegrator& integrator : results.integrators) {
    if (integrator.blurs) blurs += (blurs.empty() ? "" : ", ") + integrator.name;
  }
  const std::string heading = "bias" + (blurs.empty() ? "" : " (with blur: " + blurs + ")");
  text += Format("\n%-6s %9s  %-32s %s\n", "", "time", "noise (95 %)", heading.c_str());
  for (const ComparedIntegrator& integrator : results.integrators) {
    for (const ComparedSnapshot& snapshot : integrator.snapshots) {
      const std::string noise = snapshot.noise ? PercentWithInterval(*snapshot.noise, true) : "0 %";
      text += Format("%-6s %9s  %-32s %s\n", integrator.name.c_str(), FormatDuration(snapshot.seconds).c_str(),
                     noise.c_str(), PercentWithInterval(snapshot.bias, snapshot.bias.significant).c_str());
    }
  }
}

// The errors that renders by merged photons state of themselves: of luminance, at 95 % confidence.
void PrintStatements(const ComparisonResults& results, std::string& text) {
  bool isFirst = true;
  for (const ComparedIntegrator& integrator : results.integrators) {
    for (const ComparedSnapshot& snapshot : integrator.snapshots) {
      if (!snapshot.stated) continue;
      if (isFirst) text += Format("\n%-6s %9s  %-32s %s\n", "", "time", "error that it states (95 %)", "of which bias");
      isFirst = false;
      text += Format("%-6s %9s  %-32s %s\n", integrator.name.c_str(), FormatDuration(snapshot.seconds).c_str(),
                     FormatPercent(snapshot.stated->Both()).c_str(), FormatPercent(snapshot.stated->bias).c_str());
    }
  }
}

void PrintTimes(const ComparisonResults& results, std::string& text) {
  text += "\ntime to an error (root of relMSE) of";
  bool extrapolated = false, blurs = false, unresolved = false;
  for (const TimeToError& time : results.integrators.front().timeToError) text += Format("%12.0f %%", 100 * time.error);
  text += "\n";
  for (const ComparedIntegrator& integrator : results.integrators) {
    text += Format("  %-34s", integrator.name.c_str());
    for (const TimeToError& time : integrator.timeToError) {
      if (time.kind == TimeToError::Kind::Never || time.kind == TimeToError::Kind::Unresolved) {
        text += Format("%14s", time.kind == TimeToError::Kind::Never ? "never" : "unresolved");
        unresolved |= time.kind == TimeToError::Kind::Unresolved;
        continue;
      }
      const bool guessed = time.kind == TimeToError::Kind::Extrapolated;
      extrapolated |= guessed;
      blurs |= guessed && integrator.blurs;
      text += Format("%14s", ((guessed ? "~" : "") + FormatDuration(time.seconds.value)).c_str());
    }
    text += "\n";
  }
  if (extrapolated) {
    text += std::string("  ~ beyond what was measured: relMSE taken to fall as 1/time") +
            (blurs ? "; blur falls more slowly\n" : "\n");
  }
  if (unresolved) text += Format("  unresolved: within the reference's own %s\n", LimitOf(results.reference));
}

void PrintVerdicts(const ComparisonResults& results, std::string& text) {
  text += "\n";
  for (const ComparedIntegrator& integrator : results.integrators) {
    const double bias = integrator.meanBias.value;
    if (integrator.meanBias.significant) {
      text += Format("%s is %s than the reference: its mean is off by %+.2g %% (%+.2g to %+.2g %%)\n",
                     integrator.name.c_str(), bias < 0 ? "darker" : "brighter", 100 * bias,
                     100 * integrator.meanBias.low, 100 * integrator.meanBias.high);
    }
    if (integrator.systematic.significant && integrator.systematic.value > 0) {
      const double error = 100 * std::sqrt(integrator.systematic.value);
      const char* sentence = integrator.blurs
                                 ? "%s blurs by %.2g %% so far, which falls slowly with more samples\n"
                                 : "%s differs from the reference by %.2g %% that more samples do not remove\n";
      text += Format(sentence, integrator.name.c_str(), error);
    }
  }
  for (const EfficiencyRatio& ratio : results.ratios) {
    text += Format("at %s, %s has %.3g × (%.2g to %.2g) the efficiency of %s in %s%s\n",
                   Budget(ratio.byTime, ratio.budget).c_str(), ratio.integrator.c_str(), ratio.ratio.value,
                   ratio.ratio.low, ratio.ratio.high, ratio.against.c_str(), ratio.relative ? "relMSE" : "MSE",
                   ratio.ratio.low < 1 && ratio.ratio.high > 1 ? ": no difference is shown" : "");
  }
}

}  // namespace

std::string ToCsv(const ComparisonResults& results) {
  std::string text =
      "scene,integrator,budget_kind,budget,repeats,seconds,samples_per_pixel,samples_per_second,mse,mse_low,mse_high,"
      "relmse,relmse_low,relmse_high,flip,flip_low,flip_high,efficiency,efficiency_low,efficiency_high,"
      "rel_efficiency,rel_efficiency_low,rel_efficiency_high\n";
  for (const ComparedIntegrator& integrator : results.integrators) {
    for (const ComparedSnapshot& s : integrator.snapshots) {
      text += Quoted(results.scene) + "," + integrator.name + "," + (s.byTime ? "time" : "samples") + "," +
              Field(s.budget) + "," + std::to_string(results.repeats) + "," + Field(s.seconds) + "," +
              Field(s.samplesPerPixel) + "," + Field(s.samplesPerSecond) + "," + Fields(s.mse) + "," +
              Fields(s.relMse) + "," + Fields(s.flip) + "," + Fields(s.efficiency) + "," + Fields(s.relEfficiency) +
              "\n";
    }
  }
  return text;
}

std::string ToPage(const ComparisonResults& results) {
  std::string page = ReadTemplate();
  if (page.empty()) return page;
  std::string pictures = "{";
  for (const auto& [key, png] : results.pictures) {
    pictures += (pictures.size() > 1 ? ",\n\"" : "\"") + key + "\":\"data:image/png;base64," + Base64(png) + "\"";
  }
  Replace(page, "/*LAMPYR-PICTURES*/", pictures + "}");
  Replace(page, "/*LAMPYR-RESULTS*/", Escaped(ToJson(results)));
  return page;
}

std::string ToText(const ComparisonResults& results) {
  std::string text;
  PrintReference(results, text);
  PrintSnapshots(results, text);
  PrintParts(results, text);
  PrintStatements(results, text);
  PrintTimes(results, text);
  PrintVerdicts(results, text);
  return text;
}

}  // namespace lampyr
