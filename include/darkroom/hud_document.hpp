// SPDX-License-Identifier: MIT
#pragma once
// An SVG document with bindings ({{health}}) as a picture over the game: load it, set() values in every frame, take
// picture() in every frame. It is drawn when its size, a value that it names or its file has changed, and at no other
// time; off the calling thread unless it is headless. What cannot be drawn leaves the last picture, and says why.
// Not for what moves smoothly in every frame: a drawing takes milliseconds.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace darkroom {

/// Of the game: a number is shown in the shortest form that reads back the same, or in the form that its binding names.
using HudValue = std::variant<double, std::string>;

/// Premultiplied, sRGB-encoded, 8 bits a channel, rows from the top.
struct HudPicture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba{};
};

/// Budgets of a document and a drawing; what exceeds them is an error, not a wait.
struct HudLimits {
    std::uint32_t document_bytes = 1u << 20;
    std::uint32_t elements = 20'000;
    std::uint32_t side = 8192;  ///< of a picture, pixels
    std::uint32_t pixels = 7680 * 4320;
    std::uint32_t seconds = 5;  ///< a drawing may take; the first one of a machine may make caches of fonts
};

struct HudOptions {
    bool is_headless = false;    ///< picture() draws what it returns, and looks at the file each time
    double poll_seconds = 0.25;  ///< between two looks at the file
    HudLimits limits{};
};

class HudDocument {
  public:
    /// Reads and checks the file, draws nothing. Errors are "file:line: reason".
    [[nodiscard]] static Result<std::unique_ptr<HudDocument>> load(const std::filesystem::path& path,
                                                                   const HudOptions& options = {});
    ~HudDocument();

    void set(std::string_view name, HudValue value);
    /// Adds a class to the element with this id, or takes it away, from now on: what its styles and the document's say
    /// of it changes with the next drawing. False: a name is not of 1 to 64 letters, digits, '_' and '-', or 256 pairs
    /// of element and class have been named before.
    bool set_class(std::string_view id, std::string_view name, bool is_on);
    /// The controllers that its <script> elements name, as the file was read last; relative names are of its folder.
    [[nodiscard]] const std::vector<std::string>& scripts() const;
    /// The newest drawing: headless, of this size and all values; else what was drawn last, perhaps at another size,
    /// and null before the first. What changed is begun now, and returned by the first call after it is done. The same
    /// pointer is the same picture.
    /// `scale`: pixels of a unit, of a document that has neither a viewBox nor a reference height; a window's scale.
    [[nodiscard]] std::shared_ptr<const HudPicture> picture(std::uint32_t width, std::uint32_t height, float scale = 1);
    /// Why the picture is not that of the file, the values and the size; one line, empty where it is.
    [[nodiscard]] const std::string& error() const;
    /// Successful ones, so far.
    [[nodiscard]] std::uint64_t drawings() const;

  private:
    struct State;
    explicit HudDocument(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
