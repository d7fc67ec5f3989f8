// SPDX-License-Identifier: MIT
#pragma once
// What `darkroom verify` found, for programs and for people: one JSON document, lines of text, and a folder with the
// pictures that differ beside the look and the frame that show it.

#include <darkroom/look.hpp>
#include <filesystem>
#include <string>

#include "programs/darkroom/run/json.hpp"
#include "verify/verify.hpp"

namespace app {

[[nodiscard]] Json json_of(const darkroom::verify::Report& report);

/// Behind the lines of the findings: device, how much was tried, what was not, which effects differ.
[[nodiscard]] std::string summary_of(const darkroom::verify::Report& report);

/// The subject as a look; tables and pictures that it names are called table.cube and picture.exr.
[[nodiscard]] darkroom::Look look_of(const darkroom::verify::Subject& subject);

/// The document, in the folder of the findings.
inline constexpr const char* report_name = "verify.json";

/// Of each finding a folder "01_ssao_compute_lean": made.exr, expected.exr, difference.png, look.toml and frames.
[[nodiscard]] darkroom::Result<> write_findings(const std::filesystem::path& folder,
                                                const darkroom::verify::Report& report);

}  // namespace app
