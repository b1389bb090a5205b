#include "app/page_server.hpp"

// Debian 12's Boost expects clang's coroutines in their pre-standard header.
#define BOOST_ASIO_HAS_CO_AWAIT 1

#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <chrono>
#include <ctime>
#include <map>
#include <string_view>
#include <vector>

#include "app/command.hpp"

namespace grit {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Steady = std::chrono::steady_clock;
using Response = http::response<http::string_body>;
using namespace std::chrono_literals;

constexpr std::size_t max_sessions = 64, max_header_bytes = 16 << 10;
// The end of a run waits no longer than this for the server, however long reading the folder takes.
constexpr unsigned shutdown_limit_s = 20;
constexpr auto answer_within = 25s, first_request_within = 10s, reader_gone_after = 60s, last_answer_within = 8s;

auto into(error_code& error) { return asio::redirect_error(asio::use_awaitable, error); }

/// A host such as "127.0.0.1:8000" without its port.
std::string_view host_name(std::string_view host) {
  const auto colon = host.rfind(':');
  return colon == std::string_view::npos || host.ends_with(']') ? host : host.substr(0, colon);
}

bool is_this_machine(std::string_view host) {
  static constexpr std::array<std::string_view, 3> names{"127.0.0.1", "localhost", "[::1]"};
  return std::ranges::find(names, host_name(host)) != names.end();
}

/// The value of "name=value" in "path?a=1&b=2"; empty if missing.
std::string_view parameter(std::string_view target, std::string_view name) {
  for (auto at = target.find('?'); at != std::string_view::npos; at = target.find('&', at + 1)) {
    const auto rest = target.substr(at + 1);
    if (rest.starts_with(name) && rest.substr(name.size()).starts_with('='))
      return rest.substr(name.size() + 1, rest.find('&') - name.size() - 1);
  }
  return {};
}

class PageServer {
 public:
  PageServer(int listening_socket, int control, LivePage& page)
      : acceptor_(io_, tcp::v4(), listening_socket),
        control_(io_, asio::local::stream_protocol(), control),
        page_(page) {}

  void operator()() {
    for (auto work : {&PageServer::accept, &PageServer::listen_to_run, &PageServer::refresh_regularly})
      asio::co_spawn(io_, (this->*work)(), asio::detached);
    io_.run();
  }

 private:
  asio::awaitable<void> accept() {
    for (;;) {
      error_code error;
      tcp::socket socket = co_await acceptor_.async_accept(into(error));
      if (error) continue;
      bool has_room = sessions_ < max_sessions;
      if (!has_room && !idle_.empty()) {  // a connection that asks for nothing makes room
        idle_.front()->cancel();
        idle_.erase(idle_.begin());
        has_room = true;
      }
      if (has_room) asio::co_spawn(io_, session(std::move(socket)), asio::detached);
    }
  }

  asio::awaitable<void> listen_to_run() {
    asio::streambuf lines;
    for (;;) {
      error_code error;
      const std::size_t length = co_await asio::async_read_until(control_, lines, '\n', into(error));
      if (error) break;
      progress_.assign(static_cast<const char*>(lines.data().data()), length - 1);
      lines.consume(length);
      news_.cancel();
    }
    ::alarm(shutdown_limit_s);
    progress_.clear(), ended_ = true;
    if (has_readers()) refresh();
    news_.cancel();
    if (!has_readers()) io_.stop();
    asio::steady_timer timer(io_, last_answer_within);
    co_await timer.async_wait(asio::use_awaitable);
    io_.stop();
  }

  void refresh() {
    page_.refresh();
    refreshed_ = Steady::now();
  }

