// The state of a render in a file, to resume the render or to merge it with others: which render it is, which of its
// samples it has, and the bytes of the state.
//
// The state is at the end of the file: behind the image in an EXR that is one part of a picture, alone in a checkpoint.
// Layout: [state][its size, 8 bytes][its checksum, 4 bytes][a mark, 12 bytes].
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/byte_stream.h"
#include "base/mapped_file.h"
#include "film/film.h"
#include "render/load_scene.h"

namespace lampyr {

class AtomicFile;

// The end of a file with a state. The last character is the version of the layout.
inline constexpr std::string_view kPartMark = "lampyr part6";

// All that the samples depend on, as pairs of name and value: scene, files, settings, version. Threads, passes and
// shards do not affect the samples and are not included.
using RenderIdentity = std::vector<std::pair<std::string, std::string>>;
RenderIdentity IdentityOf(const LoadedScene& loaded, bool robustIntersection);
// The first difference, as text such as `seed is 3 there and 4 here`; "": none.
std::string DifferenceOf(const RenderIdentity& there, const RenderIdentity& here);

// Part `index` (from 1) of `count`: samples [first, end) of each pixel, of `whole` in all.
struct Shard {
  int index = 1, count = 1;
  uint32_t first = 0, end = 0, whole = 0;
  bool operator==(const Shard&) const = default;
};
// The shard of a render with `samples` per pixel. Throws a UsageError if a part would be empty.
Shard ShardOf(int index, int count, int samples);

// Header of a part.
struct PartHeader {
  RenderIdentity identity;
  Shard shard;
  uint32_t samples = 0;     // per pixel in the file
  bool isFinished = false;  // all samples of the shard are there; without a wanted number, those until the stop
  int width = 0, height = 0;
  PixelRect crop;
  std::vector<std::string> layers;
  bool halfPrecision = false;
  bool isAdaptive = false, hasGroups = false;   // the film (Film::MakeAdaptive)
  std::map<std::string, std::string> metadata;  // of the image made of all its samples

  Film MakeFilm() const;
};

enum class PartKind : uint8_t { Checkpoint, Picture };

// Writes `header` and the state at the end of a file; `save` writes the state.
void AppendPart(AtomicFile& file, PartKind kind, const PartHeader& header,
                const std::function<void(ByteWriter&)>& save);

// A part read from a file. Throws an Error that names the file if it is not valid.
class PartReader {
 public:
  PartReader(const std::filesystem::path& path, PartKind kind);

  const PartHeader& Header() const { return header_; }
  // Reads the state with `load`, which must read all of it. An Error of `load` is made to name the file, too.
  void Load(const std::function<void(ByteReader&)>& load) const;

 private:
  std::filesystem::path path_;
  MappedFile file_;
  PartHeader header_;
  std::span<const std::byte> state_;
};

// Reads the header of a part in memory; `state` becomes the bytes after it. Throws an Error. Public for tests.
PartHeader ReadPart(std::span<const std::byte> bytes, PartKind kind, std::span<const std::byte>& state);

}  // namespace lampyr
