// SPDX-License-Identifier: MIT
#pragma once
// An image file, opened and checked but not yet decoded: its parts, windows and channels, and a way to take the samples
// out in bands of rows. The kind of file is told by its content, not by its name. It knows no channel by name and no
// colour space; frames and pictures are made from it in frame_file.hpp. OpenImageIO stays behind this header.

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

namespace darkroom {

enum class FileKind { OpenExr, Png, Jpeg, Tiff, Radiance };
enum class SampleKind { Integer8, Integer16, Integer32, Half, Float };

[[nodiscard]] std::string_view name_of(FileKind kind);
[[nodiscard]] std::string_view name_of(SampleKind kind);

/// One picture in a file. Only OpenEXR has several, and only there the data window differs from the display window.
struct FilePart {
    std::string name;
    std::string view;  ///< of a stereo pair: "left", "right"; else empty
    std::vector<std::string> channels;
    std::vector<SampleKind> kinds;  ///< one per channel
    int x = 0;                      ///< of the data window, relative to the display window
    int y = 0;
    std::uint32_t width = 0;  ///< of the data window
    std::uint32_t height = 0;
    std::uint32_t display_width = 0;
    std::uint32_t display_height = 0;
};

class Decoder {
  public:
    /// Reads the file and checks its structure. The error text begins with the path.
    [[nodiscard]] static Result<Decoder> open(const std::filesystem::path& path);

    Decoder(Decoder&&) noexcept;
    Decoder& operator=(Decoder&&) noexcept;
    ~Decoder();

    [[nodiscard]] FileKind kind() const;
    [[nodiscard]] std::span<const FilePart> parts() const;
    /// The numbers of an attribute of a part (one number, a point, a matrix by rows), empty if it has none of that
    /// name.
    [[nodiscard]] std::vector<float> numbers(std::size_t part, const std::string& attribute) const;
    /// An attribute that is one number, in all its bits.
    [[nodiscard]] std::optional<double> number(std::size_t part, const std::string& attribute) const;
    [[nodiscard]] bool has_attribute_starting(std::size_t part, std::string_view start) const;

    /// Hands out channels `first` to `first + count - 1` of the data window from top to bottom: the first row of the
    /// band (0 is the top of the data window), how many rows, and their samples, channel by channel within a pixel.
    /// Integers come as 0..1, as encoded. For damaged data the sink may have had some bands when the error returns.
    using Sink = std::function<void(std::uint32_t row, std::uint32_t rows, std::span<const float> samples)>;
    [[nodiscard]] Result<> read(std::size_t part, std::uint32_t first, std::uint32_t count, const Sink& sink);

  private:
    struct State;
    explicit Decoder(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// The text with everything but printable ASCII replaced, one line, at most 300 characters: names and messages out of
/// files are not to be trusted on a terminal.
[[nodiscard]] std::string one_printable_line(std::string_view text);

}  // namespace darkroom
