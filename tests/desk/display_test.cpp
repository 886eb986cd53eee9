// --display: a viewer that is there receives the picture as tev's protocol has it; without one the render goes on.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "film/image.h"
#include "support/lampyr_process.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

// A viewer that keeps what it is sent.
class Viewer {
 public:
  // `most`: bytes after which it goes away.
  explicit Viewer(size_t most = ~size_t{0}) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
    EXPECT_EQ(listen(listener_, 1), 0);
    getsockname(listener_, reinterpret_cast<sockaddr*>(&place), &size);
    port_ = ntohs(place.sin_port);
    thread_ = std::thread([this, most] {
      const int connection = accept(listener_, nullptr, nullptr);
      char buffer[65536];
      for (ssize_t n; received_.size() < most && (n = recv(connection, buffer, sizeof buffer, 0)) > 0;)
        received_.append(buffer, static_cast<size_t>(n));
      close(connection);
    });
  }
  ~Viewer() {
    if (thread_.joinable()) Received();
    close(listener_);
  }
  std::string Place() const { return "127.0.0.1:" + std::to_string(port_); }
  // Once the other side has closed the connection.
  const std::string& Received() {
    shutdown(listener_, SHUT_RD);
    if (thread_.joinable()) thread_.join();
    return received_;
  }

 private:
  int listener_ = -1, port_ = 0;
  std::string received_;
  std::thread thread_;
};

class PacketReader {
 public:
  explicit PacketReader(const std::string& bytes) : bytes_(bytes) {}
  bool HasMore() const { return at_ < bytes_.size(); }
  template <class Number>
  Number Read() {
    Number number{};
    EXPECT_LE(at_ + sizeof number, bytes_.size());
    std::memcpy(&number, bytes_.data() + at_, sizeof number);
    at_ += sizeof number;
    return number;
  }
  std::string ReadString() {
    const std::string text = bytes_.c_str() + at_;
    at_ += text.size() + 1;
    return text;
  }
  size_t At() const { return at_; }
  void Skip(size_t to) { at_ = to; }

 private:
  const std::string& bytes_;
  size_t at_ = 0;
};

struct Shown {
  std::string name;
  int width = 0, height = 0, updates = 0;
  std::vector<std::string> channels;
  std::map<std::string, std::vector<float>> values;
};

Shown Decode(const std::string& bytes) {
  Shown shown;
  PacketReader reader(bytes);
  while (reader.HasMore()) {
    const size_t begin = reader.At(), length = reader.Read<uint32_t>();
    const auto kind = reader.Read<uint8_t>();
    reader.Read<uint8_t>();
    const std::string name = reader.ReadString();
    if (kind == 4) {
      shown.name = name;
      shown.width = reader.Read<int32_t>();
      shown.height = reader.Read<int32_t>();
      const auto count = reader.Read<int32_t>();
      for (int i = 0; i < count; ++i) shown.channels.push_back(reader.ReadString());
    } else {
      EXPECT_EQ(kind, 6);
      EXPECT_EQ(name, shown.name);
      const auto count = static_cast<size_t>(reader.Read<int32_t>());
      std::vector<std::string> channels;
      for (size_t i = 0; i < count; ++i) channels.push_back(reader.ReadString());
      EXPECT_EQ(channels, shown.channels);
      const auto x = reader.Read<int32_t>(), y = reader.Read<int32_t>(), width = reader.Read<int32_t>(),
                 height = reader.Read<int32_t>();
      EXPECT_EQ(x, 0);
      EXPECT_EQ(width, shown.width);
      EXPECT_LE(y + height, shown.height);
      std::vector<int64_t> offsets, strides;
      for (size_t i = 0; i < count; ++i) offsets.push_back(reader.Read<int64_t>());
      for (size_t i = 0; i < count; ++i) strides.push_back(reader.Read<int64_t>());
      const size_t data = reader.At(), pixels = static_cast<size_t>(width * height);
      for (size_t c = 0; c < count; ++c) {
        std::vector<float>& plane = shown.values[channels[c]];
        plane.resize(static_cast<size_t>(shown.width * shown.height));
        for (size_t i = 0; i < pixels; ++i) {
          const size_t at = data + 4 * static_cast<size_t>(offsets[c] + static_cast<int64_t>(i) * strides[c]);
          EXPECT_LE(at + 4, begin + length);
          std::memcpy(&plane[static_cast<size_t>(y * width) + i], bytes.data() + at, 4);
        }
      }
      ++shown.updates;
    }
    EXPECT_LE(reader.At(), begin + length);
    reader.Skip(begin + length);
  }
  return shown;
}

