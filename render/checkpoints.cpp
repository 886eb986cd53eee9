#include "render/checkpoints.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "film/atomic_file.h"

namespace lampyr {

namespace {

// Smallest interval between checkpoints, in multiples of the time that writing the last one took.
constexpr double kMostCost = 20;

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::filesystem::path CheckpointPath(const std::filesystem::path& image) {
  return std::filesystem::path(image).replace_extension(".checkpoint");
}

Checkpoints::Checkpoints(std::filesystem::path path, double seconds, PartHeader header, const ProgressiveRender& render,
                         std::function<void(const RenderOutcome&)> writeImage)
    : path_(std::move(path)),
      seconds_(seconds),
      header_(std::move(header)),
      render_(render),
      writeImage_(std::move(writeImage)) {}

void Checkpoints::Write(const RenderOutcome& outcome) {
  header_.samples = static_cast<uint32_t>(outcome.samplesPerPixel);
  AtomicFile file(path_);
  AppendPart(file, PartKind::Checkpoint, header_, [this](ByteWriter& bytes) { render_.Save(bytes); });
  file.Commit();
}

void Checkpoints::MayWrite(const RenderOutcome& soFar) {
  if (SecondsSince(last_) < std::max(seconds_, kMostCost * lastCost_)) return;
  const Clock::time_point start = Clock::now();
  try {
    writeImage_(soFar);
    Write(soFar);
  } catch (const Error& error) {
    std::fprintf(stderr, "warning: no checkpoint was written, the render goes on: %s\n", error.Text().c_str());
  }
  last_ = Clock::now();
  lastCost_ = SecondsSince(start);
}

void Checkpoints::Finish(const RenderOutcome& outcome) {
  Write(outcome);
}

void ResumeFrom(const std::filesystem::path& path, const PartHeader& header, ProgressiveRender& render) {
  const PartReader part(path, PartKind::Checkpoint);
  std::string difference = DifferenceOf(part.Header().identity, header.identity);
  const Shard &there = part.Header().shard, &here = header.shard;
  if (difference.empty() && (there.index != here.index || there.count != here.count || there.first != here.first)) {
    difference = "the part is " + std::to_string(there.index) + "/" + std::to_string(there.count) + " there and " +
                 std::to_string(here.index) + "/" + std::to_string(here.count) + " here";
  }
  if (difference.empty() && part.Header().layers != header.layers) difference = "the light groups are other ones";
  if (!difference.empty()) {
    throw UsageError("--resume: \"" + path.string() + "\" is of another render: " + difference +
                     "; render as before, or remove it to start anew");
  }
  if (part.Header().samples > here.end - here.first) {
    throw UsageError("--resume: \"" + path.string() + "\" holds " + std::to_string(part.Header().samples) +
                     " samples per pixel already, which is more than the " + std::to_string(here.end - here.first) +
                     " that are asked for; raise --spp");
  }
  part.Load([&](ByteReader& bytes) {
    render.Load(bytes);
    if (static_cast<uint32_t>(render.Outcome().samplesPerPixel) != part.Header().samples)
      throw Error("it holds a number out of range");
  });
}

}  // namespace lampyr
