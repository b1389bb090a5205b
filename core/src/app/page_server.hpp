// A page over HTTP, for browsers on this machine.
#pragma once

#include <cstdint>

#include "report/live_page.hpp"

namespace grit {

/// A socket that listens on 127.0.0.1 alone.
class Listener {
 public:
  /// 0: a port that is free. Throws UsageError where it is taken or not allowed.
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

/// Serves the page at `/` until `control` is closed at its other end, from where lines come that say how far the run
/// is. Then readers get the last state, for which it waits a few seconds. Reads the folder only while somebody looks,
/// at most a tenth of the time. Answers GET alone, and only where the request names this machine as its host: pages of
/// others that had a name of theirs point here learn nothing. Takes both sockets.
void serve_page(int listening_socket, int control, LivePage& page);

}  // namespace grit
