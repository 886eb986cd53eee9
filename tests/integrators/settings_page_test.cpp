// docs/settings.md, which is made of the declarations of the settings. LAMPYR_WRITE_TABLES=1 writes it anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "integrators/registry.h"

namespace lampyr {
namespace {

std::string Kind(const Setting& setting) {
  struct Names {
    std::string operator()(bool) const { return "switch"; }
    std::string operator()(int64_t) const { return "integer"; }
    std::string operator()(double) const { return "number"; }
    std::string operator()(const std::string&) const { return "word"; }
  };
  return std::visit(Names{}, setting.fallback);
}

std::string Values(const Setting& setting) {
  if (std::holds_alternative<bool>(setting.fallback)) return "on, off";
  if (std::holds_alternative<std::string>(setting.fallback)) {
    std::string all;
    for (const std::string& choice : setting.choices) all += (all.empty() ? "" : ", ") + choice;
    return all;
  }
  return setting.Range() + (setting.unit.empty() ? "" : ", " + setting.unit);
}

// A bar would end a cell of the table.
std::string Cell(std::string text) {
  for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string Page() {
  std::ostringstream page;
  page << "# Settings of the integrators\n\n"
          "Each setting is an option of `lampyr render` and `lampyr compare`, a parameter of the scene's `Integrator`\n"
          "statement, and a variant of a comparison:\n\n"
          "```\n"
          "lampyr render SCENE.pbrt --integrator vcm --radius 0.01 --no-merge\n"
          "Integrator \"vcm\" \"float radius\" 0.01 \"bool merge\" false\n"
          "lampyr compare SCENE.pbrt --integrators vcm,vcm:merge=off\n"
          "```\n\n"
          "A switch that is on by default is turned off by `--no-NAME`. The JSON of `--stats` has the values under\n"
          "`settings`. A checkpoint can only be resumed with the values that it was made with. Light sampler `bvh` is\n"
          "pbrt-v4's name of `tree`.\n\n"
          "| Setting | In scenes | Type | Default | Values | Integrators | What it sets |\n"
          "|---|---|---|---|---|---|---|\n";
  const Settings all = IntegratorSettings();
  for (const auto& [setting, value] : all.All()) {
    std::string integrators;
    for (const IntegratorType& type : IntegratorRegistry()) {
      for (const Setting* own : type.settings) {
        if (own->name == setting->name) integrators += (integrators.empty() ? "" : ", ") + type.name;
      }
    }
    const std::string fallback =
        setting->fallbackText.empty() ? setting->Format(setting->fallback) : setting->fallbackText;
    const std::string inScenes = setting->isInScenes ? "`" + setting->NameInScenes() + "`" : "";
    page << "| `--" << setting->name << "` | " << inScenes << " | " << Kind(*setting) << " | " << Cell(fallback)
         << " | " << Cell(Values(*setting)) << " | " << integrators << " | " << Cell(setting->help) << " |\n";
  }
  page << "\nThe integrators:\n\n| Integrator | What it finds light by |\n|---|---|\n";
  for (const IntegratorType& type : IntegratorRegistry())
    page << "| `" << type.name << "` | " << Cell(type.help) << " |\n";
  return page.str();
}

TEST(Settings, ThePageIsWhatIsDeclared) {
  const std::string file = LAMPYR_SOURCE_DIR "/docs/settings.md";
  const std::string page = Page();
  if (std::getenv("LAMPYR_WRITE_TABLES")) std::ofstream(file) << page;
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  EXPECT_EQ(text.str(), page) << "LAMPYR_WRITE_TABLES=1 test_integrators --gtest_filter='Settings.*' writes it anew";
}

}  // namespace
}  // namespace lampyr
