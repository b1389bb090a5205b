// Serves a page over HTTP to browsers on this machine.
#pragma once

#include <cstdint>

#include "report/live_page.hpp"

namespace grit {

/// A socket that listens on 127.0.0.1 only.
class Listener {
 public:
  /// Port 0 selects a free port. Throws UsageError if the port is in use or not allowed.
  explicit Listener(std::uint16_t port);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  int socket() const { return socket_; }
  std::uint16_t port() const { return port_; }

 private:
  int socket_;
  std::uint16_t port_;
};

/// Serves the page at `/` until `control` is closed at its other end, which sends lines of progress. Readers then get
/// the last state, for which the server waits a few seconds. Reads the folder only while the page is open in a browser,
/// for at most a tenth of the time. Answers only GET requests whose Host is this machine, which prevents DNS rebinding.
/// Takes ownership of both sockets.
void serve_page(int listening_socket, int control, LivePage& page);

}  // namespace grit
