// SPDX-License-Identifier: MIT
#pragma once
// Internal to src/image: an OpenEXR file in memory, read by OpenEXR.

#include <OpenEXR/ImfHeader.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "image/picture/picture_source.hpp"

namespace darkroom {

class ExrSource final : public PictureSource {
  public:
    /// `bytes` have passed check_exr, and outlive it. Throws what OpenEXR throws.
    [[nodiscard]] static Result<std::unique_ptr<PictureSource>> open(std::span<const std::byte> bytes,
                                                                     std::size_t max_threads);
    ~ExrSource() override;

    [[nodiscard]] const Imf::Header& header(std::size_t part) const;
    [[nodiscard]] std::vector<double> numbers(std::size_t part, std::string_view attribute) const override;
    [[nodiscard]] std::vector<std::string> attributes(std::size_t part) const override;
    [[nodiscard]] std::uint32_t row_unit(std::size_t part) const override;

  private:
    struct State;
    explicit ExrSource(std::unique_ptr<State> state);
    Result<> read(std::size_t part, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override;

    std::unique_ptr<State> state_;
};

/// Gives OpenEXR the threads that files may ask for.
void start_exr_threads();

}  // namespace darkroom
