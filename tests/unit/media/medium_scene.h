// Support for the tests of media: media of a scene's text.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "media/make_media.h"
#include "unit/scene/scene_support.h"

namespace lampyr {

inline std::vector<std::shared_ptr<const Medium>> MediaOf(const std::string& text, Diagnostics& diagnostics,
                                                          const Transform& renderFromWorld = {},
                                                          uint64_t memoryBytes = uint64_t{1} << 30) {
  MemoryBudget memory(memoryBytes);
  return MakeMedia(ParseScene(InWorld(text), "scene.pbrt", diagnostics), renderFromWorld, memory, diagnostics);
}

// The medium "m" of the given type and parameters, without warnings. `before`: statements before it.
inline std::shared_ptr<const Medium> MediumOf(const std::string& parameters, const std::string& before = "",
                                              const Transform& renderFromWorld = {}) {
  Diagnostics strict(Diagnostics::Mode::Strict);
  const auto media = MediaOf(before + "\nMakeNamedMedium \"m\" \"string type\" " + parameters, strict, renderFromWorld);
  EXPECT_EQ(media.size(), 1u);
  return media.at(0);
}

// The message of what is wrong with the medium; its statement is line 2, its type's string is at column 21.
inline std::string MediumError(const std::string& parameters, uint64_t memoryBytes = uint64_t{1} << 30) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return ErrorOf(
      [&] { MediaOf("MakeNamedMedium \"m\" \"string type\" " + parameters, diagnostics, Transform(), memoryBytes); });
}

}  // namespace lampyr