  /// Reads the folder every second, or less often if that takes more than a tenth of a core.
  asio::awaitable<void> refresh_regularly() {
    asio::steady_timer timer(io_);
    for (;;) {
      const std::clock_t began = std::clock();  // CPU time: waiting does not count
      const auto now = Steady::now();
      std::erase_if(readers_, [now](const auto& reader) { return now - reader.second > reader_gone_after; });
      std::erase_if(opened_, [now](Steady::time_point then) { return now - then > first_request_within; });
      if (!readers_.empty() && !ended_) {
        refresh();
        news_.cancel();
      }
      const std::chrono::duration<double> worked(static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
      timer.expires_after(std::max<Steady::duration>(1s, std::chrono::duration_cast<Steady::duration>(10 * worked)));
      co_await timer.async_wait(asio::use_awaitable);
    }
  }

  asio::awaitable<void> session(tcp::socket socket) {
    ++sessions_;
    beast::tcp_stream stream(std::move(socket));
    beast::flat_buffer buffer;
    for (;;) {
      http::request_parser<http::empty_body> parser;
      parser.header_limit(max_header_bytes);
      stream.expires_after(reader_gone_after);
      error_code error;
      idle_.push_back(&stream);
      co_await http::async_read_header(stream, buffer, parser, into(error));
      std::erase(idle_, &stream);
      if (error) break;
      const auto& request = parser.get();
      stream.expires_never();
      const std::string reader(parameter(text(request.target()), "page"));
      Response response = co_await answer(request);
      const bool last_answer = ended_;
      response.keep_alive(request.keep_alive() && parser.is_done() && !ended_);
      response.prepare_payload();
      stream.expires_after(reader_gone_after);
      co_await http::async_write(stream, response, into(error));
      if (last_answer) readers_.erase(reader);
      if (error || !response.keep_alive()) break;
    }
    error_code ignored;
    stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
    --sessions_;
    if (ended_ && !has_readers()) io_.stop();
  }

  bool has_readers() const { return !readers_.empty() || !opened_.empty(); }

  static std::string_view text(beast::string_view view) { return {view.data(), view.size()}; }

  asio::awaitable<Response> answer(const http::request<http::empty_body>& request) {
    const std::string target(text(request.target()));
    const auto say = [&](http::status status, const char* type, std::string body) {
      Response response(status, request.version());
      response.set(http::field::content_type, type);
      response.set(http::field::cache_control, "no-store");
      response.set("X-Content-Type-Options", "nosniff");
      response.set("Cross-Origin-Resource-Policy", "same-origin");
      response.body() = std::move(body);
      return response;
    };
    constexpr const char *plain = "text/plain; charset=utf-8", *html = "text/html; charset=utf-8";
    if (!is_this_machine(text(request[http::field::host])))
      co_return say(http::status::forbidden, plain, "this page is served to 127.0.0.1 and localhost only\n");
    if (request.method() != http::verb::get) {
      Response response = say(http::status::method_not_allowed, plain, "only GET is allowed\n");
      response.set(http::field::allow, "GET");
      co_return response;
    }
    if (target == "/") {
      if (Steady::now() - refreshed_ > 1s) refresh();  // many requests at once must not delay the end of the run
      if (opened_.size() < max_sessions) opened_.push_back(Steady::now());
      co_return say(http::status::ok, html, page_.html());
    }
    if (!target.starts_with("/new?")) co_return say(http::status::not_found, plain, "not found; the page is /\n");
    const auto since_text = parameter(target, "since");
    std::size_t since = 0;
    const auto [end, error] = std::from_chars(since_text.data(), since_text.data() + since_text.size(), since);
    if (error != std::errc() || end != since_text.data() + since_text.size())
      co_return say(http::status::bad_request, plain, "since takes a number\n");
    const Description news = co_await news_for(since, std::string(parameter(target, "page")));
    co_return say(http::status::ok, "application/json",
                  news.dump(-1, ' ', false, Description::error_handler_t::replace));
  }

  /// Waits for news that the reader does not have yet.
  asio::awaitable<Description> news_for(std::size_t since, const std::string reader) {
    if (!opened_.empty() && !readers_.contains(reader)) opened_.erase(opened_.begin());
    if (readers_.size() < max_sessions) readers_[reader] = Steady::now();
    const std::string progress = progress_;
    const auto until = Steady::now() + answer_within;
    while (page_.since() == since && progress_ == progress && !ended_ && Steady::now() < until) {
      error_code woken;
      co_await news_.async_wait(into(woken));
    }
    Description news = page_.news(since);
    news["progress"] = progress_, news["ended"] = ended_;
    if (const auto known = readers_.find(reader); known != readers_.end()) known->second = Steady::now();
    co_return news;
  }

  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  asio::local::stream_protocol::socket control_;
  LivePage& page_;
  asio::steady_timer news_{io_, Steady::time_point::max()};  ///< cancelled to wake waiting requests
  std::map<std::string, Steady::time_point> readers_;        ///< open pages and the times of their last requests
  std::vector<Steady::time_point> opened_;                   ///< send times of pages that have not requested news yet
  Steady::time_point refreshed_{};                           ///< when the folder was read last
  std::string progress_;
  bool ended_ = false;
  std::size_t sessions_ = 0;
  std::vector<beast::tcp_stream*> idle_;  ///< of sessions that wait for a request, the longest first
};

}  // namespace

Listener::Listener(std::uint16_t port) {
  asio::io_context io;
  try {
    tcp::acceptor acceptor(io, tcp::endpoint(asio::ip::address_v4::loopback(), port));
    port_ = acceptor.local_endpoint().port();
    socket_ = ::dup(acceptor.native_handle());
  } catch (const boost::system::system_error& error) {
    const std::string option = "--port " + std::to_string(port);
    if (error.code() == asio::error::address_in_use)
      throw UsageError(option + ": this port of 127.0.0.1 is in use; give another, or omit --port to get a free one");
    throw UsageError(option + ": cannot listen on this port: " + error.code().message());
  }
}

Listener::~Listener() { ::close(socket_); }

void serve_page(int listening_socket, int control, LivePage& page) { PageServer(listening_socket, control, page)(); }

}  // namespace grit
