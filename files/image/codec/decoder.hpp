// SPDX-License-Identifier: MIT
#pragma once
// An image file, opened and checked but not yet decoded: its parts, windows and channels, and two ways to take the
// samples out. The format is told by its content, not by its name. It knows no channel by name and no colour
// space; frames and pictures are made from it in frame_file.hpp.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/primaries.hpp"
#include "formats/file_color.hpp"
#include "image/exr/attributes.hpp"
#include "image/picture/picture_source.hpp"

namespace darkroom {

class Decoder {
  public:
    /// Reads the file (read_image_file) and checks its structure. The error text begins with the path. `max_threads`:
    /// see open_source.
    [[nodiscard]] static Result<Decoder> open(const std::filesystem::path& path, std::size_t max_threads = 0,
                                              DecodingPlace place = DecodingPlace::Confined);

    Decoder(Decoder&&) noexcept;
    Decoder& operator=(Decoder&&) noexcept;
    ~Decoder();

    [[nodiscard]] const FileFormat& format() const;
    /// What the file says of a part's colour. Of OpenEXR colorInteropID, which knows curves, then chromaticities.
    [[nodiscard]] FileColor color(std::size_t part) const;
    /// See FileFormat::left_out.
    [[nodiscard]] std::string left_out() const;
    [[nodiscard]] std::span<const FilePart> parts() const;
    /// The numbers of an attribute of a part (one number, a point, a matrix by rows), empty if it has none of that
    /// name, whose case does not matter.
    [[nodiscard]] std::vector<float> numbers(std::size_t part, const std::string& attribute) const;
    /// An attribute that is one number, in all its bits.
    [[nodiscard]] std::optional<double> number(std::size_t part, const std::string& attribute) const;
    [[nodiscard]] bool has_attribute_starting(std::size_t part, std::string_view start) const;
    /// What a file that is made from this part may say of itself, too; null for files that are not OpenEXR.
    [[nodiscard]] std::shared_ptr<const ExrAttributes> attributes(std::size_t part, ExrAttributes::Of of) const;

    /// Hands out channels `first` to `first + count - 1` of the data window from top to bottom: the first row of the
    /// band (0 is the top of the data window), how many rows, and their samples, channel by channel within a pixel.
    /// Integers come as 0..1, as encoded. For damaged data the sink may have had some bands when the error returns.
    using Sink = std::function<void(std::uint32_t row, std::uint32_t rows, std::span<const float> samples)>;
    [[nodiscard]] Result<> read(std::size_t part, std::uint32_t first, std::uint32_t count, const Sink& sink);
    /// Puts samples of the data window straight into their places: see PictureSource::read_rows.
    [[nodiscard]] Result<> read_rows(std::size_t part, std::uint32_t row, std::uint32_t rows,
                                     std::span<const SamplePlace> places);
    /// See PictureSource::set_display_window.
    void set_display_window(const PixelWindow& window);
    /// How many rows of a part are best read together, if `row_bytes` are kept of each.
    [[nodiscard]] std::uint32_t band_rows(std::size_t part, std::size_t row_bytes) const;

  private:
    struct State;
    explicit Decoder(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
