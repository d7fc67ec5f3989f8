// SPDX-License-Identifier: MIT
#pragma once
// The least that still shows a finding: what someone who has to read a driver's compiler wants to start from.

#include "verify/verify.hpp"

namespace darkroom::verify {

/// Does this subject, in this form, make another picture than the reference?
using Shows = std::function<bool(const Subject&, const Form&)>;

/// Sets `smallest` and `smallest_extent`: drops steps, takes values back to defaults, halves the picture's sides, each
/// for as long as `shows` says yes, which is asked at most `max_tries` times.
void make_smaller(Finding& finding, const Shows& shows, std::size_t max_tries = 64);

}  // namespace darkroom::verify
