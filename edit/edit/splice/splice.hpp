// SPDX-License-Identifier: MIT
#pragma once
// A look that was edited goes back into the text that it was read from: only what changed is written, at the places
// where it stands, and every other byte stays.

#include <darkroom/look.hpp>
#include <string>
#include <string_view>

#include "looks/camera_lens.hpp"

namespace darkroom::edit {

/// `text`: a look or a scene that reads as `was`. Returns one that reads as `is`. Values are replaced where they stand,
/// numbers by their shortest form; a value that stands nowhere gets a key behind those of its effect; entries of
/// [[stack]], [[pulse]] and [[layer]] are moved and taken out with the comments above them. Errors: `text` is no TOML,
/// or does not have the entries of `was`. `lens`: of the camera that the text is read for.
[[nodiscard]] Result<std::string> splice_look(std::string_view text, const Look& was, const Look& is,
                                              const CameraLens& lens = {});

}  // namespace darkroom::edit
