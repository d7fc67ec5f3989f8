// SPDX-License-Identifier: MIT
#pragma once
// What OpenColorIO does here: files of colour tables, and of whole chains of colour operations, that are no .cube. It
// is a module of its own (files/ocio), and this is all that both sides know of each other.

#include <array>
#include <darkroom/resource.hpp>
#include <filesystem>
#include <memory>
#include <span>

#include "core/try.hpp"

namespace darkroom {

/// The operations of one file, or of a configuration's spaces.
class ColorChain {
  public:
    ColorChain() = default;
    ColorChain(const ColorChain&) = delete;
    ColorChain& operator=(const ColorChain&) = delete;
    virtual ~ColorChain() = default;

    /// By OpenColorIO's own CPU processor, 3D tables by tetrahedra.
    virtual void apply(std::span<std::array<float, 3>> colors) const = 0;
    /// As a shaper and a cube: exact where the chain is a 1D table, a 3D table, or one before the other, each behind
    /// scales and offsets of the channels; else a cube of 65 between samples of it.
    [[nodiscard]] virtual Result<ColorTable> sampled() const = 0;
};

struct ColorChains {
    /// The kind of file is told by its extension. The file has been checked by read_table_file().
    Result<std::unique_ptr<ColorChain>> (*open)(const std::filesystem::path& path);
    /// From a colour space of a configuration (.ocio) to linear Rec. 709.
    Result<std::unique_ptr<ColorChain>> (*from_space)(const std::filesystem::path& configuration,
                                                      const std::string& space);
    /// From linear Rec. 709 to a view of a display of a configuration; no view: the display's usual one. A view of data
    /// shows the numbers of `space`, which the light came from; empty: those of Rec. 709.
    Result<std::unique_ptr<ColorChain>> (*to_view)(const std::filesystem::path& configuration,
                                                   const std::string& display, const std::string& view,
                                                   const std::string& space);
};

/// Loads the module the first time. The error is the machine's: the module is not where it was installed.
[[nodiscard]] Result<const ColorChains*> color_chains();

}  // namespace darkroom
