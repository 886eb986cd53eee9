// OpenEXR files: all channels of a flat scan-line or tiled image as float (of the first part if there are several),
// data and display window, and string attributes as metadata. The only file that includes OpenEXR.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>

#include "base/error.h"
#include "film/atomic_file.h"
#include "film/image.h"
#include "film/image_formats.h"

namespace lampyr {

namespace {

// Lets OpenEXR write through AtomicFile. OpenEXR's destructor swallows exceptions; AtomicFile::Commit reports them.
class AtomicStream : public Imf::OStream {
 public:
  AtomicStream(AtomicFile& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}
  void write(const char bytes[], int count) override { file_.Write(bytes, static_cast<size_t>(count)); }
  uint64_t tellp() override { return file_.Position(); }
  void seekp(uint64_t position) override { file_.Seek(position); }

 private:
  AtomicFile& file_;
};

int BytesOf(Imf::PixelType type) {
  return type == Imf::HALF ? 2 : 4;
}

// Names of all channels, ordered by ChannelOrder. Throws an Error for subsampled channels.
std::vector<std::string> ListChannels(const std::filesystem::path& path, const Imf::Header& header,
                                      int& bytesPerPixel) {
  std::vector<std::string> names;
  bytesPerPixel = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    if (i.channel().xSampling != 1 || i.channel().ySampling != 1) {
      throw Error("cannot read image \"" + path.string() + "\": channel \"" + i.name() +
                  "\" is stored at a lower resolution, which is not supported");
    }
    names.emplace_back(i.name());
    bytesPerPixel += BytesOf(i.channel().type);
  }
  std::vector<std::string> ordered;
  for (const size_t i : ChannelOrder(names)) ordered.push_back(names[i]);
  return ordered;
}

Image ReadOpenExr(const std::filesystem::path& path) {
  Imf::InputFile file(path.c_str(), 1);
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow(), display = header.displayWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  int bytesPerPixel = 0;
  std::vector<std::string> channels = ListChannels(path, header, bytesPerPixel);
  CheckImageSize(path, width, height, static_cast<int64_t>(channels.size()), bytesPerPixel);

  Image image(static_cast<int>(width), static_cast<int>(height), std::move(channels));
  image.offsetX = static_cast<int>(int64_t{window.min.x} - display.min.x);
  image.offsetY = static_cast<int>(int64_t{window.min.y} - display.min.y);
  image.fullWidth = static_cast<int>(int64_t{display.max.x} - display.min.x + 1);
  image.fullHeight = static_cast<int>(int64_t{display.max.y} - display.min.y + 1);
  for (auto i = header.begin(); i != header.end(); ++i) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute());
    if (text) image.metadata[i.name()] = text->value();
  }

  if (Imf::hasChromaticities(header)) {
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    image.chromaticities.emplace();
    const Imath::V2f all[] = {c.red, c.green, c.blue, c.white};
    for (size_t i = 0; i < 4; ++i) {
      (*image.chromaticities)[2 * i] = static_cast<double>(all[i].x);
      (*image.chromaticities)[2 * i + 1] = static_cast<double>(all[i].y);
    }
  }

  Imf::FrameBuffer frame;
  const size_t xStride = image.channels.size() * sizeof(float);
  for (size_t c = 0; c < image.channels.size(); ++c) {
    frame.insert(image.channels[c], Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, window, xStride,
                                                     xStride * static_cast<size_t>(image.width)));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

// True for layers that half cannot represent: the identifiers of mattes are bit patterns, and squares soon fall below
// the smallest half, 6e-8.
bool NeedsFloat(const std::string& channel) {
  for (const char* part : {"Crypto", "variance.", "relativeError", "bias.", "feature."}) {
    if (channel.find(part) != std::string::npos) return true;
  }
  return false;
}

