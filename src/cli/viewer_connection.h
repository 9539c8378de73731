// SPDX-License-Identifier: MIT
// A viewer somewhere else that is shown the picture while it is rendered.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "render/image/image.h"

struct addrinfo;

namespace h2mc {

// Sends pictures to tev, or what speaks its protocol, from a thread of its own: whoever hands them over never waits.
// Where nobody listens, or the viewer is closed, one warning is given, and it is tried again every two seconds.
class ViewerConnection {
 public:
  // address: HOST:PORT, a host with colons in brackets. name: what the viewer calls the picture. Throws InputError
  // where the address is none, or its host is not known.
  ViewerConnection(const std::string& address, std::string name);
  // Waits for a moment until the last picture is sent, if the viewer takes it.
  ~ViewerConnection();
  ViewerConnection(const ViewerConnection&) = delete;
  ViewerConnection& operator=(const ViewerConnection&) = delete;

  // Whether there is a viewer that has taken the pictures before.
  bool wantsPicture() const;
  // Takes the place of one that has not been begun to be sent.
  void show(std::shared_ptr<const Image> picture);

 private:
  void run();
  bool isOver() const;
  int connected();
  bool send(int socket, const Image& picture, bool first);
  bool sendBytes(int socket, const std::uint8_t* bytes, std::size_t count);
  void lost(const std::string& why);

  const std::string address_, name_;
  addrinfo* hosts_ = nullptr;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Image> next_;  // to be sent
  bool connected_ = false, sending_ = false, over_ = false;
  bool warned_ = false;  // since a picture was sent
  std::thread thread_;
};

}  // namespace h2mc
