// SPDX-License-Identifier: MIT
#pragma once
// Where the panels of `edit` lie: what their user has made of them, and the areas that follow in a window. Numbers
// alone; edit_panels.hpp draws.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <map>
#include <utility>

namespace app {

/// Widths and heights in pixels of a display of scale 1.
struct PanelSizes {
    float stack = 296, entry = 296;
    float below = 0;      ///< 0: by the height of the window
    float column = 0.5F;  ///< where stack and parameters share a column: the part of the stack
    bool has_stack = true, has_entry = true, has_below = true, has_status = true;
    bool operator==(const PanelSizes&) const = default;
};

/// A line between two areas that can be dragged.
enum class Splitter : std::uint8_t { Stack, Entry, Below, Column };
inline constexpr std::size_t splitter_count = 4;

/// In pixels of the window. What is not there has no width.
struct PanelAreas {
    VkRect2D bar{}, stack{}, entry{}, view_bar{}, picture{}, timeline{}, below{}, status{};
    VkRect2D splitters[splitter_count]{};
};

struct PanelRoom {
    VkExtent2D window{};
    float scale = 1;
    bool has_timeline = false;
    bool is_over = false;         ///< the picture has the whole window, and the panels lie over it
    std::uint32_t view_rows = 1;  ///< of widgets above the picture
};
[[nodiscard]] PanelAreas lay_out(const PanelSizes& sizes, const PanelRoom& room);
/// The sizes after the splitter was dragged to where the mouse is.
[[nodiscard]] PanelSizes moved(const PanelSizes& sizes, Splitter splitter, float x, float y, const PanelRoom& room);
/// The same with that line where it is at first.
[[nodiscard]] PanelSizes put_back(const PanelSizes& sizes, Splitter splitter);

// How the panels lay in windows of each size: a file of its user's configuration.

class KnownPanels {
  public:
    /// None where there is no such file. Errors are those of the file.
    [[nodiscard]] static darkroom::Result<KnownPanels> read(const std::filesystem::path& file);
    [[nodiscard]] darkroom::Result<> write(const std::filesystem::path& file) const;

    /// Those of the window whose size is nearest; nobody knows any: as they are at first.
    [[nodiscard]] PanelSizes of(VkExtent2D window) const;
    void set(VkExtent2D window, const PanelSizes& sizes);

  private:
    std::map<std::pair<std::uint32_t, std::uint32_t>, PanelSizes> known_;  ///< by width and height
};

}  // namespace app
