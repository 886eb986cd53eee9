// Displays the picture of a running render in a viewer that supports tev's protocol (https://github.com/Tom94/tev).
//
// A packet is its length in bytes (uint32, itself included), its kind (uint8) and the data of that kind; strings end
// with a zero byte, numbers are little-endian.
#pragma once

#include <string>
#include <vector>

#include "app/network_place.h"
#include "base/progress.h"
#include "film/image.h"
#include "render/progressive_render.h"

namespace lampyr {

class TevDisplay {
 public:
  // `name`: of the image in the viewer. Nothing is sent yet.
  TevDisplay(NetworkPlace place, std::string name);
  ~TevDisplay();
  TevDisplay(const TevDisplay&) = delete;
  TevDisplay& operator=(const TevDisplay&) = delete;

  // To be called after passes: sends the picture so far, with its layers of light, if a second has passed since the
  // last. If the viewer is absent, disconnects or accepts no data for some seconds, warns once and sends no more.
  void MayShow(const ProgressiveRender& render, double secondsSoFar, Progress& progress);
  // Sends the picture in any case.
  void Show(const Film& film, Progress& progress);

 private:
  void Connect();
  void Send(const std::string& packet) const;
  void SendImage(const Image& image);

  const NetworkPlace place_;
  const std::string name_;
  double next_ = 0;
  int socket_ = -1;
  bool hasGivenUp_ = false, hasCreated_ = false;
};

// Packets: an image without content, and rows [first, end) of it. `channels`: indices into the image's.
std::string TevCreateImage(const std::string& name, const Image& image, const std::vector<size_t>& channels);
std::string TevUpdateImage(const std::string& name, const Image& image, const std::vector<size_t>& channels, int first,
                           int end);

}  // namespace lampyr
