// SPDX-License-Identifier: MIT
#include "confined/shared_memory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace darkroom {
namespace {

Failure failed(std::size_t size) {
    return machine_error(fmt::format("{} bytes of memory to share: {}", size, std::strerror(errno)));
}

Descriptor memory_file() { return Descriptor(memfd_create("darkroom", MFD_CLOEXEC | MFD_ALLOW_SEALING)); }

bool seal(const Descriptor& file, int more) {
    return fcntl(file.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL | more) == 0;
}

}  // namespace

Result<SharedMemory> SharedMemory::make(std::size_t size) {
    SharedMemory out;
    out.file_ = memory_file();
    out.size_ = size;
    if (!out.file_.is_open() || ftruncate(out.file_.number(), static_cast<off_t>(size)) != 0 || !seal(out.file_, 0))
        return failed(size);
    return out;
}

Result<SharedMemory> SharedMemory::holding(std::span<const std::byte> bytes) {
    SharedMemory out;
    out.file_ = memory_file();
    out.size_ = bytes.size();
    if (!out.file_.is_open()) return failed(bytes.size());
    while (!bytes.empty()) {
        const ssize_t written = write(out.file_.number(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return failed(out.size_);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    if (!seal(out.file_, F_SEAL_WRITE)) return failed(out.size_);
    return out;
}

Mapping::Mapping(int file, std::size_t size, bool is_writable) {
    if (size == 0) return;
    void* at = mmap(nullptr, size, is_writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, file, 0);
    // Kernels before 6.7 share nothing that is sealed against writing, and what nobody writes is the same in private.
    if (at == MAP_FAILED && !is_writable) at = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    if (at != MAP_FAILED) bytes_ = {static_cast<std::byte*>(at), size};
}

Mapping::Mapping(Mapping&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
}

Mapping::~Mapping() {
    if (!bytes_.empty()) munmap(bytes_.data(), bytes_.size());
}

}  // namespace darkroom
