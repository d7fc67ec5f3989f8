// SPDX-License-Identifier: MIT
#pragma once
// What the edits of values and those of the stack share.

#include "looks/look_parts.hpp"

namespace darkroom::edit {

[[nodiscard]] Result<LookEntry*> entry_at(Look& look, std::string_view name);
/// Makes a flat look the stack that it stands for. What is off keeps its place where a hand or a file has set it, and
/// each entry is wired as its effect needs.
void become_stack(Look& look);
/// The entry of this name in a look that was flat and is a stack now; it has a place even if it is off.
[[nodiscard]] Result<LookEntry*> restructured(Look& look, std::string_view name);

}  // namespace darkroom::edit
