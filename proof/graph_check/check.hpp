// SPDX-License-Identifier: MIT
#pragma once
// For tests: what a schedule is worth, and how it reads. No part of the library.

#include <darkroom/result.hpp>
#include <span>
#include <string>

#include "graph/schedule.hpp"

namespace darkroom::graph {

/// Proves that in `schedule` every read is ordered after, and sees, the write it needs, that no image is read in a
/// layout it is not in, and that no two live images share memory; says which passes and image break it. Independent of
/// how derive() works: it walks the commands and tracks what each barrier makes available and visible.
[[nodiscard]] Result<> check(const Compiled& compiled, const Schedule& schedule, std::span<const ImportState> imports);
/// The same for frames that follow each other on one queue; histories were reset before the first.
[[nodiscard]] Result<> check_frames(const Compiled& compiled, std::span<const Recording> frames,
                                    std::span<const ImportState> imports);

/// A readable trace, one line a barrier or pass: what tests print.
[[nodiscard]] std::string trace(const Compiled& compiled, const Schedule& schedule);

}  // namespace darkroom::graph
