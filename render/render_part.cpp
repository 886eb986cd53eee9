#include "render/render_part.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>

#include "base/version.h"
#include "film/atomic_file.h"
#include "render/settings/integrator_choice.h"
#include "scene/referenced_files.h"

namespace lampyr {

namespace {

// The last digit is the version of the format.
constexpr size_t kEndBytes = sizeof(uint64_t) + sizeof(uint32_t) + kPartMark.size();
constexpr uint64_t kMostEntries = 1 << 16;
constexpr int kMostPixels = 1 << 16;  // across

// The fewest decimal digits that restore the exact value.
std::string ToExactString(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string ToExactString(const glm::mat3& matrix) {
  std::string text;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row)
      text += (text.empty() ? "" : " ") + ToExactString(static_cast<double>(matrix[column][row]));
  }
  return text;
}

std::string YesOrNo(bool value) {
  return value ? "on" : "off";
}

template <class List>
void SavePairs(ByteWriter& bytes, const List& pairs) {
  bytes.Value<uint64_t>(pairs.size());
  for (const auto& [name, value] : pairs) {
    bytes.Text(name);
    bytes.Text(value);
  }
}

RenderIdentity LoadPairs(ByteReader& bytes) {
  RenderIdentity pairs;
  const auto count = bytes.Value<uint64_t>();
  if (count > kMostEntries) throw Error("it holds a number out of range");
  for (uint64_t i = 0; i < count; ++i) {
    // The only limit is the file: the manifest of a matte lists the names of all objects.
    std::string name = bytes.Text(bytes.Left());
    pairs.emplace_back(std::move(name), bytes.Text(bytes.Left()));
  }
  return pairs;
}

void Save(ByteWriter& bytes, PartKind kind, const PartHeader& header) {
  bytes.Value(kind);
  SavePairs(bytes, header.identity);
  bytes.Value(header.shard);
  bytes.Value(header.samples);
  bytes.Value<uint8_t>(header.isFinished ? 1 : 0);
  bytes.Value(header.width);
  bytes.Value(header.height);
  bytes.Value(header.crop);
  bytes.Value<uint64_t>(header.layers.size());
  for (const std::string& layer : header.layers) bytes.Text(layer);
  for (const bool flag : {header.halfPrecision, header.isAdaptive, header.hasGroups})
    bytes.Value<uint8_t>(flag ? 1 : 0);
  SavePairs(bytes, header.metadata);
}

void CheckHeader(const PartHeader& header, uint64_t bytesLeft) {
  const Shard& shard = header.shard;
  const PixelRect& crop = header.crop;
  const bool isSized = header.width >= 1 && header.height >= 1 && header.width <= kMostPixels &&
                       header.height <= kMostPixels && crop.x0 >= 0 && crop.y0 >= 0 && crop.x1 > crop.x0 &&
                       crop.y1 > crop.y0 && crop.x1 <= header.width && crop.y1 <= header.height;
  const bool isShard = shard.count >= 1 && shard.index >= 1 && shard.index <= shard.count && shard.first < shard.end &&
                       shard.end <= shard.whole && shard.whole <= (1u << 30) && header.samples <= (1u << 30);
  if (!isSized || !isShard || (header.hasGroups && !header.isAdaptive)) throw Error("it holds a number out of range");
  // The film alone would be larger than the rest of the file: checked before its memory is allocated.
  const uint64_t pixels = static_cast<uint64_t>(crop.Width()) * static_cast<uint64_t>(crop.Height());
  if (bytesLeft / Film::BytesPerPixel(header.layers.size(), false, header.isAdaptive, header.hasGroups) < pixels)
    throw Error("unexpected end of data");
}

PartHeader LoadHeader(ByteReader& bytes, PartKind kind) {
  if (bytes.Value<PartKind>() != kind) {
    throw Error(kind == PartKind::Checkpoint ? "it is a part of a picture and not a checkpoint"
                                             : "it is a checkpoint and not a part of a picture");
  }
  PartHeader header;
  header.identity = LoadPairs(bytes);
  header.shard = bytes.Value<Shard>();
  header.samples = bytes.Value<uint32_t>();
  header.isFinished = bytes.Flag();
  header.width = bytes.Value<int>();
  header.height = bytes.Value<int>();
  header.crop = bytes.Value<PixelRect>();
  const auto layers = bytes.Value<uint64_t>();
  if (layers > kMostEntries) throw Error("it holds a number out of range");
  for (uint64_t i = 0; i < layers; ++i) header.layers.push_back(bytes.Text());
  for (bool* flag : {&header.halfPrecision, &header.isAdaptive, &header.hasGroups}) *flag = bytes.Flag();
  for (auto& [name, value] : LoadPairs(bytes)) header.metadata[name] = std::move(value);
  CheckHeader(header, bytes.Left());
  return header;
}

// The state before the mark, after checking its size and checksum.
std::span<const std::byte> FindState(std::span<const std::byte> file) {
  const auto end = file.size() >= kEndBytes ? file.last(kEndBytes) : std::span<const std::byte>();
  constexpr size_t markAt = kEndBytes - kPartMark.size(), versionAt = kEndBytes - 1;
  if (end.empty() || std::memcmp(end.data() + markAt, kPartMark.data(), kPartMark.size() - 1) != 0) {
    throw Error("it holds no sums: only images of `lampyr render --shard` and checkpoints do, as they were written");
  }
  if (static_cast<char>(end[versionAt]) != kPartMark.back()) {
    throw Error("another version of lampyr has written it, whose files this one does not know");
  }
  ByteReader tail(end);
  const auto size = tail.Value<uint64_t>();
  const auto checksum = tail.Value<uint32_t>();
  if (size > file.size() - kEndBytes) throw Error("unexpected end of data");
  const std::span<const std::byte> state = file.subspan(file.size() - kEndBytes - size, size);
  if (ChecksumOf(state) != checksum) throw Error("it is damaged: its checksum is another one");
  return state;
}

}  // namespace

