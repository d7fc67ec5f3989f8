// SPDX-License-Identifier: MIT
#pragma once
// Structs of the C interface as those of C++: zero becomes the default.

#include "c/call.hpp"
#include "c/objects.hpp"

namespace darkroom::c {

[[nodiscard]] Result<Camera> camera_of(const DarkroomCamera* given);
/// The frame's lights and watches are kept in the composer.
[[nodiscard]] Result<Frame> frame_of(const DarkroomFrame* given, DarkroomComposerObject& composer);
[[nodiscard]] Result<CompileDesc> compile_desc_of(const DarkroomCompileDesc* given);
[[nodiscard]] Result<EntryDesc> entry_desc_of(const DarkroomEntryDesc& given);

}  // namespace darkroom::c
