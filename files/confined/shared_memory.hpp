// SPDX-License-Identifier: MIT
#pragma once
// Memory that a program shares with a confined process. It is sealed at one size, which neither side can change, so no
// page of it is ever missing where it is read.

#include <cstddef>
#include <span>

#include "confined/descriptor.hpp"
#include "core/try.hpp"

namespace darkroom {

class SharedMemory {
  public:
    SharedMemory() = default;
    /// Zeros, which both sides may write.
    [[nodiscard]] static Result<SharedMemory> make(std::size_t size);
    /// A copy of the bytes, which nobody can write any more.
    [[nodiscard]] static Result<SharedMemory> holding(std::span<const std::byte> bytes);

    [[nodiscard]] int descriptor() const { return file_.number(); }
    [[nodiscard]] std::size_t size() const { return size_; }

  private:
    Descriptor file_;
    std::size_t size_ = 0;
};

/// The bytes of such memory in this process.
class Mapping {
  public:
    Mapping() = default;
    /// Of a file that is as long; empty where the process has no room for it.
    Mapping(int file, std::size_t size, bool is_writable);
    Mapping(Mapping&& other) noexcept;
    Mapping& operator=(Mapping&& other) noexcept;
    ~Mapping();

    [[nodiscard]] std::span<std::byte> bytes() const { return bytes_; }

  private:
    std::span<std::byte> bytes_;
};

}  // namespace darkroom
