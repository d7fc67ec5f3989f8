// SPDX-License-Identifier: MIT
#pragma once
// Files of effects as text: which one a name means, in which form, and what it includes.

#include <darkroom/effect.hpp>
#include <darkroom/result.hpp>
#include <string>
#include <string_view>

namespace darkroom::plan {

/// A file of an effect, or one of those that effects share, with the files of the effect's own folder in place of the
/// lines that include them. What it shares with other effects is still to be included.
struct OwnText {
    std::string glsl;   ///< empty: there is no such file
    std::string shown;  ///< "effects/bloom/down.glsl"
};
/// `is_software`: of a file with another form for drivers on the CPU, "NAME.software.glsl" beside "NAME.glsl", that
/// form is taken, whoever includes it.
[[nodiscard]] OwnText own_text(const EffectInfo& info, std::string_view name, bool is_software);

/// Appends a text with the shared files that it includes, and #line directives that say what is whose.
[[nodiscard]] Result<void> append_with_includes(std::string& out, std::string_view text, const std::string& shown,
                                                int depth = 0);

}  // namespace darkroom::plan
