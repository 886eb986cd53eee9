#include "render/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>

namespace lampyr {

namespace {

uint32_t Mixed(uint32_t block) {
  return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u;
}

// MurmurHash3 of 32 bits.
uint32_t HashOf(const std::string& text) {
  const auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<unsigned char>(text[i])); };
  uint32_t hash = 0;
  const size_t whole = text.size() / 4 * 4;
  for (size_t i = 0; i < whole; i += 4) {
    hash ^= Mixed(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    hash = std::rotl(hash, 13) * 5 + 0xe6546b64u;
  }
  uint32_t rest = 0;
  for (size_t i = text.size(); i > whole; --i) rest = rest << 8 | byte(i - 1);
  if (text.size() > whole) hash ^= Mixed(rest);
  hash ^= static_cast<uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

std::string Hexadecimal(uint32_t value) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", value);
  return text;
}

std::string Quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') {
      text += std::string("\\") + c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char code[7];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      text += code;
    } else {
      text += c;
    }
  }
  return text + "\"";
}

}  // namespace

float CryptomatteId(const std::string& name) {
  uint32_t hash = HashOf(name);
  const uint32_t exponent = hash >> 23 & 255;
  if (exponent == 0 || exponent == 255) hash ^= 1u << 23;
  return std::bit_cast<float>(hash);
}

void CryptomattePixel::Write(double total, float* values) const {
  std::vector<std::pair<float, double>> ranked(weights_.begin(), weights_.end());
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  for (size_t rank = 0; rank < kRanks; ++rank) {
    const bool has = rank < ranked.size() && total > 0;
    values[2 * rank] = has ? ranked[rank].first : 0.0f;
    values[2 * rank + 1] = has ? static_cast<float>(ranked[rank].second / total) : 0.0f;
  }
}

std::vector<std::string> CryptomatteChannels(const std::string& layer) {
  std::vector<std::string> channels;
  for (size_t level = 0; level < CryptomattePixel::kRanks / 2; ++level) {
    for (const char* channel : {"R", "G", "B", "A"})
      channels.push_back(layer + "0" + std::to_string(level) + "." + channel);
  }
  return channels;
}

std::map<std::string, std::string> CryptomatteMetadata(const std::string& layer,
                                                       const std::vector<std::string>& names) {
  std::string manifest;
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  for (const std::string& name : sorted) {
    manifest += (manifest.empty() ? "" : ",") + Quoted(name) + ":\"" +
                Hexadecimal(std::bit_cast<uint32_t>(CryptomatteId(name))) + "\"";
  }
  const std::string key = "cryptomatte/" + Hexadecimal(HashOf(layer)).substr(0, 7) + "/";
  return {{key + "name", layer},
          {key + "hash", "MurmurHash3_32"},
          {key + "conversion", "uint32_to_float32"},
          {key + "manifest", "{" + manifest + "}"}};
}

}  // namespace lampyr
