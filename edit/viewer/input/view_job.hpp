// SPDX-License-Identifier: MIT
#pragma once
// What the flags of `play` and `edit` ask for, with the files that they name read.

#include "programs/darkroom/view/view_flags.hpp"
#include "viewer/viewer.hpp"

namespace app {

[[nodiscard]] darkroom::Result<ViewerJob> job_of(const ViewFlags& flags);

}  // namespace app
