// SPDX-License-Identifier: MIT
#pragma once
// Opens a place of a text in the editor of whoever looks at it.

#include <darkroom/result.hpp>
#include <string>

#include "panels/widgets/messages.hpp"

namespace app {

/// What a shell would be told: "vim +12 'my look.toml'"; `editor` empty: the command line's own, $EDITOR or vi.
[[nodiscard]] std::string editor_command(const std::string& editor, const darkroom::panels::TextPlace& place);
/// Runs the editor that $VISUAL names, which may have arguments, with `+LINE FILE`, as a process of its own that
/// outlives this one. False: $VISUAL names none. An error: it cannot be started.
[[nodiscard]] darkroom::Result<bool> open_in_editor(const darkroom::panels::TextPlace& place);

}  // namespace app
