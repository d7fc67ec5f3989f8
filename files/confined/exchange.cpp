// SPDX-License-Identifier: MIT
#include "confined/exchange.hpp"

#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace darkroom {
namespace {

struct Control {
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int) * max_descriptors)> bytes{};
};

}  // namespace

bool send_all(int socket, const void* data, std::size_t size, std::span<const int> descriptors) {
    Control control;
    for (auto* at = static_cast<const char*>(data); size > 0;) {
        iovec piece{const_cast<char*>(at), size};
        msghdr message{};
        message.msg_iov = &piece;
        message.msg_iovlen = 1;
        if (!descriptors.empty()) {
            message.msg_control = control.bytes.data();
            message.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
            cmsghdr* const head = CMSG_FIRSTHDR(&message);
            head->cmsg_level = SOL_SOCKET;
            head->cmsg_type = SCM_RIGHTS;
            head->cmsg_len = CMSG_LEN(descriptors.size_bytes());
            std::memcpy(CMSG_DATA(head), descriptors.data(), descriptors.size_bytes());
        }
        const ssize_t sent =
            descriptors.empty() ? send(socket, at, size, MSG_NOSIGNAL) : sendmsg(socket, &message, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        descriptors = {};
        at += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool receive_all(int socket, void* data, std::size_t size, std::vector<Descriptor>* descriptors) {
    for (auto* at = static_cast<char*>(data); size > 0;) {
        Control control;
        iovec piece{at, size};
        msghdr message{};
        message.msg_iov = &piece;
        message.msg_iovlen = 1;
        if (descriptors != nullptr) {
            message.msg_control = control.bytes.data();
            message.msg_controllen = control.bytes.size();
        }
        const ssize_t got =
            descriptors == nullptr ? recv(socket, at, size, 0) : recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        if (descriptors != nullptr)
            for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr; head = CMSG_NXTHDR(&message, head)) {
                if (head->cmsg_level != SOL_SOCKET || head->cmsg_type != SCM_RIGHTS) continue;
                std::array<int, max_descriptors> numbers{};
                const std::size_t count = (head->cmsg_len - CMSG_LEN(0)) / sizeof(int);
                std::memcpy(numbers.data(), CMSG_DATA(head), count * sizeof(int));
                for (std::size_t i = 0; i < count; ++i) descriptors->emplace_back(numbers[i]);
            }
        at += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

}  // namespace darkroom
