// `lampyr desk` in the background, and requests to it as a browser would make them, or would not.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "support/lampyr_process.h"

namespace lampyr::test {

struct DeskReply {
  int status = 0;
  std::string headers, body;
};

class DeskProcess {
 public:
  using Json = nlohmann::json;

  // Starts it in the folder and waits until it says where it is.
  DeskProcess(const std::filesystem::path& folder, const std::string& arguments) {
    const std::string command = "cd '" + folder.string() + "' && exec '" LAMPYR_BINARY "' desk " + arguments;
    int ends[2];
    if (pipe(ends) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      for (const int ignored : {SIGINT, SIGHUP, SIGTERM}) signal(ignored, SIG_DFL);
      dup2(ends[1], STDOUT_FILENO);
      close(ends[0]);
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(99);
    }
    close(ends[1]);
    char c = 0;
    while (read(ends[0], &c, 1) == 1 && c != '\n') address_ += c;
    close(ends[0]);
    const std::string start = "http://127.0.0.1:";
    if (!address_.starts_with(start)) return;
    port_ = std::atoi(address_.c_str() + start.size());
    token_ = address_.substr(address_.find('/', start.size()) + 1);
    token_.pop_back();
  }
  ~DeskProcess() {
    if (process_ > 0) End(SIGKILL);
  }
  DeskProcess(const DeskProcess&) = delete;
  DeskProcess& operator=(const DeskProcess&) = delete;

  const std::string& Address() const { return address_; }
  int Port() const { return port_; }
  const std::string& Token() const { return token_; }
  pid_t Id() const { return process_; }

  // Sends the signal and waits for the end, two minutes at most. The exit code, as of Outcome.
  int End(int signal) {
    kill(process_, signal);
    int status = 0;
    constexpr int kMost = 12000;
    for (int i = 0; waitpid(process_, &status, WNOHANG) == 0; ++i) {
      usleep(10000);
      if (i == kMost) kill(process_, SIGKILL);
    }
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  // The bytes as they are.
  DeskReply Send(const std::string& request) const {
    const int connection = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<uint16_t>(port_));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string all;
    if (connect(connection, reinterpret_cast<sockaddr*>(&place), sizeof place) == 0) {
      (void)send(connection, request.data(), request.size(), MSG_NOSIGNAL);
      char buffer[65536];
      for (ssize_t n; (n = recv(connection, buffer, sizeof buffer, 0)) > 0;) all.append(buffer, static_cast<size_t>(n));
    }
    close(connection);
    DeskReply reply;
    const size_t end = all.find("\r\n\r\n");
    if (end == std::string::npos) return reply;
    reply.status = std::atoi(all.c_str() + all.find(' '));
    reply.headers = all.substr(0, end);
    reply.body = all.substr(end + 4);
    return reply;
  }
  DeskReply Send(const std::string& method, const std::string& path, const std::string& body = "",
                 const std::string& headers = "", const std::string& host = "") const {
    std::string request = method + " " + path + " HTTP/1.1\r\nConnection: close\r\nHost: " +
                          (host.empty() ? "127.0.0.1:" + std::to_string(port_) : host) + "\r\n" + headers;
    if (method == "POST") request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    return Send(request + "\r\n" + body);
  }

  Json Get(const std::string& path) const {
    const DeskReply reply = Send("GET", "/" + token_ + "/" + path);
    EXPECT_EQ(reply.status, 200) << path << ": " << reply.body;
    return Json::parse(reply.body, nullptr, false);
  }
  DeskReply Post(const std::string& path, const Json& body) const {
    return Send("POST", "/" + token_ + "/" + path, body.dump(), "Content-Type: application/json\r\n");
  }
  Json PostJson(const std::string& path, const Json& body) const {
    const DeskReply reply = Post(path, body);
    EXPECT_EQ(reply.status, 200) << path << ": " << reply.body;
    return Json::parse(reply.body, nullptr, false);
  }

  // With --spp: until the render rests.
  void WaitUntilDone() const {
    constexpr int kMost = 2000;
    for (int i = 0; i < kMost && !Get("state").at("isDone").get<bool>(); ++i) usleep(30000);
  }
  // Index of the light or filter that is written there: "scene.pbrt:8".
  size_t StatementAt(const std::string& place) const {
    const Json lights = Get("lights");
    for (const Json& statement : lights.at("statements")) {
      if (statement.at("place") == place) return statement.at("statement").get<size_t>();
    }
    ADD_FAILURE() << "no statement at " << place;
    return 0;
  }
  Json Parameter(size_t statement, const std::string& name) const {
    const Json lights = Get("lights");
    for (const Json& parameter : lights.at("statements").at(statement).at("parameters")) {
      if (parameter.at("name") == name) return parameter;
    }
    return {};
  }
  Json Edit(size_t statement, const std::string& parameter, const std::vector<double>& numbers) const {
    return PostJson("edit", {{"statement", statement}, {"parameter", parameter}, {"numbers", numbers}});
  }
  // A factor of 1 of each fader.
  Json Neutral() const {
    Json factors = Json::array();
    for (size_t i = 0; i < Get("lights").at("faders").size(); ++i) factors.push_back({1, 1, 1});
    return factors;
  }

 private:
  pid_t process_ = -1;
  std::string address_, token_;
  int port_ = 0;
};

}  // namespace lampyr::test
