// SPDX-License-Identifier: MIT
#pragma once
// A picture that a confined process decodes: what is opened here are its bytes, and what comes back is copied out of
// shared memory, once its sizes have been found to be right.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "formats/file_format.hpp"
#include "formats/messages.hpp"
#include "formats/picture_source.hpp"

namespace darkroom {

class ConfinedSource final : public PictureSource {
  public:
    /// The bytes have been checked, and outlive it. `max_threads`: as for open_source.
    [[nodiscard]] static Result<std::unique_ptr<PictureSource>> open(const FileFormat& format,
                                                                     std::span<const std::byte> bytes,
                                                                     std::size_t max_threads);

    [[nodiscard]] std::vector<double> numbers(std::size_t part, std::string_view attribute) const override;
    [[nodiscard]] std::vector<std::string> attributes(std::size_t part) const override;
    [[nodiscard]] std::uint32_t row_unit(std::size_t part) const override;

  private:
    ConfinedSource(const FileFormat& format, std::span<const std::byte> bytes, std::size_t max_threads);
    Result<> read(std::size_t part, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override;
    /// Samples of these rows, or what the picture is.
    Result<> ask(std::size_t part, std::uint32_t row, std::uint32_t rows, std::span<const SamplePlace> places,
                 std::vector<std::byte>& answer);
    [[nodiscard]] std::uint64_t decoded_size() const;

    const FileFormat& format_;
    bool needs_openimageio_;
    std::span<const std::byte> file_;
    std::uint32_t max_threads_;
    std::uint64_t number_;
    PictureDescription description_;
};

}  // namespace darkroom
