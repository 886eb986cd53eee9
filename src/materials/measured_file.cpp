#include "materials/measured_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "base/mapped_file.h"
#include "scene/lexer.h"
#include "scene/spectrum.h"

namespace lampyr {

namespace {

// Types of values, by their number in the file.
constexpr uint8_t kByte = 1, kFloat = 10;

struct Tensor {
  std::vector<size_t> shape;
  std::vector<float> values;  // empty for bytes
};

using Tensors = std::map<std::string, Tensor>;

// For messages. `name`: any bytes of the file.
std::string FieldOf(std::string_view name) {
  return "its field " + ShownWord(name);
}

// Little-endian, like the processors that this runs on.
class TensorReader {
 public:
  explicit TensorReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  Tensors Read() {
    constexpr std::string_view magic("tensor_file\0\1\0", 14);
    if (bytes_.size() < magic.size() || std::memcmp(bytes_.data(), magic.data(), magic.size()) != 0)
      throw Error("it is no tensor file of version 1.0, as the RGL material database has them");
    at_ = magic.size();
    const auto count = Take<uint32_t>();
    constexpr uint32_t kMostFields = 64;
    if (count > kMostFields) throw Error("it claims to have " + std::to_string(count) + " fields");
    Tensors tensors;
    for (uint32_t i = 0; i < count; ++i) {
      const std::string name = TakeName();
      if (!tensors.emplace(name, TakeTensor(name)).second) throw Error(FieldOf(name) + " occurs twice");
    }
    return tensors;
  }

