// SPDX-License-Identifier: MIT
#pragma once
// Internal to files/image: the space that a file's normals and camera are told in, and the way from there to ours:
// world space, y up.

#include <string>

#include "image/frame/frame_file.hpp"

namespace darkroom {

/// Turns the normals and the camera of a frame, whose depth and camera are as the file has them, into our world. Where
/// the options do not say what the normals are, they are held against normals made from depth. Those of a world that no
/// camera places are left out. What was decided comes as a warning.
void settle_world(FrameFile& frame, const FrameOptions& options, bool is_world_known);

}  // namespace darkroom
