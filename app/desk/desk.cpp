// The requests of the desk's page, and their answers as JSON.
#include "app/desk/desk.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/desk/keep_scene.h"
#include "app/desk/page.h"
#include "base/stop.h"
#include "render/analysis/guide_view.h"
#include "scene/referenced_files.h"

namespace lampyr {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kWrong = 422, kNotFound = 404;

HttpReply ReplyWith(const Json& json) {
  return {200, "application/json", json.dump(-1, ' ', false, Json::error_handler_t::replace), ""};
}

// Numbers that are not finite are null.
Json Finite(double number) {
  return std::isfinite(number) ? Json(number) : Json(nullptr);
}

const char* NameOf(ParameterControl control) {
  switch (control) {
    case ParameterControl::Number:
      return "number";
    case ParameterControl::Integer:
      return "integer";
    case ParameterControl::Switch:
      return "switch";
    case ParameterControl::Color:
      return "color";
    case ParameterControl::Text:
      return "text";
    case ParameterControl::None:
      break;
  }
  return "none";
}

Json ShownJson(const ShownParameter& shown) {
  return {{"name", shown.info->name},
          {"unit", shown.info->unit},
          {"range", shown.info->range},
          {"help", shown.info->help},
          {"default", shown.info->defaultValue},
          {"control", NameOf(shown.control)},
          {"numbers", shown.numbers},
          {"text", shown.text},
          {"isCommon", shown.info->isCommon},
          {"isGiven", shown.isGiven},
          {"isEdited", shown.isEdited}};
}

Json StatementJson(const EditableScene& scene, size_t statement) {
  const EditableStatement& of = scene.Statements()[statement];
  Json parameters = Json::array();
  for (const ShownParameter& shown : ShownParameters(scene, statement)) parameters.push_back(ShownJson(shown));
  const char* kinds[] = {"light", "area light", "filter"};
  return {{"statement", statement},
          {"label", LabelOf(scene, statement)},
          {"type", of.type->name},
          {"help", of.type->help},
          {"place", PlaceOf(scene, statement)},
          {"kind", kinds[static_cast<size_t>(of.kind)]},
          {"lights", of.lights.size()},
          {"parameters", parameters}};
}

// A non-negative integer; the conversion would truncate other numbers.
uint64_t WholeNumberIn(const Json& body, const char* name) {
  const Json& number = body.at(name);
  if (!number.is_number_unsigned()) throw Error(std::string("\"") + name + "\" is no whole number");
  return number.get<uint64_t>();
}

size_t StatementIn(const Json& body, const EditableScene& scene) {
  const auto statement = static_cast<size_t>(WholeNumberIn(body, "statement"));
  if (statement >= scene.Statements().size()) throw Error("there is no such light");
  return statement;
}

// One factor for each fader.
std::vector<Color> FactorsIn(const Json& body, size_t count) {
  std::vector<Color> factors;
  constexpr float largest = 1e6f;
  for (const Json& factor : body.at("factors")) {
    const auto channel = [&](size_t c) { return factor.at(c).get<float>(); };
    const Color color(channel(0), channel(1), channel(2));
    if (!color.IsValid() || color.Max() > largest) throw Error("a factor is out of range");
    factors.push_back(color);
  }
  if (factors.size() != count) throw Error("a factor of each fader is wanted");
  return factors;
}

// The factors of faders by the layers of a picture.
std::vector<Color> ByLayer(const LayerPlanes& planes, const std::vector<Fader>& faders,
                           const std::vector<Color>& factors) {
  if (planes.names.empty()) return {factors.empty() ? Color(1.0f) : factors.front()};
  std::vector<Color> byLayer(planes.names.size(), Color(1.0f));
  for (size_t i = 0; i < faders.size(); ++i) {
    const auto layer = std::find(planes.names.begin(), planes.names.end(), faders[i].layer);
    if (layer != planes.names.end()) byLayer[static_cast<size_t>(layer - planes.names.begin())] = factors[i];
  }
  return byLayer;
}

// The scene's text and the files that it refers to.
std::vector<std::string> FilesOf(const SceneDescription& scene) {
  std::vector<std::string> files = scene.files;
  const std::vector<std::string> referenced = ReferencedFiles(scene);
  files.insert(files.end(), referenced.begin(), referenced.end());
  return files;
}

}  // namespace

Desk::Desk(EditableScene& scene, int mostSamples, int threads)
    : scene_(scene),
      files_(FilesOf(scene.Description())),
      hashOfFiles_(HashOfFiles(files_)),
      faders_(FadersOf(scene)),
      session_(scene.Built(), mostSamples, threads) {}

class Desk::Requests {
 public:
  Requests(Desk& desk, const HttpRequest& request) : desk_(desk), request_(request) {}

