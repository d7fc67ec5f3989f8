// SPDX-License-Identifier: MIT
#pragma once
// An OpenEXR file in memory, read by OpenEXR.

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPixelType.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "formats/picture_source.hpp"

namespace darkroom {

/// Of samples in memory.
[[nodiscard]] inline Imf::PixelType type_of(SampleKind kind) {
    return kind == SampleKind::Half ? Imf::HALF : kind == SampleKind::Integer32 ? Imf::UINT : Imf::FLOAT;
}

class ExrSource final : public PictureSource {
  public:
    /// Opens the same file elsewhere.
    using OpenElsewhere = std::function<Result<std::unique_ptr<PictureSource>>()>;

    /// `bytes` have passed check_exr, and outlive it. Throws what OpenEXR throws. With `elsewhere`, samples that
    /// OpenEXR itself would unpack are read there.
    [[nodiscard]] static Result<std::unique_ptr<PictureSource>> open(std::span<const std::byte> bytes,
                                                                     std::size_t max_threads,
                                                                     OpenElsewhere elsewhere = {});
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
    OpenElsewhere open_elsewhere_;
    std::unique_ptr<PictureSource> elsewhere_;
};

/// Gives OpenEXR the threads that files may ask for.
void start_exr_threads();

}  // namespace darkroom
