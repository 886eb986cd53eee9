// The only file that includes cpp-httplib, whose header is heavy.
#include "app/desk/http_server.h"

#include <httplib.h>
#include <sys/random.h>

#include <array>

#include "base/error.h"

namespace lampyr {

namespace {

std::string MakeToken() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error("the system gives no random numbers");
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

// Comparison in constant time: it does not reveal the length of the equal part.
bool IsEqual(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

}  // namespace

struct HttpServer::Server {
  httplib::Server http;
  int port = 0;
  std::string token = MakeToken();
  std::function<HttpReply(const HttpRequest&)> answer;

  bool IsOurs(const std::string& place) const {
    return place == "127.0.0.1:" + std::to_string(port) || place == "localhost:" + std::to_string(port);
  }
  int Refusal(const httplib::Request& request) const {
    constexpr int kForbidden = 403, kNotFound = 404, kWrongMethod = 405;
    if (request.get_header_value_count("Host") != 1 || !IsOurs(request.get_header_value("Host"))) return kForbidden;
    if (request.has_header("Origin")) {
      const std::string origin = request.get_header_value("Origin"), scheme = "http://";
      if (!origin.starts_with(scheme) || !IsOurs(origin.substr(scheme.size()))) return kForbidden;
    }
    if (request.path.size() < token.size() + 2 || request.path[0] != '/' || request.path[token.size() + 1] != '/' ||
        !IsEqual(request.path.substr(1, token.size()), token))
      return kNotFound;
    return request.method == "GET" || request.method == "POST" ? 0 : kWrongMethod;
  }
  void Answer(const httplib::Request& request, httplib::Response& response) const {
    response.set_header("Cache-Control", "no-store");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Content-Security-Policy",
                        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' "
                        "data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    HttpReply reply = answer({request.method, request.path.substr(token.size() + 2), request.body});
    response.status = reply.status;
    if (!reply.header.empty()) response.set_header("X-Lampyr", reply.header);
    response.set_header("Content-Type", reply.type);
    response.body = std::move(reply.body);
  }
};

HttpServer::HttpServer(int port, std::function<HttpReply(const HttpRequest&)> answer)
    : server_(std::make_unique<Server>()) {
  Server& server = *server_;
  server.answer = std::move(answer);
  constexpr size_t kLongestBody = size_t{1} << 20;
  server.http.set_payload_max_length(kLongestBody);
  server.http.set_tcp_nodelay(true);
  constexpr size_t kManyRequests = 1000000;
  server.http.set_keep_alive_max_count(kManyRequests);
  // Idle connections must not delay the end, nor other connections for long.
  server.http.set_keep_alive_timeout(1);
  server.http.set_read_timeout(1);
  // Not SO_REUSEPORT, with which others could share the port.
  server.http.set_socket_options([](int socket) {
    const int yes = 1;
    (void)setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  // Requests without the token are refused before their bodies are read.
  server.http.set_pre_routing_handler([&server](const httplib::Request& request, httplib::Response& response) {
    const int refusal = server.Refusal(request);
    if (refusal == 0) return httplib::Server::HandlerResponse::Unhandled;
    response.status = refusal;
    response.set_header("Connection", "close");
    return httplib::Server::HandlerResponse::Handled;
  });
  const auto respond = [&server](const httplib::Request& request, httplib::Response& response) {
    server.Answer(request, response);
  };
  server.http.Get(".*", respond);
  server.http.Post(".*", respond);
  server.port =
      port == 0 ? server.http.bind_to_any_port("127.0.0.1") : (server.http.bind_to_port("127.0.0.1", port) ? port : -1);
  if (server.port <= 0)
    throw Error("port " + std::to_string(port) +
                " of 127.0.0.1 cannot be used: another program has it, or it is reserved");
}

HttpServer::~HttpServer() {
  Stop();
}

std::string HttpServer::Address() const {
  return "http://127.0.0.1:" + std::to_string(server_->port) + "/" + server_->token + "/";
}

void HttpServer::Serve() {
  server_->http.listen_after_bind();
}

void HttpServer::Stop() {
  server_->http.stop();
}

}  // namespace lampyr