 private:
  template <class T>
  T Take() {
    if (bytes_.size() - at_ < sizeof(T)) throw Error("unexpected end of the header");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string TakeName() {
    const auto length = Take<uint16_t>();
    if (bytes_.size() - at_ < length) throw Error("unexpected end of the header");
    std::string name(reinterpret_cast<const char*>(bytes_.data()) + at_, length);
    at_ += length;
    return name;
  }
  Tensor TakeTensor(const std::string& name) {
    const auto dimensions = Take<uint16_t>();
    const auto type = Take<uint8_t>();
    const auto offset = Take<uint64_t>();
    constexpr uint16_t kMostDimensions = 8;
    if (dimensions > kMostDimensions) throw Error(FieldOf(name) + " has too many dimensions");
    Tensor tensor;
    uint64_t size = 1;
    for (uint16_t i = 0; i < dimensions; ++i) {
      const auto extent = Take<uint64_t>();
      if (extent > bytes_.size()) throw Error(FieldOf(name) + " is larger than the file");
      tensor.shape.push_back(extent);
      if (extent > 0 && size > bytes_.size() / extent) throw Error(FieldOf(name) + " is larger than the file");
      size *= extent;
    }
    if (type == kByte) return tensor;
    if (type != kFloat) throw Error(FieldOf(name) + " does not hold 32-bit numbers");
    if (offset > bytes_.size() || size > (bytes_.size() - offset) / sizeof(float))
      throw Error(FieldOf(name) + " goes beyond the end of the file");
    tensor.values.resize(size);
    if (size > 0) std::memcpy(tensor.values.data(), bytes_.data() + offset, size * sizeof(float));
    // Far above any measurement; products of values within it stay in the range of float.
    constexpr float kLargest = 1e15f;
    for (const float value : tensor.values) {
      if (!(std::abs(value) <= kLargest))
        throw Error(FieldOf(name) + " holds a number that is not finite, or beyond 1e15");
    }
    return tensor;
  }

  std::span<const std::byte> bytes_;
  size_t at_ = 0;
};

const Tensor& Get(const Tensors& tensors, const char* name, size_t dimensions) {
  const auto found = tensors.find(name);
  if (found == tensors.end()) throw Error("it has no field " + ShownWord(name));
  const Tensor& tensor = found->second;
  if (tensor.shape.size() != dimensions) {
    throw Error(FieldOf(name) + " has " + std::to_string(tensor.shape.size()) + " dimensions and not " +
                std::to_string(dimensions));
  }
  if (tensor.values.empty()) throw Error(FieldOf(name) + " holds no 32-bit numbers");
  return tensor;
}

void CheckNotNegative(const Tensor& tensor, const char* name) {
  for (const float value : tensor.values) {
    if (value < 0) throw Error(std::string("its field \"") + name + "\" holds a negative number");
  }
}

std::vector<float> AscendingAngles(const Tensors& tensors, const char* name, double least, double most) {
  const Tensor& tensor = Get(tensors, name, 1);
  constexpr double kRounding = 1e-3;
  for (size_t i = 0; i < tensor.values.size(); ++i) {
    const auto angle = static_cast<double>(tensor.values[i]);
    if (angle < least - kRounding || angle > most + kRounding || (i > 0 && !(tensor.values[i] > tensor.values[i - 1])))
      throw Error(std::string("the angles of its field \"") + name + "\" do not ascend within their range");
  }
  return tensor.values;
}

// Checks the shape of a table of nodes for each direction of incidence: (φ, θ, …, rows, columns).
void CheckShape(const Tensor& tensor, const char* name, const MeasuredData& data) {
  const size_t n = tensor.shape.size();
  const bool hasNodes = tensor.shape[n - 1] >= 2 && tensor.shape[n - 2] >= 2;
  const bool fits = n == 2 || (tensor.shape[0] == data.phi.size() && tensor.shape[1] == data.theta.size());
  if (!hasNodes || !fits) throw Error(std::string("the size of its field \"") + name + "\" does not fit the others");
  CheckNotNegative(tensor, name);
}

MeasuredTable<float> TableOf(const Tensors& tensors, const char* name, const MeasuredData& data) {
  const Tensor& tensor = Get(tensors, name, 2);
  CheckShape(tensor, name, data);
  return {tensor.values, tensor.shape[1], tensor.shape[0]};
}

MeasuredWarp WarpOf(const Tensors& tensors, const char* name, const MeasuredData& data) {
  const Tensor& tensor = Get(tensors, name, 4);
  CheckShape(tensor, name, data);
  try {
    return {tensor.values, tensor.shape[3], tensor.shape[2]};
  } catch (const Error&) {
    throw Error(std::string("a table of its field \"") + name + "\" is 0 everywhere");
  }
}

// Colour of a reflectance that may exceed 1.
Color ColorOf(const std::vector<SpectrumSample>& spectrum) {
  double largest = 0;
  for (const SpectrumSample& sample : spectrum) largest = std::max(largest, sample.value);
  if (!(largest > 0)) return Color(0.0f);
  std::vector<SpectrumSample> scaled = spectrum;
  for (SpectrumSample& sample : scaled) sample.value /= largest;
  return SpectrumToColor(scaled, SpectrumRole::Albedo) * static_cast<float>(largest);
}

MeasuredTable<Color> ReflectanceOf(const Tensors& tensors, const MeasuredData& data) {
  const bool isRgb = tensors.count("rgb") > 0;
  const char* name = isRgb ? "rgb" : "spectra";
  if (!isRgb && tensors.count(name) == 0) throw Error("it has neither a field \"rgb\" nor a field \"spectra\"");
  const Tensor& tensor = Get(tensors, name, 5);
  CheckShape(tensor, name, data);
  const size_t channels = tensor.shape[2], nodes = tensor.shape[3] * tensor.shape[4];
  std::vector<SpectrumSample> spectrum;
  if (isRgb) {
    if (channels != 3) throw Error("its field \"rgb\" does not have three channels");
  } else {
    const Tensor& wavelengths = Get(tensors, "wavelengths", 1);
    constexpr double kShortest = 100, kVisibleFrom = 360, kVisibleTo = 830;  // nm
    if (wavelengths.values.size() != channels) throw Error("its field \"wavelengths\" does not fit \"spectra\"");
    for (size_t c = 0; c < channels; ++c) {
      spectrum.push_back({static_cast<double>(wavelengths.values[c]), 0});
      if (!(spectrum[c].wavelength > (c > 0 ? spectrum[c - 1].wavelength : 0)))
        throw Error("its field \"wavelengths\" does not ascend");
    }
    if (spectrum.back().wavelength < kShortest)
      throw Error("its field \"wavelengths\" ends below 100 nm: they are in nanometres. Are these micrometres?");
    if (spectrum.back().wavelength < kVisibleFrom || spectrum.front().wavelength > kVisibleTo)
      throw Error("its field \"wavelengths\" has none that is visible, between 360 and 830 nm");
  }
  const size_t tables = data.phi.size() * data.theta.size();
  std::vector<Color> colors(tables * nodes);
  for (size_t table = 0; table < tables; ++table) {
    for (size_t node = 0; node < nodes; ++node) {
      const auto value = [&](size_t c) { return tensor.values[(table * channels + c) * nodes + node]; };
      Color& color = colors[table * nodes + node];
      if (isRgb) {
        color = Color(value(0), value(1), value(2));
        continue;
      }
      for (size_t c = 0; c < channels; ++c) spectrum[c].value = static_cast<double>(value(c));
      color = ColorOf(spectrum);
    }
  }
  return {std::move(colors), tensor.shape[4], tensor.shape[3]};
}

constexpr double kTurn = 2 * 3.14159265358979323846;
constexpr double kRoundingOfAngles = 1e-2;

// Closes a turn of azimuths within [-π, π]: where they do not reach π, the first one is added after the last, a turn
// later, and where they do not reach -π, the last one before the first.
void CloseTurn(Tensors& tensors) {
  const std::vector<float> given = tensors.at("phi_i").values;
  const auto first = static_cast<double>(given.front()), last = static_cast<double>(given.back());
  const bool isAppended = last<0.5 * kTurn - kRoundingOfAngles, isPrepended = first> - 0.5 * kTurn + kRoundingOfAngles;
  for (const char* name : {"phi_i", "vndf", "luminance", "spectra", "rgb"}) {
    const auto found = tensors.find(name);
    if (found == tensors.end() || found->second.shape.empty() || found->second.values.empty()) continue;
    Tensor& tensor = found->second;
    const auto each = static_cast<std::ptrdiff_t>(tensor.values.size() / tensor.shape[0]);
    const std::vector<float> ofFirst(tensor.values.begin(), tensor.values.begin() + each),
        ofLast(tensor.values.end() - each, tensor.values.end());
    if (isAppended) tensor.values.insert(tensor.values.end(), ofFirst.begin(), ofFirst.end());
    if (isPrepended) tensor.values.insert(tensor.values.begin(), ofLast.begin(), ofLast.end());
    tensor.shape[0] += (isAppended ? 1 : 0) + (isPrepended ? 1 : 0);
  }
  std::vector<float>& azimuths = tensors.at("phi_i").values;
  if (isAppended) azimuths.back() = static_cast<float>(first + kTurn);
  if (isPrepended) azimuths.front() = static_cast<float>(last - kTurn);
}

// Sets what part of a turn the azimuths cover: all, a half between multiples of π, or a quarter between multiples of
// π/2. The rest are mirror images. They may stop one step before the part ends: a turn is closed then; in
// parts, the last azimuth stands for that step.
void SetSymmetry(Tensors& tensors, MeasuredData& data) {
  data.isIsotropic = data.phi.size() <= 2;
  if (data.isIsotropic) return;
  const auto first = static_cast<double>(data.phi.front()), last = static_cast<double>(data.phi.back());
  const double step = (last - first) / static_cast<double>(data.phi.size() - 1);
  for (const int symmetry : {4, 2, 1}) {
    const double part = kTurn / symmetry, missing = part - (last - first), start = first / part;
    const bool isAligned = symmetry == 1 || std::abs(start - std::round(start)) * part <= kRoundingOfAngles;
    if (!isAligned || missing < -kRoundingOfAngles || missing > step + kRoundingOfAngles) continue;
    data.symmetry = symmetry;
    data.partX = std::cos(first + 0.5 * part) < 0 ? -1.0f : 1.0f;
    data.partY = std::sin(first + 0.5 * part) < 0 ? -1.0f : 1.0f;
    if (symmetry > 1 || missing <= kRoundingOfAngles) return;
    CloseTurn(tensors);
    data.phi = tensors.at("phi_i").values;
    return;
  }
  throw Error(
      "its azimuths run from " + std::to_string(first) + " to " + std::to_string(last) +
      ", and not through a turn, a half of one between multiples of pi, or a quarter between multiples of pi/2");
}

}  // namespace

MeasuredData ParseMeasured(std::span<const std::byte> bytes) {
  Tensors tensors = TensorReader(bytes).Read();
  constexpr double kPiExact = 3.14159265358979323846;
  MeasuredData data;
  data.theta = AscendingAngles(tensors, "theta_i", 0, 0.5 * kPiExact);
  data.phi = AscendingAngles(tensors, "phi_i", -kPiExact, kPiExact);
  SetSymmetry(tensors, data);
  data.normals = TableOf(tensors, "ndf", data);
  data.projected = TableOf(tensors, "sigma", data);
  data.visible = WarpOf(tensors, "vndf", data);
  data.luminance = WarpOf(tensors, "luminance", data);
  data.reflectance = ReflectanceOf(tensors, data);
  return data;
}

MeasuredData ReadMeasured(const std::filesystem::path& file, const FileLocation& where) {
  try {
    return ParseMeasured(MappedFile(file).Bytes());
  } catch (const Error& error) {
    throw Error(where, "\"" + file.string() + "\" cannot be used as a measured material: " + error.Text());
  }
}

}  // namespace lampyr
