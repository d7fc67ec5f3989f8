// SPDX-License-Identifier: MIT
#pragma once
// Pulses and layers of a look that was edited, in the text that it was read from.

#include <darkroom/look.hpp>

#include "edit/splice/toml_editor.hpp"

namespace darkroom::edit {

/// As splice_look, for [[pulse]] and [[layer]] alone.
[[nodiscard]] Result<> splice_movers(TomlEditor& editor, const Look& was, const Look& is);

}  // namespace darkroom::edit