  HttpReply Answer() {
    if (request_.method == "GET") return AnswerGet();
    body_ = Json::parse(request_.body);
    const std::pair<const char*, HttpReply (Requests::*)() const> posts[] = {
        {"picture", &Requests::Picture}, {"pixel", &Requests::Pixel}, {"guide", &Requests::Guide},
        {"edit", &Requests::Edit},       {"reset", &Requests::Reset}, {"set", &Requests::Set},
        {"pause", &Requests::Pause},     {"keep", &Requests::Keep}};
    for (const auto& [path, answer] : posts) {
      if (request_.path == path) return (this->*answer)();
    }
    return {kNotFound, "text/plain", "", ""};
  }

 private:
  HttpReply AnswerGet() const {
    for (const PageFile& file : PageFiles()) {
      if (request_.path == file.path) return {200, file.type, std::string(file.text), ""};
    }
    if (request_.path == "state") return State();
    if (request_.path == "lights") return Lights();
    return {kNotFound, "text/plain", "", ""};
  }

  HttpReply State() const {
    const DeskState state = desk_.session_.State();
    return ReplyWith({{"restart", state.restart},
                      {"picture", state.picture},
                      {"samplesPerPixel", state.samplesPerPixel},
                      {"seconds", state.seconds},
                      {"error", Finite(state.relativeError)},
                      {"isPaused", state.isPaused},
                      {"isDone", state.isDone},
                      {"failure", state.failure}});
  }

  HttpReply Lights() const {
    const std::lock_guard lock(desk_.editing_);
    const EditableScene& scene = desk_.scene_;
    const RenderSettings& settings = scene.Built()->settings;
    Json faders = Json::array(), statements = Json::array();
    for (const Fader& fader : desk_.faders_)
      faders.push_back({{"label", fader.label}, {"statements", fader.statements}, {"hasGlow", fader.hasGlow}});
    for (size_t i = 0; i < scene.Statements().size(); ++i) statements.push_back(StatementJson(scene, i));
    return ReplyWith({{"scene", scene.Description().file.filename().string()},
                      {"width", settings.crop.Width()},
                      {"height", settings.crop.Height()},
                      {"integrator", settings.integrator},
                      {"faders", faders},
                      {"statements", statements}});
  }

  std::vector<Color> Factors() const { return FactorsIn(body_, desk_.faders_.size()); }
  // The factors for a picture, which may be of a render before faders were set into the lights.
  std::vector<Color> FactorsFor(const DeskPicture& picture) const {
    std::vector<Color> factors = Factors();
    const std::lock_guard lock(desk_.setting_);
    for (const SetFactors& set : desk_.set_) {
      if (set.restart <= picture.restart) continue;
      for (size_t i = 0; i < factors.size(); ++i) factors[i] = factors[i] * set.factors[i];
    }
    return factors;
  }

  HttpReply Picture() const {
    if (body_.contains("after")) {
      constexpr double kLongestWait = 2;  // seconds
      desk_.session_.WaitForPicture(WholeNumberIn(body_, "after"), kLongestWait);
    }
    const std::shared_ptr<const DeskPicture> picture = desk_.session_.Picture();
    constexpr int kNoContent = 204;
    if (!picture) return {kNoContent, "application/octet-stream", "", ""};
    const std::vector<Color> factors = FactorsFor(*picture);
    ScreenLook look;
    constexpr float mostStops = 30;
    look.exposure = std::clamp(body_.at("exposure").get<float>(), -mostStops, mostStops);
    look.toneMap = body_.at("clip").get<bool>() ? ToneMap::Clip : ToneMap::Filmic;
    const LayerPlanes& planes = picture->planes;
    const std::string shape = std::to_string(planes.width) + " " + std::to_string(planes.height) + " " +
                              std::to_string(picture->number) + " " + std::to_string(picture->restart);
    return {200, "application/octet-stream",
            desk_.mixer_.Mix(planes, picture->number, ByLayer(planes, desk_.faders_, factors), look,
                             desk_.session_.Threads()),
            shape};
  }

  std::shared_ptr<const DeskPicture> SomePicture() const {
    std::shared_ptr<const DeskPicture> picture = desk_.session_.Picture();
    if (!picture) throw Error("there is no picture yet");
    return picture;
  }
  // The column and the row of the pixel that is asked for.
  std::pair<int, int> PlaceIn(const LayerPlanes& planes) const {
    const uint64_t x = WholeNumberIn(body_, "x"), y = WholeNumberIn(body_, "y");
    if (x >= static_cast<uint64_t>(planes.width) || y >= static_cast<uint64_t>(planes.height))
      throw Error("that is beyond the picture");
    return {static_cast<int>(x), static_cast<int>(y)};
  }

  HttpReply Guide() const {
    const std::shared_ptr<const DeskPicture> picture = SomePicture();
    const auto [x, y] = PlaceIn(picture->planes);
    const RenderSettings& settings = picture->scene->settings;
    GuideView view;
    try {
      if (picture->guide)
        view = ViewGuide(picture->scene->scene, picture->guide, settings.width, settings.height, settings.crop.x0 + x,
                         settings.crop.y0 + y);
    } catch (const Stopped&) {
      throw Error("the scene has just been edited");
    }
    return ReplyWith({{"isLearned", picture->learnsPaths},
                      {"isUsed", picture->guide != nullptr},
                      {"gain", Finite(picture->guideGain)},
                      {"regions", picture->guide ? picture->guide->Regions() : 0},
                      {"isGuided", view.isGuided},
                      {"share", view.share},
                      {"columns", GuideView::kColumns},
                      {"rows", GuideView::kRows},
                      {"densities", view.densities}});
  }

