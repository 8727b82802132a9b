// Whether a packet to the group of live tuning comes back on this host, found without the code
// under test: only where it does not may a test of the network be skipped.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace footfall::tests {

inline constexpr const char* kNoMulticast =
    "no multicast on this host (ip link set lo up; ip route add 239.255.76.67 dev lo)";

inline bool multicast_works() {
  const int ear = ::socket(AF_INET, SOCK_DGRAM, 0), mouth = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  ip_mreq group{};
  ::inet_pton(AF_INET, "239.255.76.67", &group.imr_multiaddr);
  const timeval patience{1, 0};
  const unsigned char here = 0;
  char byte = '?';
  const bool heard =
      ::bind(ear, any, size) == 0 && ::getsockname(ear, any, &size) == 0 &&  // a free port
      ::setsockopt(ear, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) == 0 &&
      ::setsockopt(ear, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) == 0 &&
      ::setsockopt(mouth, IPPROTO_IP, IP_MULTICAST_TTL, &here, sizeof here) == 0 &&
      (address.sin_addr = group.imr_multiaddr, ::sendto(mouth, &byte, 1, 0, any, size)) == 1 &&
      ::recv(ear, &byte, 1, 0) == 1;
  for (const int file : {ear, mouth}) {
    if (file >= 0) ::close(file);
  }
  return heard;
}

}  // namespace footfall::tests
