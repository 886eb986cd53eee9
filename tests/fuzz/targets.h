// The fuzz targets. Each target takes the bytes of one input: an Error, or an answer, is correct, and the target
// returns true for an answer; any other outcome (a crash, a sanitizer's report, another exception, a wait of seconds,
// memory out of proportion) is a defect.
//
// The fuzzer (fuzzer.cpp) and the replay of the corpus (tests/badinput/corpus.cpp) call the same functions.
#pragma once

#include <string>
#include <string_view>

namespace lampyr::fuzz {

// The text of a scene file, or gzipped text: read, then every parameter asked for in every way.
bool ReadSceneText(std::string_view bytes);
// The text of a scene file: read, built and rendered, a few pixels with one sample each.
bool BuildSceneText(std::string_view bytes);
// Records of four bytes, of which each is a statement that names others (graph.cpp): the scene's text that they make is
// built and rendered as the above.
bool BuildSceneGraph(std::string_view bytes);
// A PLY file, gzipped or not.
bool ReadPlyFile(std::string_view bytes);
// One byte that chooses the format (kImageExtensions), then an image file of it.
bool ReadImageFile(std::string_view bytes);
// An IES file: read, then asked for intensities.
bool ReadIesFile(std::string_view bytes);
// A lens file: read, then a few rays through the lens.
bool ReadLens(std::string_view bytes);
// A measured material: read, then sampled and evaluated.
bool ReadMeasuredFile(std::string_view bytes);
// A letter, then a NanoVDB file (f) or changes to a valid one (p: volume.cpp): read, then asked for values.
bool ReadVolumeFile(std::string_view bytes);
// One byte that says what the rest is of (part.cpp), then a saved render: read, and gone on with or added.
bool ReadSavedPart(std::string_view bytes);

inline constexpr const char* kImageExtensions[] = {".exr", ".png", ".jpg", ".hdr", ".tif",  ".tga",
                                                   ".bmp", ".pfm", ".ppm", ".gif", ".webp", ".other"};

struct Target {
  const char* name;  // of the program fuzz_NAME, and of corpus/NAME
  bool (*run)(std::string_view bytes);
};

inline constexpr Target kTargets[] = {
    {"scene", ReadSceneText}, {"build", BuildSceneText}, {"graph", BuildSceneGraph}, {"ply", ReadPlyFile},
    {"image", ReadImageFile}, {"ies", ReadIesFile},      {"lens", ReadLens},         {"measured", ReadMeasuredFile},
    {"part", ReadSavedPart},  {"volume", ReadVolumeFile}};

// Thrown by a target that was given an answer that cannot be right.
[[noreturn]] void Fail(const std::string& what);

}  // namespace lampyr::fuzz
