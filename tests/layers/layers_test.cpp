// The arrows of the house run down: a file includes only rooms that its own room may know, no include runs in a circle,
// and each heavy third-party library is included where it belongs and nowhere else. No function is long.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = LAMPYR_SOURCE_DIR;

struct SourceFile {
  std::string path;  // as it is included: "math/vec.h", "lights/light.h"
  std::vector<std::string> quoted, angled;
};

std::vector<SourceFile> SourceFiles() {
  std::vector<SourceFile> files;
  const std::regex include("^\\s*#\\s*include\\s*([\"<])([^\">]+)[\">]");
  for (const char* top : {"src", "lights", "suite", "integrators", "render", "app"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      SourceFile file;
      file.path = fs::relative(entry.path(), top == std::string("src") ? kRoot / "src" : kRoot).string();
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, include)) continue;
        (match[1] == "\"" ? file.quoted : file.angled).push_back(match[2]);
      }
      files.push_back(file);
    }
  }
  return files;
}

std::string RoomOf(const std::string& path) {
  return path.substr(0, path.find('/'));
}

// The rooms in the order of the house: each may include itself and those of the set.
const std::set<std::string> kCore = {"base",     "math",  "spectral", "sampling", "scene",
                                     "geometry", "media", "film",     "textures", "materials"};
std::set<std::string> With(std::set<std::string> rooms, const std::set<std::string>& more) {
  rooms.insert(more.begin(), more.end());
  return rooms;
}
const std::map<std::string, std::set<std::string>> kMayKnow = {
    {"base", {}},
    {"math", {"base"}},
    {"spectral", {"base", "math"}},
    {"sampling", {"base", "math"}},
    {"scene", {"base", "math", "spectral"}},
    {"geometry", {"base", "math"}},
    {"media", {"base", "math", "spectral", "sampling", "scene", "geometry"}},
    {"film", {"base", "math", "spectral"}},
    {"denoise", {"base", "math", "film"}},
    {"textures", {"base", "math", "spectral", "sampling", "scene", "geometry", "film"}},
    {"materials", {"base", "math", "spectral", "sampling", "scene", "geometry", "media", "film", "textures"}},
    {"camera", {"base", "math", "spectral", "sampling", "scene", "geometry"}},
    {"lights", kCore},
    {"suite", With(kCore, {"lights"})},
    {"integrators", With(kCore, {"camera", "lights"})},
    {"render", With(kCore, {"denoise", "camera", "lights", "integrators"})},
    {"app", With(kCore, {"denoise", "camera", "lights", "suite", "integrators", "render"})},
};

TEST(Layers, IncludesRunDown) {
  const auto files = SourceFiles();
  ASSERT_GT(files.size(), 40u);
  for (const SourceFile& file : files) {
    const std::string room = RoomOf(file.path);
    ASSERT_TRUE(kMayKnow.count(room)) << file.path << " is in a room that this test does not know";
    for (const std::string& included : file.quoted) {
      const std::string other = RoomOf(included);
      EXPECT_TRUE(other == room || kMayKnow.at(room).count(other)) << file.path << " includes \"" << included << "\"";
    }
  }
}

// Depth-first search; reports the first circle through each file.
void Visit(const std::string& path, const std::map<std::string, std::vector<std::string>>& graph,
           std::map<std::string, int>& state) {
  state[path] = 1;
  const auto found = graph.find(path);
  if (found != graph.end()) {
    for (const std::string& next : found->second) {
      EXPECT_NE(state[next], 1) << "circle of includes: " << path << " -> " << next;
      if (state[next] == 0) Visit(next, graph, state);
    }
  }
  state[path] = 2;
}

TEST(Layers, NoCircles) {
  std::map<std::string, std::vector<std::string>> graph;
  for (const SourceFile& file : SourceFiles()) {
    // A header may end by including its own inline part, which includes nothing back but for that header.
    for (const std::string& included : file.quoted) {
      if (file.path.find("_inline.h") == std::string::npos) graph[file.path].push_back(included);
    }
  }
  std::map<std::string, int> state;
  for (const auto& [path, ignored] : graph) {
    if (state[path] == 0) Visit(path, graph, state);
  }
}

// Within each folder, from the top one down, its subfolders and its own files, taken together as one, are in an order:
// if files of one include files of another, none of the other's leads back.
TEST(Layers, FoldersRunOneWay) {
  using Graph = std::map<std::string, std::vector<std::string>>;
  std::map<std::string, Graph> within;  // by folder: its children and those that they include
  for (const SourceFile& file : SourceFiles()) {
    for (const std::string& included : file.quoted) {
      const fs::path from(file.path), to(included);
      auto a = from.begin(), b = to.begin();
      std::string folder;
      for (; a != from.end() && b != to.end() && *a == *b; ++a, ++b) folder += a->string() + "/";
      // Two files of one folder, or a file that includes itself.
      const auto child = [](const fs::path& path, fs::path::iterator at) {
        return std::next(at) == path.end() ? std::string(".") : at->string();
      };
      if (a == from.end() || b == to.end()) continue;
      const std::string here = child(from, a), there = child(to, b);
      if (here != there) within[folder][here].push_back(there);
    }
  }
  ASSERT_GT(within.size(), 3u);
  for (const auto& [folder, graph] : within) {
    SCOPED_TRACE("in " + (folder.empty() ? "the tree" : folder) + " (\".\": its own files)");
    std::map<std::string, int> state;
    for (const auto& [child, ignored] : graph) {
      if (state[child] == 0) Visit(child, graph, state);
    }
  }
}

