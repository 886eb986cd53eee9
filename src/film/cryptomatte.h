// Cryptomatte ([Friedman15]; version 1.2.0 of its specification): the coverage of each pixel by objects or materials,
// for masks in compositing.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace lampyr {

// The identifier of a name: the bits of its MurmurHash3 (32 bits, seed 0), as a float that is a normal number.
float CryptomatteId(const std::string& name);

// Coverage of a pixel by identifier. Write keeps the largest.
class CryptomattePixel {
 public:
  void Add(float id, double weight) { weights_[id] += weight; }
  // Writes kRanks pairs of identifier and coverage, the largest first, padded with 0. `total`: weight of the whole
  // pixel.
  void Write(double total, float* values) const;

  static constexpr size_t kRanks = 6;

 private:
  std::map<float, double> weights_;
};

// Channels of a layer such as "CryptoObject": CryptoObject00.R, .G, .B, .A, CryptoObject01.R, …: identifiers in R and
// B, coverages in G and A.
std::vector<std::string> CryptomatteChannels(const std::string& layer);
// The metadata that describe the layer, with a manifest of its names.
std::map<std::string, std::string> CryptomatteMetadata(const std::string& layer, const std::vector<std::string>& names);

}  // namespace lampyr