  HttpReply Pixel() const {
    const std::shared_ptr<const DeskPicture> picture = SomePicture();
    const std::vector<Color> factors = FactorsFor(*picture);
    const LayerPlanes& planes = picture->planes;
    const auto [x, y] = PlaceIn(planes);
    const MixedPixel pixel = MixPixel(planes, ByLayer(planes, desk_.faders_, factors), x, y);
    Json interval = nullptr;
    const bool isKnown = pixel.hasDeviation && picture->samplesPerPixel > 1;
    constexpr double kSpread = 1.96;
    const auto values = [](const Color& color, double scale) {
      return Json{scale * static_cast<double>(color.r), scale * static_cast<double>(color.g),
                  scale * static_cast<double>(color.b)};
    };
    if (isKnown) interval = values(pixel.deviation, kSpread);
    return ReplyWith({{"value", values(pixel.value, 1)}, {"interval", interval}});
  }

  // Renders the edited scene. `edited`: a statement whose current values are part of the reply; null: none.
  HttpReply Restarted(const Json& edited = nullptr, const std::vector<std::string>& notes = {}) const {
    const double seconds = desk_.session_.Restart(desk_.scene_.Built());
    return ReplyWith(
        {{"seconds", seconds}, {"restart", desk_.session_.State().restart}, {"statement", edited}, {"notes", notes}});
  }

  HttpReply Edit() const {
    const std::lock_guard lock(desk_.editing_);
    const size_t statement = StatementIn(body_, desk_.scene_);
    std::vector<double> numbers;
    for (const Json& number : body_.value("numbers", Json::array())) {
      if (!number.is_number()) throw Error("a number is wanted");
      numbers.push_back(number.get<double>());
    }
    const std::string text = body_.value("text", std::string());
    const Parameter parameter =
        EditedParameter(desk_.scene_, statement, body_.at("parameter").get<std::string>(), numbers, text);
    desk_.scene_.Edit({{statement, {parameter}}});
    return Restarted(StatementJson(desk_.scene_, statement));
  }

  HttpReply Reset() const {
    const std::lock_guard lock(desk_.editing_);
    const size_t statement = StatementIn(body_, desk_.scene_);
    desk_.scene_.Reset(statement, body_.at("parameter").get<std::string>());
    return Restarted(StatementJson(desk_.scene_, statement));
  }

  HttpReply Set() const {
    const std::lock_guard lock(desk_.editing_);
    const std::vector<Color> factors = Factors();
    const std::vector<std::string> notes = GlowsThatStay(desk_.faders_, factors);
    desk_.scene_.Edit(EditsOf(desk_.scene_, desk_.faders_, factors));
    HttpReply reply = Restarted(nullptr, notes);
    const std::shared_ptr<const DeskPicture> picture = desk_.session_.Picture();
    const std::lock_guard settingLock(desk_.setting_);
    if (picture) std::erase_if(desk_.set_, [&](const SetFactors& set) { return set.restart <= picture->restart; });
    desk_.set_.push_back({desk_.session_.State().restart, factors});
    return reply;
  }

  HttpReply Pause() const {
    desk_.session_.Pause(body_.at("on").get<bool>());
    return ReplyWith(Json::object());
  }

  HttpReply Keep() const {
    const std::lock_guard lock(desk_.editing_);
    // Locations of statements and the picture are of the files as read.
    if (HashOfFiles(desk_.files_) != desk_.hashOfFiles_)
      throw Error("the files of the scene have changed since the desk has read them: start it anew");
    const KeptFiles kept = lampyr::Keep(desk_.scene_, desk_.session_, desk_.faders_, Factors());
    Json scenes = Json::array();
    for (const std::filesystem::path& file : kept.scenes) scenes.push_back(file.string());
    return ReplyWith({{"scenes", scenes}, {"picture", kept.picture.string()}, {"notes", kept.notes}});
  }

  Desk& desk_;
  const HttpRequest& request_;
  Json body_;
};

HttpReply Desk::Answer(const HttpRequest& request) {
  const auto wrong = [](const std::string& message) {
    HttpReply reply = ReplyWith({{"message", message}});
    reply.status = kWrong;
    return reply;
  };
  try {
    return Requests(*this, request).Answer();
  } catch (const Error& error) {
    return wrong(error.Text());
  } catch (const nlohmann::json::exception&) {
    return wrong("the request is not as the page makes it");
  } catch (const std::exception& error) {
    return wrong(error.what());
  } catch (...) {
    return wrong("the desk is about to end");
  }
}

}  // namespace lampyr
