// What a scene file may ask for at most. No scene that is meant to be rendered comes near: these stand between a broken
// or hostile file and the machine.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lampyr::limits {

inline constexpr size_t kOpenFiles = 256;              // within one another
inline constexpr size_t kNamedFiles = 50'000;          // Include and Import statements that are carried out
inline constexpr uint64_t kRepeatedText = 1ull << 30;  // bytes of files that are included again
inline constexpr size_t kOpenScopes = 50'000;          // AttributeBegin and ObjectBegin within one another
inline constexpr size_t kParameters = 1000;            // of one statement
// Of one target of Attribute: each statement that follows has a copy of them.
inline constexpr size_t kDefaultParameters = 64, kDefaultValues = 1000;
inline constexpr size_t kNestedNames = 256;      // textures, materials or light filters, or motions, within one another
inline constexpr size_t kEvaluations = 2000;     // of textures or filters that name others, for one that is asked
inline constexpr size_t kSuggestedNames = 1000;  // among which warnings look for the one that was meant
inline constexpr size_t kLinks = size_t{1} << 27;  // entries of the tables of which light shines where
// Compressed text that grows by more, and beyond what any machine bears, is no text.
inline constexpr size_t kLargestGrowth = 200;
inline constexpr size_t kAlwaysFineText = size_t{64} << 20;

}  // namespace lampyr::limits
