// Saved renders: what `--resume` and `merge` read.
#include "fuzz/target_support.h"
#include "render/build/scene_builder.h"
#include "render/progressive_render.h"
#include "render/render_part.h"
#include "render/settings/integrator_choice.h"

namespace lampyr::fuzz {

namespace {

// The bytes as the state of a file with the right end: no fuzzer finds a checksum.
std::vector<std::byte> Sealed(std::string_view bytes) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  std::vector<std::byte> file(first, first + bytes.size());
  const uint64_t size = file.size();
  const uint32_t checksum = ChecksumOf(file);
  const auto append = [&file](const void* from, size_t count) {
    const auto* begin = static_cast<const std::byte*>(from);
    file.insert(file.end(), begin, begin + count);
  };
  append(&size, sizeof size);
  append(&checksum, sizeof checksum);
  append(kPartMark.data(), kPartMark.size());
  return file;
}

// The first byte tells what the rest is: s and c, the state of a picture's part and of a checkpoint, without its end;
// otherwise a whole file.
std::vector<std::byte> FileOf(std::string_view bytes) {
  const std::string_view rest = bytes.substr(1);
  if (bytes[0] == 's' || bytes[0] == 'c') return Sealed(rest);
  const auto* first = reinterpret_cast<const std::byte*>(rest.data());
  return {first, first + rest.size()};
}

void CheckPicture(const Film& film) {
  for (const float value : film.Develop().data) {
    if (!(std::abs(value) <= std::numeric_limits<float>::max())) Fail("a picture that is not finite");
  }
}

// A render to go on with, that has everything a checkpoint may hold.
struct Small {
  Small() {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const char* text = R"(LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" WorldBegin
LightSource "point" "point3 from" [ 0 2 1 ] "string lightGroup" "key"
LightSource "point" "point3 from" [ 1 2 1 ]
Material "conductor" Shape "trianglemesh" "point3 P" [ -5 0 -5 -5 0 5 5 0 5 5 0 -5 ] "integer indices" [ 0 1 2 0 2 3 ])";
    RenderOverrides overrides;
    overrides.width = overrides.height = 3;
    overrides.integrator = "vcm";
    overrides.values["learn-always"] = true;
    built = BuildScene(ParseScene(text, SceneName(), diagnostics), overrides, true, diagnostics);
    integrator = MakeIntegrator(built.scene, built.settings);
  }

  void GoOn(ByteReader& bytes) const {
    Film film(3, 3, {0, 0, 3, 3}, built.scene.lighting->Groups().Layers());
    ProgressiveRender render(built.scene, *integrator, built.settings, 1, film);
    render.Load(bytes);
    bytes.CheckEnd();
    render.AddSamples(1);
    CheckPicture(film);
  }

  BuiltScene built;
  std::unique_ptr<Integrator> integrator;
};

}  // namespace

bool ReadSavedPart(std::string_view bytes) {
  if (bytes.empty()) return false;
  return AcceptErrors([&] {
    const std::vector<std::byte> file = FileOf(bytes);
    std::span<const std::byte> state;
    if (bytes[0] == 'c') {
      ReadPart(file, PartKind::Checkpoint, state);
      static const Small small;
      ByteReader reader(state);
      return small.GoOn(reader);
    }
    const PartHeader header = ReadPart(file, PartKind::Picture, state);
    Film film = header.MakeFilm();
    ByteReader reader(state);
    film.Load(reader);
    reader.CheckEnd();
    film.Add(film);
    CheckPicture(film);
  });
}

}  // namespace lampyr::fuzz