class Display : public testing::Test {
 protected:
  void SetUp() override {
    WriteBytes(folder_ / "scene.pbrt", R"(LookAt 0 1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 20
WorldBegin
LightSource "point" "rgb I" [4 4 4] "point3 from" [0 2 1] "string lightGroup" "key"
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
)");
  }
  Outcome Render(const std::string& options) {
    return RunLampyr(folder_.Path(), "render scene.pbrt -o out.exr " + options);
  }
  TemporaryFolder folder_;
};

TEST_F(Display, ShowsThePictureAndItsLayersOfLight) {
  Viewer viewer;
  const Outcome outcome = Render("--time 2.5s --display " + viewer.Place());
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  EXPECT_EQ(outcome.output.find("warning"), std::string::npos) << outcome.output;
  const Shown shown = Decode(viewer.Received());
  EXPECT_EQ(shown.name, "out.exr");
  EXPECT_EQ(shown.width, 32);
  EXPECT_EQ(shown.height, 20);
  EXPECT_EQ(shown.channels,
            (std::vector<std::string>{"R", "G", "B", "key.R", "key.G", "key.B", "rest.R", "rest.G", "rest.B"}));
  EXPECT_GE(shown.updates, 2);
  EXPECT_LE(shown.updates, 5);
  const Image image = ReadImage(folder_ / "out.exr");
  for (const std::string& channel : shown.channels) {
    const auto index = static_cast<size_t>(image.ChannelIndex(channel));
    const std::vector<float>& plane = shown.values.at(channel);
    for (size_t i = 0; i < plane.size(); ++i) ASSERT_EQ(plane[i], image.data[i * image.channels.size() + index]);
  }
}

TEST_F(Display, TheRenderGoesOnWithoutAViewer) {
  ASSERT_EQ(Render("--spp 4 --quiet").exitCode, 0);
  const Image alone = ReadImage(folder_ / "out.exr");
  int unused = 0;
  {
    const Viewer gone;
    unused = std::stoi(gone.Place().substr(gone.Place().find(':') + 1));
  }
  const Outcome outcome = Render("--spp 4 --display 127.0.0.1:" + std::to_string(unused));
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  const size_t warning = outcome.output.find("warning: --display: the viewer at");
  EXPECT_NE(warning, std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("warning", warning + 1), std::string::npos) << outcome.output;
  EXPECT_EQ(ReadImage(folder_ / "out.exr").data, alone.data);
}

TEST_F(Display, TheRenderGoesOnWhenTheViewerGoesAway) {
  Viewer viewer(1);
  const Outcome outcome = Render("--time 3s --display " + viewer.Place());
  EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
  const size_t warning = outcome.output.find("warning: --display");
  EXPECT_NE(warning, std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("warning", warning + 1), std::string::npos) << outcome.output;
}

TEST_F(Display, WrongPlacesAreTold) {
  for (const char* place : {"localhost", ":14158", "localhost:", "localhost:0", "localhost:99999", "localhost:x"}) {
    const Outcome outcome = Render(std::string("--display ") + place);
    EXPECT_EQ(outcome.exitCode, 2) << place;
    EXPECT_NE(outcome.output.find("is no host and port; write 127.0.0.1:14158"), std::string::npos) << outcome.output;
  }
}

}  // namespace
}  // namespace lampyr::test
