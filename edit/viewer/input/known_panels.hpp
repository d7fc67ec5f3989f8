// SPDX-License-Identifier: MIT
#pragma once
// How the panels lay in windows of each size: a file of its user's configuration.

#include <darkroom/result.hpp>
#include <filesystem>
#include <map>
#include <utility>

#include "viewer/panels/panel_layout.hpp"

namespace app {

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
