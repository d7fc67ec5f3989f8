// SPDX-License-Identifier: MIT
#pragma once
// An image file in memory, told by its content, checked, and opened for OpenImageIO to decode. What is done with parts,
// windows and samples is for its users to say; this is only what must hold before any of them touches a file.

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <darkroom/result.hpp>
#include <memory>
#include <span>
#include <string>

#include "image/decoder.hpp"

namespace darkroom {

class MemoryInput {
  public:
    /// The bytes outlive it. Errors name no file.
    [[nodiscard]] static Result<MemoryInput> open(std::span<const std::byte> bytes);

    [[nodiscard]] FileKind kind() const { return kind_; }
    [[nodiscard]] OIIO::ImageInput& input() const { return *input_; }
    /// What the reader says is wrong, without the name under which it knows the file.
    [[nodiscard]] std::string reason() const;

  private:
    MemoryInput() = default;

    FileKind kind_ = FileKind::OpenExr;
    std::unique_ptr<OIIO::Filesystem::IOProxy> memory_;
    OIIO::ImageInput::unique_ptr input_;  // after `memory_`, which it reads from until it is destroyed
};

}  // namespace darkroom
