// Light path expressions against regular expressions of the standard library, for all short paths and wherever their
// subpaths meet; and the mistakes in them.
#include <gtest/gtest.h>

#include <regex>

#include "base/error.h"
#include "film/output_plan.h"

namespace lampyr {
namespace {

constexpr const char* kEventLetters = "abcdefv";  // RD, RG, RS, TD, TG, TS, V
constexpr const char* kSourceLetters = "klo";     // a light with a name and a group, another one, a medium

struct Case {
  const char* expression;
  const char* regex;
};
const std::vector<Case> kCases = {
    {"C.*[LO]", "[abcdefv]*[klo]"},
    {"C.*", "[abcdefv]*[klo]"},
    {"CL", "[kl]"},
    {"C<RD>[LO]", "a[klo]"},
    {"CD[GS]+.*[LO]", "[ad][bcef]+[abcdefv]*[klo]"},
    {"C<RD>[<L.'key'>O]", "a[ko]"},
    {"C <RD> [<L.\\'key\\'> O]", "a[ko]"},
    {"C([^S]S){2,3}L", "([abdev][cf]){2,3}[kl]"},
    {"C<T[^D]>*(V|<.G>)?<L.\"warm\">", "[ef]*(v|[be])?k"},
    {"CR{0,2}T{1,}O", "[abc]{0,2}[def]{1,}o"},
    {"CS?{1}L", nullptr},
    {"C.{2}L|CS*<L'key'>", "[abcdefv]{2}[kl]|[cf]*k"},
    {"CD[^<L.'key'>]", "[ad][lo]"},
    {"C<..>V*[LO]", "[abcdef]v*[klo]"},
    {"C((DS)*|V)+L", "(([ad][cf])*|v)+[kl]"},
    {"C<[RT]S><V.>?L", "[cf]v?[kl]"},
    {"C(R{2,70}T|V)*D{0,70}[LO]", "([abc]{2,}[def]|v)*[ad]*[klo]"},
    {"C(.D|D.){2}L", "([abcdefv][ad]|[ad][abcdefv]){2}[kl]"},
};

const std::vector<LightSourceName> kLights = {{"key", "warm"}, {"", ""}};

OutputPlan PlanOf(const std::vector<Case>& cases) {
  std::vector<OutputLayer> layers;
  for (const Case& tried : cases)
    layers.push_back({tried.expression, PathExpression(tried.expression), tried.expression});
  return {std::move(layers), kLights};
}

std::vector<std::string> AllPaths(size_t most) {
  std::vector<std::string> events = {""}, paths;
  for (size_t begin = 0, length = 0; length <= most; ++length) {
    const size_t end = events.size();
    for (size_t i = begin; i < end; ++i) {
      for (const char* source = kSourceLetters; *source; ++source) paths.push_back(events[i] + *source);
      for (const char* event = kEventLetters; *event && length < most; ++event) events.push_back(events[i] + *event);
    }
    begin = end;
  }
  return paths;
}

PathEvent EventOf(char letter) {
  return static_cast<PathEvent>(std::string(kEventLetters).find(letter));
}

// The layers of a path whose subpaths meet after `fromCamera` events.
std::vector<uint32_t> LayersOf(const OutputPlan& plan, const std::string& path, size_t fromCamera) {
  uint32_t camera = OutputPlan::kCamera;
  for (size_t i = 0; i < fromCamera; ++i) camera = plan.AfterFromCamera(camera, EventOf(path[i]));
  const char source = path.back();
  uint32_t light = source == 'o' ? plan.OfMedia() : plan.OfLight(source == 'k' ? 0 : 1);
  for (size_t i = path.size() - 1; i-- > fromCamera;) light = plan.AfterFromLight(light, EventOf(path[i]));
  const auto layers = plan.LayersOf(camera, light);
  return {layers.begin(), layers.end()};
}

TEST(PathExpressions, AreRegularExpressionsWhereverSubpathsMeet) {
  std::vector<Case> cases;
  std::vector<std::regex> regexes;
  for (const Case& tried : kCases) {
    if (!tried.regex) continue;
    cases.push_back(tried);
    regexes.emplace_back(tried.regex);
  }
  const OutputPlan plan = PlanOf(cases);
  std::vector<size_t> matched(cases.size());
  for (const std::string& path : AllPaths(4)) {
    std::vector<uint32_t> expected;
    for (uint32_t layer = 0; layer < cases.size(); ++layer) {
      if (!std::regex_match(path, regexes[layer])) continue;
      expected.push_back(layer);
      ++matched[layer];
    }
    for (size_t meet = 0; meet < path.size(); ++meet) ASSERT_EQ(LayersOf(plan, path, meet), expected) << path << meet;
  }
  for (size_t layer = 0; layer < cases.size(); ++layer) EXPECT_GT(matched[layer], 0u) << cases[layer].expression;
}

TEST(PathExpressions, ThatHaveNamesPartThePicture) {
  std::vector<Case> cases;
  for (const char* name : {"emission", "direct diffuse", "Indirect-Diffuse", "direct_specular", "indirect specular",
                           "transmission", "volume"}) {
    ASSERT_NE(FindNamedExpression(name), nullptr) << name;
    cases.push_back({FindNamedExpression(name)->text, nullptr});
  }
  const OutputPlan plan = PlanOf(cases);
  for (const std::string& path : AllPaths(4)) EXPECT_EQ(LayersOf(plan, path, 0).size(), 1u) << path;
  EXPECT_EQ(FindNamedExpression("caustics"), nullptr);
}

TEST(PathExpressions, OfOneLightAlone) {
  const PathExpression caustic(FindNamedExpression("caustic")->text);
  const OutputPlan plan({{"all", caustic, ""}, {"of key", caustic.OnlyFrom("key"), ""}}, kLights);
  EXPECT_EQ(LayersOf(plan, "ack", 1), (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(LayersOf(plan, "acl", 1), (std::vector<uint32_t>{0}));
  EXPECT_EQ(LayersOf(plan, "aco", 2), (std::vector<uint32_t>{0}));
  EXPECT_EQ(caustic.OnlyFrom("key").NamedLights(), (std::vector<std::string>{"key"}));
}

// Many light groups cost a state each, not a product of them.
TEST(PathExpressions, OfThousandsOfLightGroups) {
  std::vector<OutputLayer> layers;
  std::vector<LightSourceName> lights;
  for (int i = 0; i < 5000; ++i) {
    const std::string group = "g" + std::to_string(i);
    layers.push_back({group, PathExpression(LightSources{{{LightSources::Kind::InGroup, group}}, false}), ""});
    lights.push_back({"", group, false});
  }
  const OutputPlan plan(std::move(layers), lights);
  for (const uint32_t light : {0u, 17u, 4999u}) {
    const uint32_t camera = plan.AfterFromCamera(OutputPlan::kCamera, PathEvent::Volume);
    const uint32_t state = plan.AfterFromLight(plan.OfLight(light), PathEvent::DiffuseReflection);
    const auto of = plan.LayersOf(camera, state);
    ASSERT_EQ(of.size(), 1u);
    EXPECT_EQ(of[0], light);
  }
}

// Some thousand positions, each of which some thousand others may follow, are compiled at once.
TEST(PathExpressions, OfManyPositions) {
  const OutputPlan plan = PlanOf({{"C(.{1,60}){1,60}L", nullptr}, {"C.{1,200}L", nullptr}});
  EXPECT_EQ(LayersOf(plan, std::string(200, 'a') + "k", 77), (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(LayersOf(plan, std::string(201, 'a') + "k", 77), (std::vector<uint32_t>{0}));
  EXPECT_EQ(LayersOf(plan, std::string(3600, 'a') + "k", 1000), (std::vector<uint32_t>{0}));
  EXPECT_TRUE(LayersOf(plan, std::string(3601, 'a') + "k", 1000).empty());
}

TEST(PathExpressions, TellWhereTheyAreWrong) {
  const std::pair<const char*, const char*> wrong[] = {
      {"", "character 1 of \"\": an expression starts with the camera, C"},
      {"DL", "character 1 of \"DL\": an expression starts with the camera, C"},
      {"C", "character 2 of \"C\": the path has no light: it ends with L, O, or [LO]"},
      {"CD", "character 3 of \"CD\": the path has no light"},
      {"CLD", "character 4 of \"CLD\": the path has no light"},
      {"CXL", "character 2 of \"CXL\": \"X\" is no event: R, T, D, G, S, V, L, O, or . for any"},
      {"CCL", "character 2 of \"CCL\": C is the camera, which stands first alone"},
      {"C<RX>L", "character 4 of \"C<RX>L\": here is one of these wanted: D, G, S, or . for any"},
      {"C<XD>L", "character 3 of \"C<XD>L\": here is one of these wanted: R, T, V, L, O, or . for R and T"},
      {"C<RD", "character 2 of \"C<RD\": this < is not closed by >"},
      {"C<RDL>", "character 5 of \"C<RDL>\": here is > wanted"},
      {"C[DL", "character 2 of \"C[DL\": a bracket that is opened is not closed"},
      {"C(DL", "character 5 of \"C(DL\": a parenthesis that is opened is not closed"},
      {"CD)L", "character 3 of \"CD)L\": this parenthesis closes none"},
      {"C*L", "character 2 of \"C*L\": \"*\" is no event"},
      {"CD**L", "character 4 of \"CD**L\": a second quantifier"},
      {"CS?{1}L", "character 4 of \"CS?{1}L\": a second quantifier"},
      {"CD{3,2}L", "character 3 of \"CD{3,2}L\": the largest count is less than the least one"},
      {"CD{x}L", "character 4 of \"CD{x}L\": here is a number wanted, how often it repeats"},
      {"CD{999}L", "character 6 of \"CD{999}L\": at most 255 repetitions"},
      {"C<L.'key>", "character 5 of \"C<L.'key>\": the name that starts here has no quote at its end"},
      {"C<L.''>", "character 7 of \"C<L.''>\": the name is empty"},
      {"C<RD'key'>L", "character 5 of \"C<RD'key'>L\": only lights have names: <L.'name'>"},
      {"C<O.'key'>", "character 5 of \"C<O.'key'>\": glowing media have no names: O"},
      {"C((D{99}){99}){99}L", "the expression is too long with its repetitions"},
      {"C(((()){255}){255}){255}L", "the expression is too long with its repetitions"},
  };
  for (const auto& [text, message] : wrong) {
    try {
      PathExpression(std::string(text));
      ADD_FAILURE() << text << " is taken";
    } catch (const Error& error) {
      EXPECT_NE(error.Text().find(message), std::string::npos) << error.Text();
    }
  }
  const std::string deep = "C" + std::string(100000, '(') + "." + std::string(100000, ')') + "L";
  try {
    PathExpression{deep};
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.Text().find("character 102 of \"…(((("), std::string::npos) << error.Text();
    EXPECT_LT(error.Text().size(), 250u);
  }
  PathExpression("C" + std::string(100, '(') + "." + std::string(100, ')') + "L");
  std::vector<OutputLayer> large = {{"large", PathExpression("C.*D.{14}L"), ""}};
  EXPECT_THROW(OutputPlan(std::move(large), kLights), Error);
}

}  // namespace
}  // namespace lampyr
