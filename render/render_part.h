// What of a render is kept in a file, so that it can be gone on with or added to others: which render it is, which of
// its samples are there, and the bytes of its state.
//
// The state stands at the end of the file, behind the image in an EXR that is one part of a picture, alone in a
// checkpoint: [state][its size, 8 bytes][its checksum, 4 bytes][a mark, 12 bytes].
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/byte_stream.h"
#include "base/mapped_file.h"
#include "film/film.h"
#include "render/load_scene.h"

namespace lampyr {

class AtomicFile;

// All that the samples depend on, by name: scene, files, settings, version. How they are shared among threads, passes
// and machines does not show in them and is not in it.
using RenderIdentity = std::vector<std::pair<std::string, std::string>>;
RenderIdentity IdentityOf(const LoadedScene& loaded, bool robustIntersection);
// The first thing that differs, for people: `seed is 3 there and 4 here`; "": nothing.
std::string DifferenceOf(const RenderIdentity& there, const RenderIdentity& here);

// Part `index` of `count`, from 1: samples [first, end) of each pixel, of `whole` in all.
struct Shard {
  int index = 1, count = 1;
  uint32_t first = 0, end = 0, whole = 0;
  bool operator==(const Shard&) const = default;
};
// Of `samples` in all. Throws UsageError where a part would have none.
Shard ShardOf(int index, int count, int samples);

// What a file says of itself.
struct PartHeader {
  RenderIdentity identity;
  Shard shard;
  uint32_t samples = 0;     // that are there
  bool isFinished = false;  // as many as were asked for, by number, time or error
  int width = 0, height = 0;
  PixelRect crop;
  std::vector<std::string> layers;
  bool halfPrecision = false;
  std::map<std::string, std::string> metadata;  // of the image that all of its samples make

  Film MakeFilm() const { return {width, height, crop, layers}; }
};

enum class PartKind : uint8_t { Checkpoint, Picture };

// Writes both at the end of a file; `save` writes the state that the header is of.
void AppendPart(AtomicFile& file, PartKind kind, const PartHeader& header,
                const std::function<void(ByteWriter&)>& save);

// A part as it is read from a file. All that is wrong with it is an Error that names the file.
class PartReader {
 public:
  PartReader(const std::filesystem::path& path, PartKind kind);

  const PartHeader& Header() const { return header_; }
  // Reads all of the state. What `load` throws names the file, too.
  void Load(const std::function<void(ByteReader&)>& load) const;

 private:
  std::filesystem::path path_;
  MappedFile file_;
  PartHeader header_;
  std::span<const std::byte> state_;
};

// A part in memory, without its file: the header, and what is left of the bytes. Throws an Error. For tests of what it
// is made of.
PartHeader ReadPart(std::span<const std::byte> bytes, PartKind kind, std::span<const std::byte>& state);

}  // namespace lampyr