RenderIdentity IdentityOf(const LoadedScene& loaded, bool robustIntersection) {
  const RenderSettings& s = loaded.built.settings;
  const PixelFilterSettings& f = s.filter;
  const auto integer = [](auto value) { return std::to_string(value); };
  const PixelRect& crop = s.crop;
  RenderIdentity identity = {
      {"the version of lampyr", kVersion},
      {"the scene's text (its fingerprint)", loaded.hash},
      {"what the files of the scene hold (its fingerprint)", HashOfFiles(loaded.files)},
      {"the number of plugins", integer(loaded.types.Plugins().size())},
      {"the integrator", s.integrator},
      {"the seed", integer(s.seed)},
      {"the resolution", integer(s.width) + "x" + integer(s.height)},
      {"the crop", integer(crop.x0) + "," + integer(crop.x1) + "," + integer(crop.y0) + "," + integer(crop.y1)},
      {"the exposure", ToExactString(static_cast<double>(s.sensor.ImagingRatio()))},
      {"the white balance", ToExactString(s.sensor.BalanceMatrix())},
      {"the limit on samples", ToExactString(static_cast<double>(s.sensor.MaxComponent()))},
      {"half precision", YesOrNo(s.halfPrecision)},
      {"the kind of pixel filter", integer(static_cast<int>(f.kind))},
      {"the pixel filter's settings",
       ToExactString(static_cast<double>(f.radiusX)) + " " + ToExactString(static_cast<double>(f.radiusY)) + " " +
           ToExactString(static_cast<double>(f.sigma)) + " " + ToExactString(static_cast<double>(f.b)) + " " +
           ToExactString(static_cast<double>(f.c)) + " " + ToExactString(static_cast<double>(f.tau))},
      {"the sampler", s.sampler == SamplerKind::Sobol ? "sobol" : "independent"},
      {"watertight intersection", YesOrNo(robustIntersection)}};
  if (s.WantsFirstHit()) identity.emplace_back("--through-smooth", YesOrNo(s.seesThroughSmooth));
  if (s.spectral) identity.emplace_back("--spectral", YesOrNo(*s.spectral));
  if (s.bands)
    identity.emplace_back("bands of the spectrum", std::to_string(s.bands->count) + " from " +
                                                       ToExactString(s.bands->from) + " to " +
                                                       ToExactString(s.bands->to) + " nm");
  if (s.adaptive) identity.emplace_back("--adaptive", "on, for " + ToExactString(s.adaptive->share) + " of the pixels");
  for (const LayerRequest& request : s.layers)
    identity.emplace_back("the layer " + request.layer.name, request.layer.text);
  if (s.counts && !s.counts->IsDefault())
    identity.emplace_back("what auto decided (its fingerprint)", s.counts->Fingerprint());
  for (const Setting* setting : IntegratorOf(s.integrator).settings)
    identity.emplace_back("--" + setting->name, Setting::ToExactString(s.values.Value(setting->name)));
  return identity;
}