// A header that includes a heavy library is for the sources of its own room.
void ExpectPrivate(const std::string& header) {
  for (const SourceFile& file : SourceFiles()) {
    for (const std::string& included : file.quoted) {
      if (included != header) continue;
      EXPECT_TRUE(RoomOf(file.path) == RoomOf(header) && fs::path(file.path).extension() == ".cpp")
          << file.path << " includes \"" << header << "\" and all that comes with it";
    }
  }
}

TEST(Layers, HeavyLibrariesInOnePlace) {
  const std::map<std::string, std::set<std::string>> homes = {
      {"embree3/", {"geometry"}},  {"OpenImageIO/", {"film"}}, {"OpenEXR/", {"film"}}, {"Imf", {"film"}},
      {"flann/", {"integrators"}}, {"CLI/", {"app"}},          {"nlohmann/", {"app"}}, {"tbb/", {"base"}},
      {"png.h", {"film"}},         {"Eigen/", {"denoise"}},    {"httplib.h", {"app"}}};
  for (const auto& [library, rooms] : homes) {
    std::vector<std::string> users;
    for (const SourceFile& file : SourceFiles()) {
      for (const std::string& included : file.angled) {
        if (included.rfind(library, 0) != 0) continue;
        EXPECT_TRUE(rooms.count(RoomOf(file.path))) << file.path << " includes <" << included << ">";
        if (fs::path(file.path).extension() == ".h") ExpectPrivate(file.path);
        if (users.empty() || users.back() != file.path) users.push_back(file.path);
      }
    }
    // The scene and its callbacks by kind of shape; the reports of the commands, those of compare, and what the desk's
    // page asks; the command line and the header of its help.
    const std::map<std::string, size_t> several = {{"embree3/", 4}, {"nlohmann/", 3}, {"CLI/", 2}};
    const size_t allowed = several.contains(library) ? several.at(library) : 1;
    EXPECT_LE(users.size(), allowed) << "<" << library << "> is included by several files";
  }
}

// Lines from the opening brace to the closing one, by the heading that opens at line `at`.
size_t LengthOfBody(const std::vector<std::string>& lines, size_t at) {
  static const std::regex literals(R"("(\\.|[^"\\])*"|'(\\.|[^'\\])'|//.*)");
  int depth = 1;
  for (size_t i = at + 1; i < lines.size(); ++i) {
    for (const char c : std::regex_replace(lines[i], literals, "")) depth += c == '{' ? 1 : c == '}' ? -1 : 0;
    if (depth <= 0) return i - at;
  }
  return lines.size() - at;
}

TEST(Layers, FunctionsAreShort) {
  constexpr size_t most = 60;
  const std::regex heading(R"(\)\s*(const)?\s*(noexcept)?\s*(override)?\s*(->\s*[\w:<>]+)?\s*(:.*)?\{\s*$)"),
      control(R"(^\s*(if|for|while|switch|else|\}|return)\b)");
  size_t functions = 0;
  for (const SourceFile& file : SourceFiles()) {
    const fs::path inSrc = kRoot / "src" / file.path;
    std::ifstream stream(fs::exists(inSrc) ? inSrc : kRoot / file.path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    for (size_t i = 0; i < lines.size(); ++i) {
      if (!std::regex_search(lines[i], heading) || std::regex_search(lines[i], control)) continue;
      ++functions;
      EXPECT_LE(LengthOfBody(lines, i), most) << file.path << ":" << i + 1 << ": " << lines[i];
    }
  }
  EXPECT_GT(functions, 2000u);
}

TEST(Layers, NothingNamesAConcreteLightOutsideItsFile) {
  // Adding a light touches its own file and the registry: no other file may include a light's own header.
  const std::set<std::string> shared = {"lights/light.h",
                                        "lights/light_type.h",
                                        "lights/types/type_registry.h",
                                        "lights/plugin/plugin_loader.h",
                                        "lights/filters/filter_base.h",
                                        "lights/scene_light.h"};
  for (const SourceFile& file : SourceFiles()) {
    if (RoomOf(file.path) == "lights" || RoomOf(file.path) == "suite") continue;
    for (const std::string& included : file.quoted) {
      if (RoomOf(included) != "lights" || included.rfind("lights/services/", 0) == 0 ||
          included.rfind("lights/selection/", 0) == 0 || included.rfind("suite/", 0) == 0) {
        continue;
      }
      EXPECT_TRUE(shared.count(included)) << file.path << " includes \"" << included << "\"";
    }
  }
}

}  // namespace
