// SPDX-License-Identifier: MIT
#pragma once
// Files of effects as text: which one a name means, and what it includes.

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
/// `name`: "bloom.glsl", or "bloom.glsl#down" for its part "down". A line `#part NAME...` begins what the parts of
/// those names have alone, up to the next such line; one without names, what all parts have. Where no part is named it
/// is "end", an effect's pointwise end.
[[nodiscard]] OwnText own_text(const EffectInfo& info, std::string_view name);

/// Appends a text with the shared files that it includes, and #line directives that say what is whose.
[[nodiscard]] Result<void> append_with_includes(std::string& out, std::string_view text, const std::string& shown,
                                                int depth = 0);

}  // namespace darkroom::plan
