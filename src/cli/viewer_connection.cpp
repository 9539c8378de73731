// SPDX-License-Identifier: MIT
#include "cli/viewer_connection.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <utility>

#include "cli/commands.h"
#include "cli/tev_packets.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

using std::chrono::seconds;

constexpr seconds kBetweenTries{2};
constexpr double kLongestConnect = 5;  // seconds
constexpr double kPatience = 2;        // seconds without progress, once the render is over
constexpr int kSlice = 50;             // milliseconds between two looks at whether it is over

struct HostAndPort {
  std::string host, port;
};

HostAndPort parsed(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  HostAndPort found;
  if (colon != std::string::npos) {
    found.host = address.substr(0, colon);
    found.port = address.substr(colon + 1);
  }
  const bool bracketed =
      found.host.size() > 2 && found.host.front() == '[' && found.host.back() == ']';
  if (bracketed) found.host = found.host.substr(1, found.host.size() - 2);
  int port = 0;
  const char* const end = found.port.data() + found.port.size();
  const auto [last, error] = std::from_chars(found.port.data(), end, port);
  if (found.host.empty() || (!bracketed && found.host.find(':') != std::string::npos) ||
      error != std::errc() || last != end || port < 1 || port > 65535)
    throw InputError("--display: expected HOST:PORT, as in 127.0.0.1:14158, got \"" + address +
                     "\"");
  return found;
}

// Why a connection that is being made was not; 0: it was.
int connectError(int socket) {
  int error = 0;
  socklen_t size = sizeof error;
  if (getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) != 0) return errno;
  return error;
}

// The viewer says nothing: all that can be read is that it has closed.
bool isClosed(int socket) {
  char byte;
  ssize_t got = 0;
  while ((got = recv(socket, &byte, 1, MSG_DONTWAIT)) > 0) continue;
  return got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

}  // namespace

ViewerConnection::ViewerConnection(const std::string& address, std::string name)
    : address_(address), name_(std::move(name)) {
  const HostAndPort place = parsed(address);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  const int error = getaddrinfo(place.host.c_str(), place.port.c_str(), &hints, &hosts_);
  if (error != 0)
    throw InputError("--display: \"" + place.host +
                     "\" is no host that is known here: " + gai_strerror(error));
  thread_ = std::thread([this] { run(); });
}

ViewerConnection::~ViewerConnection() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
  freeaddrinfo(hosts_);
}

bool ViewerConnection::wantsPicture() const {
  const std::lock_guard lock(mutex_);
  return connected_ && !sending_ && !next_;
}

void ViewerConnection::show(std::shared_ptr<const Image> picture) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(picture);
  }
  changed_.notify_all();
}

bool ViewerConnection::isOver() const {
  const std::lock_guard lock(mutex_);
  return over_;
}

void ViewerConnection::lost(const std::string& why) {
  if (!std::exchange(warned_, true))
    spdlog::warn("--display: {}: {}; the render goes on, and it is tried again every {} seconds",
                 address_, why, kBetweenTries.count());
}

// A connection, or -1.
int ViewerConnection::connected() {
  std::string why;
  for (const addrinfo* host = hosts_; host; host = host->ai_next) {
    const int made = socket(host->ai_family, host->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC,
                            host->ai_protocol);
    if (made < 0) {
      why = std::strerror(errno);
      continue;
    }
    int error = connect(made, host->ai_addr, host->ai_addrlen) == 0 ? 0 : errno;
    const double since = wallClock();
    while (error == EINPROGRESS) {
      pollfd wait{made, POLLOUT, 0};
      if (poll(&wait, 1, kSlice) > 0)
        error = connectError(made);
      else if (isOver() || wallClock() - since > kLongestConnect)
        error = ETIMEDOUT;
    }
    if (error == 0) return made;
    why = std::strerror(error);
    close(made);
  }
  lost(why);
  return -1;
}

// False where the viewer is gone, or does not take it and the render is over.
bool ViewerConnection::sendBytes(int socket, const std::uint8_t* bytes, std::size_t count) {
  double since = wallClock();
  while (count > 0) {
    const ssize_t sent = ::send(socket, bytes, count, MSG_NOSIGNAL);
    if (sent > 0) {
      bytes += sent;
      count -= static_cast<std::size_t>(sent);
      since = wallClock();
    } else if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) {
      pollfd wait{socket, POLLOUT, 0};
      if (poll(&wait, 1, kSlice) == 0 && isOver() && wallClock() - since > kPatience) return false;
    } else {
      lost("the viewer has gone");
      return false;
    }
  }
  return true;
}

bool ViewerConnection::send(int socket, const Image& picture, bool first) {
  const auto sendPacket = [&](const Packet& packet) {
    return sendBytes(socket, packet.data(), packet.size());
  };
  if (first && !sendPacket(createImagePacket(name_, picture.width, picture.height))) return false;
  const int rows = rowsAPacket(picture.width);
  for (int y = 0; y < picture.height; y += rows)
    if (!sendPacket(updateImagePacket(name_, picture, y, std::min(y + rows, picture.height))))
      return false;
  warned_ = false;
  return true;
}

void ViewerConnection::run() {
  int socket = -1;
  bool first = true;
  std::unique_lock lock(mutex_);
  const auto disconnect = [&] {
    close(socket);
    socket = -1;
    connected_ = sending_ = false;
  };
  for (;;) {
    if (socket < 0) {
      if (over_) break;
      lock.unlock();
      socket = connected();
      lock.lock();
      connected_ = socket >= 0;
      first = true;
      if (!connected_) {
        changed_.wait_for(lock, kBetweenTries, [this] { return over_; });
        continue;
      }
    }
    if (!next_) {
      if (over_) break;
      changed_.wait_for(lock, seconds(1));
    }
    const std::shared_ptr<const Image> picture = std::exchange(next_, nullptr);
    sending_ = picture != nullptr;
    lock.unlock();
    bool alive = !isClosed(socket);
    if (!alive) lost("the viewer has gone");
    if (alive && picture) {
      alive = send(socket, *picture, first);
      first = false;
    }
    lock.lock();
    sending_ = false;
    if (!alive) disconnect();
  }
  if (socket >= 0) disconnect();
}

}  // namespace h2mc
