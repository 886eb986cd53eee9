#include "app/tev_display.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "base/error.h"
#include "film/mix.h"

namespace lampyr {

namespace {

static_assert(std::endian::native == std::endian::little);

enum class TevPacketKind : uint8_t { CreateImage = 4, UpdateImage = 6 };

class TevPacket {
 public:
  TevPacket(TevPacketKind kind, const std::string& name) {
    constexpr bool isBroughtToFront = false;
    Add(uint32_t{0});  // the length
    Add(static_cast<uint8_t>(kind));
    Add(static_cast<uint8_t>(isBroughtToFront));
    Add(name);
  }
  template <class Number>
  void Add(Number number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void Add(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  void Add(const float* values, size_t count) {
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(float));
  }
  std::string Finished() && {
    const auto length = static_cast<uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

// The channels of the picture and of layers of light.
std::vector<size_t> ShownChannels(const Image& image) {
  std::vector<size_t> channels;
  const auto add = [&](const std::string& prefix) {
    for (const char* channel : {"R", "G", "B"})
      channels.push_back(static_cast<size_t>(image.ChannelIndex(prefix + channel)));
  };
  add("");
  for (const std::string& layer : ColorLayers(image)) add(layer + ".");
  return channels;
}

constexpr double kInterval = 1;  // seconds between pictures
constexpr int kPatience = 3000;  // milliseconds in which a viewer has to accept data
constexpr size_t kLargestPacket = 1 << 26;

void WaitUntilWritable(int socket) {
  pollfd waits{socket, POLLOUT, 0};
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatience);
  int ready = 0;
  do {  // repeated after a signal
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    ready = poll(&waits, 1, std::max(static_cast<int>(left.count()), 0));
  } while (ready < 0 && errno == EINTR);
  if (ready <= 0) throw Error("it takes nothing");
}

// Throws an Error without a location.
int ConnectTo(const addrinfo& address) {
  const int made = socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol);
  if (made < 0) throw Error(std::strerror(errno));
  try {
    if (connect(made, address.ai_addr, address.ai_addrlen) != 0) {
      if (errno != EINPROGRESS) throw Error(std::strerror(errno));
      WaitUntilWritable(made);
      int failure = 0;
      socklen_t size = sizeof failure;
      if (getsockopt(made, SOL_SOCKET, SO_ERROR, &failure, &size) != 0 || failure != 0)
        throw Error(std::strerror(failure));
    }
  } catch (...) {
    close(made);
    throw;
  }
  return made;
}

}  // namespace

std::string TevCreateImage(const std::string& name, const Image& image, const std::vector<size_t>& channels) {
  TevPacket packet(TevPacketKind::CreateImage, name);
  packet.Add(static_cast<int32_t>(image.width));
  packet.Add(static_cast<int32_t>(image.height));
  packet.Add(static_cast<int32_t>(channels.size()));
  for (const size_t channel : channels) packet.Add(image.channels[channel]);
  return std::move(packet).Finished();
}

std::string TevUpdateImage(const std::string& name, const Image& image, const std::vector<size_t>& channels, int first,
                           int end) {
  TevPacket packet(TevPacketKind::UpdateImage, name);
  packet.Add(static_cast<int32_t>(channels.size()));
  for (const size_t channel : channels) packet.Add(image.channels[channel]);
  for (const int32_t number : {0, first, image.width, end - first}) packet.Add(number);
  const size_t stride = image.channels.size();
  for (const size_t channel : channels) packet.Add(static_cast<int64_t>(channel));
  for (size_t i = 0; i < channels.size(); ++i) packet.Add(static_cast<int64_t>(stride));
  const size_t row = stride * static_cast<size_t>(image.width);
  // Up to the last value used.
  const size_t count =
      row * static_cast<size_t>(end - first) - stride + *std::max_element(channels.begin(), channels.end()) + 1;
  packet.Add(image.data.data() + row * static_cast<size_t>(first), count);
  return std::move(packet).Finished();
}

TevDisplay::TevDisplay(NetworkPlace place, std::string name) : place_(std::move(place)), name_(std::move(name)) {}

TevDisplay::~TevDisplay() {
  if (socket_ >= 0) close(socket_);
}

void TevDisplay::Connect() {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int failure = getaddrinfo(place_.host.c_str(), place_.port.c_str(), &hints, &found); failure != 0)
    throw Error(gai_strerror(failure));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, freeaddrinfo);
  for (const addrinfo* each = found; each; each = each->ai_next) {
    try {
      socket_ = ConnectTo(*each);
      return;
    } catch (const Error&) {
      if (!each->ai_next) throw;
    }
  }
}

void TevDisplay::Send(const std::string& packet) const {
  for (size_t sent = 0; sent < packet.size();) {
    const ssize_t count = send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (count >= 0) {
      sent += static_cast<size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      WaitUntilWritable(socket_);
    } else if (errno != EINTR) {
      throw Error(std::strerror(errno));
    }
  }
}

void TevDisplay::SendImage(const Image& image) {
  const std::vector<size_t> channels = ShownChannels(image);
  if (!std::exchange(hasCreated_, true)) Send(TevCreateImage(name_, image, channels));
  const size_t row = image.channels.size() * static_cast<size_t>(image.width) * sizeof(float);
  const int rows = static_cast<int>(std::max<size_t>(kLargestPacket / row, 1));
  for (int first = 0; first < image.height; first += rows)
    Send(TevUpdateImage(name_, image, channels, first, std::min(first + rows, image.height)));
}

void TevDisplay::Show(const Film& film, Progress& progress) {
  if (hasGivenUp_) return;
  try {
    if (socket_ < 0) Connect();
    SendImage(film.Develop());
  } catch (const Error& error) {
    hasGivenUp_ = true;
    progress.Clear();
    std::fprintf(stderr, "warning: --display: the viewer at %s:%s cannot be reached: %s; the render goes on\n",
                 place_.host.c_str(), place_.port.c_str(), error.Text().c_str());
  }
}

void TevDisplay::MayShow(const ProgressiveRender& render, double secondsSoFar, Progress& progress) {
  if (secondsSoFar < next_) return;
  next_ = secondsSoFar + kInterval;
  Show(render.Picture(), progress);
}

}  // namespace lampyr