// The types of the channels, the same for all channels of a layer.
std::vector<Imf::PixelType> TypesOf(const Image& image, ExrPrecision precision) {
  std::vector<Imf::PixelType> types(image.channels.size(), Imf::FLOAT);
  if (precision == ExrPrecision::Float) return types;
  constexpr float largestHalf = 65504;
  std::map<std::string, bool> fits;  // by layer
  const auto layerOf = [&](size_t c) { return image.channels[c].substr(0, image.channels[c].rfind('.') + 1); };
  for (size_t c = 0; c < types.size(); ++c) {
    bool& all = fits.try_emplace(layerOf(c), !NeedsFloat(image.channels[c])).first->second;
    for (size_t i = c; all && i < image.data.size(); i += types.size())
      all = !std::isfinite(image.data[i]) || std::abs(image.data[i]) <= largestHalf;
  }
  for (size_t c = 0; c < types.size(); ++c) {
    if (fits[layerOf(c)] && !NeedsFloat(image.channels[c])) types[c] = Imf::HALF;
  }
  return types;
}

Imf::Header MakeHeader(const Image& image, const std::vector<Imf::PixelType>& types) {
  const int fullWidth = image.fullWidth > 0 ? image.fullWidth : image.offsetX + image.width;
  const int fullHeight = image.fullHeight > 0 ? image.fullHeight : image.offsetY + image.height;
  const Imath::Box2i display({0, 0}, {fullWidth - 1, fullHeight - 1});
  const Imath::Box2i window({image.offsetX, image.offsetY},
                            {image.offsetX + image.width - 1, image.offsetY + image.height - 1});
  Imf::Header header(display, window);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (size_t c = 0; c < types.size(); ++c) header.channels().insert(image.channels[c], Imf::Channel(types[c]));
  for (const auto& [key, value] : image.metadata) {
    if (header.find(key) == header.end()) header.insert(key, Imf::StringAttribute(value));
  }
  return header;
}

void WriteOpenExr(Imf::OStream& stream, const Image& image, ExrPrecision precision) {
  const std::vector<Imf::PixelType> types = TypesOf(image, precision);
  const size_t count = types.size();
  std::vector<half> halves(precision == ExrPrecision::Half ? image.data.size() : 0);
  for (size_t i = 0; i < halves.size(); ++i) {
    if (types[i % count] == Imf::HALF) halves[i] = half(image.data[i]);
  }
  const Imf::Header header = MakeHeader(image, types);
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < count; ++c) {
    const bool asHalf = types[c] == Imf::HALF;
    const char* first = asHalf ? reinterpret_cast<const char*>(halves.data() + c)
                               : reinterpret_cast<const char*>(image.data.data() + c);
    const size_t xStride = static_cast<size_t>(BytesOf(types[c])) * count;
    frame.insert(image.channels[c], Imf::Slice::Make(types[c], first, header.dataWindow(), xStride,
                                                     xStride * static_cast<size_t>(image.width)));
  }
  Imf::OutputFile file(stream, header, 1);
  file.setFrameBuffer(frame);
  file.writePixels(image.height);
}

}  // namespace

Image ReadExr(const std::filesystem::path& path) {
  CheckExrHeader(path);
  try {
    return ReadOpenExr(path);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error("cannot read image \"" + path.string() + "\": there is not enough memory for it");
  } catch (const std::exception& e) {
    throw Error("cannot read image \"" + path.string() + "\": " + e.what());
  }
}

void WriteExr(const std::filesystem::path& path, const Image& image, ExrPrecision precision,
              const std::function<void(AtomicFile&)>& append) {
  if (image.width <= 0 || image.height <= 0 || image.channels.empty()) {
    throw Error("cannot write \"" + path.string() + "\": the image has no pixels");
  }
  AtomicFile file(path);
  try {
    AtomicStream stream(file, path.string());
    WriteOpenExr(stream, image, precision);
    if (append) {
      file.ThrowIfFailed();
      file.SeekToEnd();
      append(file);
    }
  } catch (const std::bad_alloc&) {
    throw Error("cannot write \"" + path.string() + "\": there is not enough memory for it");
  } catch (const std::exception& e) {
    file.ThrowIfFailed();  // the system's reason is better than OpenEXR's
    throw Error("cannot write \"" + path.string() + "\": " + e.what());
  }
  file.Commit();
}

}  // namespace lampyr
