// SPDX-License-Identifier: MIT
#pragma once
// Frames of files as the library's develop functions take them.

#include "compose/developer.hpp"
#include "compose/reference_chain.hpp"
#include "image/frame_file.hpp"
#include "image/picture.hpp"
#include "image/write.hpp"

namespace app {

/// Refers to the frame's memory.
[[nodiscard]] darkroom::DevelopInput develop_input(const darkroom::FrameFile& frame);
/// By the CPU references alone, in the form that the target asks for.
[[nodiscard]] darkroom::Result<darkroom::DevelopedPicture> develop_by_reference(const darkroom::Composer& composer,
                                                                                const darkroom::DevelopInput& input,
                                                                                darkroom::DevelopTarget target);
[[nodiscard]] darkroom::Result<> write(const std::filesystem::path& path, darkroom::DevelopedPicture picture,
                                       const darkroom::WriteOptions& options);

}  // namespace app