Film PartHeader::MakeFilm() const {
  Film film(width, height, crop, layers);
  if (isAdaptive) film.MakeAdaptive(hasGroups);
  return film;
}

std::string DifferenceOf(const RenderIdentity& there, const RenderIdentity& here) {
  const auto valueIn = [](const RenderIdentity& identity, const std::string& name) -> const std::string* {
    const auto found =
        std::find_if(identity.begin(), identity.end(), [&](const auto& item) { return item.first == name; });
    return found == identity.end() ? nullptr : &found->second;
  };
  for (const auto& [name, value] : there) {
    const std::string* other = valueIn(here, name);
    if (!other) return name + " is " + value + " there, and is not set here";
    if (*other != value) return name + " is " + value + " there and " + *other + " here";
  }
  for (const auto& [name, value] : here) {
    if (!valueIn(there, name)) return name + " is " + value + " here, and is not set there";
  }
  // Several items may have one name.
  return there == here ? "" : "the settings are other ones";
}

Shard ShardOf(int index, int count, int samples) {
  const auto bound = [&](int part) { return static_cast<uint32_t>(static_cast<int64_t>(samples) * part / count); };
  if (samples < count) {
    throw UsageError("--shard: " + std::to_string(samples) + " samples per pixel make no " + std::to_string(count) +
                     " parts; raise --spp or make fewer");
  }
  return {index, count, bound(index - 1), bound(index), static_cast<uint32_t>(samples)};
}

void AppendPart(AtomicFile& file, PartKind kind, const PartHeader& header,
                const std::function<void(ByteWriter&)>& save) {
  ByteWriter state([&](const void* bytes, size_t count) { file.Write(bytes, count); });
  Save(state, kind, header);
  save(state);
  const uint64_t size = state.Written();
  const uint32_t checksum = state.Checksum();
  file.Write(&size, sizeof size);
  file.Write(&checksum, sizeof checksum);
  file.Write(kPartMark.data(), kPartMark.size());
}

PartHeader ReadPart(std::span<const std::byte> bytes, PartKind kind, std::span<const std::byte>& state) {
  const std::span<const std::byte> all = FindState(bytes);
  ByteReader reader(all);
  PartHeader header = LoadHeader(reader, kind);
  state = all.last(reader.Left());
  return header;
}

PartReader::PartReader(const std::filesystem::path& path, PartKind kind) : path_(path), file_(path) {
  try {
    header_ = ReadPart(file_.Bytes(), kind, state_);
  } catch (const Error& error) {
    throw Error("\"" + path.string() + "\" cannot be used: " + error.Text());
  }
}

void PartReader::Load(const std::function<void(ByteReader&)>& load) const {
  try {
    ByteReader reader(state_);
    load(reader);
    reader.CheckEnd();
  } catch (const Error& error) {
    throw Error("\"" + path_.string() + "\" cannot be used: " + error.Text());
  }
}

}  // namespace lampyr
