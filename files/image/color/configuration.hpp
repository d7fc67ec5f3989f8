// SPDX-License-Identifier: MIT
#pragma once
// Colour spaces and views of a configuration of OpenColorIO, a file .ocio with the tables that it names. A
// configuration is trusted as a program is: it names any files, and says how much is done to a colour.

#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "image/picture/picture.hpp"
#include "image/table/color_chain.hpp"

namespace darkroom {

/// Can it be read, and is it no larger than 16 MiB? What is in it is not looked at.
[[nodiscard]] Result<> check_configuration(const std::filesystem::path& configuration);

/// From that space to linear Rec. 709. The error text begins with the path.
[[nodiscard]] Result<std::shared_ptr<const ColorChain>> space_of_configuration(
    const std::filesystem::path& configuration, const std::string& space);

/// From linear Rec. 709 to a view of a display; no view: its usual one. A view of data shows the numbers of `space`, which
/// the light came from; empty: those of Rec. 709. The error text begins with the path.
[[nodiscard]] Result<std::shared_ptr<const ColorChain>> view_of_configuration(
    const std::filesystem::path& configuration, const std::string& display, const std::string& view,
    const std::string& space);

/// Alpha stays; a colour that becomes no finite number is 0.
void apply(const ColorChain& chain, Picture& picture);

}  // namespace darkroom
